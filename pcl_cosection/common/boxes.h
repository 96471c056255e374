// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "parallel.h"
#include "quantile.h"

#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>
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

/** \brief Box of the voxels' centres. */
inline Eigen::AlignedBox3d
boxOf (const VoxelGrid& grid)
{
  return {grid.origin_m, grid.center (grid.dims.x () - 1, grid.dims.y () - 1, grid.dims.z () - 1)};
}

/** \brief The eight corners of the box of the voxels' centres. */
inline std::vector<Eigen::Vector3d>
corners (const VoxelGrid& grid)
{
  std::vector<Eigen::Vector3d> points;
  for (int c = 0; c < 8; ++c)
    points.push_back (boxOf (grid).corner (static_cast<Eigen::AlignedBox3d::CornerType> (c)));
  return points;
}

/** \brief Unite boxes that overlap until none do. */
inline std::vector<Eigen::AlignedBox3d>
uniteOverlapping (std::vector<Eigen::AlignedBox3d> boxes)
{
  bool changed = true;
  while (changed)
  {
    changed = false;
    for (std::size_t i = 0; i < boxes.size (); ++i)
      for (std::size_t j = boxes.size (); j-- > i + 1;)
        if (boxes[i].intersects (boxes[j]))
        {
          boxes[i].extend (boxes[j]);
          boxes.erase (boxes.begin () + static_cast<std::ptrdiff_t> (j));
          changed = true;
        }
  }
  return boxes;
}

} // namespace pcl::cosection
