// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "soft_mask.h"

#include <pcl/cosection/segmentation/instance_detector.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief A detection before non-maximum suppression. */
struct Candidate
{
  std::size_t index; ///< of its values in the outputs
  int class_id;
  float score;
  Rectangle box; ///< in the image
};

/** \brief Reads the outputs of a network; they must outlive it. */
class OutputReader
{
public:
  virtual ~OutputReader () = default;

  /** \brief The candidates with a sufficient score and a proper box, in any order. */
  virtual std::vector<Candidate> candidates (const InstanceDecodingOptions& options) const = 0;

  virtual SoftMask mask (const Candidate& candidate) const = 0;

  /** \brief Whether several candidates may be of one thing. */
  virtual bool hasDuplicates () const { return (false); }
};

/** \brief A candidate with these values, if its score is sufficient and its box proper. \param[in] box in the input */
std::optional<Candidate> makeCandidate (std::size_t index, float class_id, float score, const Rectangle& box,
                                        const ImagePlacement& placement, const InstanceDecodingOptions& options);

/** \brief A reader if the outputs are of its form, else null. */
std::unique_ptr<OutputReader> readDetectionOut (const std::vector<NetworkOutput>& outputs,
                                                const ImagePlacement& placement);

std::unique_ptr<OutputReader> readBoxList (const std::vector<NetworkOutput>& outputs, const ImagePlacement& placement);

std::unique_ptr<OutputReader> readPrototypes (const std::vector<NetworkOutput>& outputs,
                                              const ImagePlacement& placement);

} // namespace pcl::cosection
