// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/image.h>

namespace pcl::cosection {

struct BilateralFilterOptions
{
  int window_px = 7;           ///< edge of the square window, odd
  double sigma_depth_m = 0.04; ///< readings that differ by three times as much are not mixed at all
  double sigma_space_px = 4.5;
  int threads = 0; ///< 0: all; no result depends on it

  /** \brief \throws InvalidArgument if the window is not odd or not from 1 to 99, a sigma is not positive and finite,
   * or \a threads is negative. */
  void validate () const;
};

/** \brief Smooth a depth image without smoothing its edges:
 *
 *     D'(p) = sum_q g(|p - q| / sigma_space) g(|D(p) - D(q)| / sigma_depth) D(q) / sum_q (the same weights),  g(x) =
 * exp (-x^2 / 2)
 *
 * over the pixels q of a window that have a reading, cut off at three sigma of depth and at the image's border.
 *
 * C. Tomasi, R. Manduchi, "Bilateral Filtering for Gray and Color Images", ICCV 1998. O (pixels * window^2).
 * \param[in] depth metres; not finite or not positive: no reading, which it stays, with the same value
 * \throws InvalidArgument if an option is not valid or the image has not as many pixels as its size says */
Image<float> bilateralFilter (const Image<float>& depth, const BilateralFilterOptions& options = {});

} // namespace pcl::cosection
