// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/segmentation/instance_detector.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace pcl::cosection {

/** \brief A rectangle; the pixel in column u covers [u, u + 1). */
struct Rectangle
{
  double left, top, right, bottom;
};

/** \brief Probabilities that a thing is seen, on a grid of few cells. */
struct SoftMask
{
  Image<float> probabilities;
  Rectangle covered; ///< by the grid's cells, in the image
};

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
  OutputReader (NetworkOutputForm form, const ImagePlacement& placement) : form (form), placement_ (placement) {}
  virtual ~OutputReader () = default;

  /** \brief The candidates with a sufficient score and a proper box, in any order. */
  virtual std::vector<Candidate> candidates (const InstanceDecodingOptions& options) const = 0;

  virtual SoftMask mask (const Candidate& candidate) const = 0;

  const NetworkOutputForm form;

protected:
  const ImagePlacement placement_;
};

/** \throws InvalidArgument saying what the outputs are and what they should be, if they are of no known form */
std::unique_ptr<OutputReader> readOutputs (const std::vector<NetworkOutput>& outputs, const ImagePlacement& placement);

} // namespace pcl::cosection
