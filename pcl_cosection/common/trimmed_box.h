// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/common/quantile.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <type_traits>
#include <vector>

namespace pcl::cosection {

/** \brief The box, along the axes of the frame, that contains the points without a share of outliers at each side.
 * \tparam Real of the box
 * \param[in] elements at least one \param[in] outlier_share in [0, 0.5)
 * \param[in] position (element): Eigen vector of three finite coordinates; called several times for each
 * \param[in] threads 0: all
 *
 * O (points). */
template <typename Real, typename Element, typename Position>
Eigen::AlignedBox<Real, 3>
trimmedBox (const std::vector<Element>& elements, double outlier_share, Position&& position, int threads = 1)
{
  Eigen::AlignedBox<Real, 3> box;
  parallelFor (0, 3, threads, [&] (int axis) {
    std::vector<typename std::decay_t<decltype (position (elements.front ()))>::Scalar> along (elements.size ());
    std::transform (elements.begin (), elements.end (), along.begin (),
                    [&] (const Element& element) { return position (element)[axis]; });
    box.min ()[axis] = trimmedMin (along, outlier_share);
    box.max ()[axis] = trimmedMax (along, outlier_share);
  });
  return box;
}

} // namespace pcl::cosection
