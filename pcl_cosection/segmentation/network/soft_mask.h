// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/segmentation/instance_detector.h>

#include <vector>

namespace pcl::cosection {

/** \brief A rectangle; the pixel in column u covers [u, u + 1). */
struct Rectangle
{
  double left, top, right, bottom;

  bool isProper () const; ///< finite and of positive size

  double intersectionOverUnion (const Rectangle& other) const;
};

/** \brief From pixels of the input to those of the image. */
Rectangle toImage (const Rectangle& in_input, const ImagePlacement& placement);

/** \brief Probabilities that a thing is seen, on a grid of few cells. */
struct SoftMask
{
  Image<float> probabilities;
  Rectangle covered; ///< by the grid's cells, in the image
};

/** \brief Set the mask of an instance: pixels in \a box whose probability, interpolated between the middles of cells,
 * reaches the threshold. The mask is empty if the box is not in the image. */
void pasteMask (const SoftMask& soft, const Rectangle& box, const ImagePlacement& placement, double threshold,
                DetectedInstance& instance);

} // namespace pcl::cosection
