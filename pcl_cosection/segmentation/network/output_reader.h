// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "soft_mask.h"

#include <pcl/cosection/segmentation/instance_detector.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection
{

/** \brief What a network takes for a thing. */
struct Candidate
{
  std::size_t index; ///< where the outputs tell of it
  int class_id;
  float score;
  Rectangle box; ///< in the image
};

/** \brief Reads the outputs of a network; they must outlive it. */
class OutputReader
{
public:
  virtual ~OutputReader () = default;

  /** \brief Those of a sufficient score, with proper boxes, in any order. */
  virtual std::vector<Candidate> candidates (const InstanceDecodingOptions& options) const = 0;

  virtual SoftMask mask (const Candidate& candidate) const = 0;

  /** \brief Whether several candidates may tell of one thing. */
  virtual bool hasDuplicates () const { return (false); }
};

/** \brief A candidate of these numbers, if they are of a thing that is believed. \param[in] box in the input */
std::optional<Candidate> makeCandidate (std::size_t index, float class_id, float score, const Rectangle& box,
                                        const ImagePlacement& placement, const InstanceDecodingOptions& options);

/** \brief A reader if the outputs are of its form, else none. */
std::unique_ptr<OutputReader> readDetectionOut (const std::vector<NetworkOutput>& outputs,
                                                const ImagePlacement& placement);

std::unique_ptr<OutputReader> readBoxList (const std::vector<NetworkOutput>& outputs, const ImagePlacement& placement);

std::unique_ptr<OutputReader> readPrototypes (const std::vector<NetworkOutput>& outputs,
                                              const ImagePlacement& placement);

} // namespace pcl::cosection
