// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/common/disjoint_sets.h"
#include "pcl_cosection/view/visibility/depth_edges.h"

#include <pcl/cosection/common/camera.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace pcl::cosection {

/** \brief An organised cloud with its normals, and what its sensor's noise lets one conclude from it. */
struct DepthGrid
{
  const std::vector<Eigen::Vector3f>& points;  ///< row by row, sensor at the origin; not finite: no reading
  const std::vector<Eigen::Vector3f>& normals; ///< unit, towards the sensor; NaN: none
  int width;
  int height;
  float pitch; ///< tangent of the angle between two columns

  bool valid (int i) const { return (std::isfinite (points[i].sum ()) && points[i].z () > 0.0f); }

  bool hasNormal (int i) const { return (std::isfinite (normals[i].x ())); }

  /** \brief Standard deviation of the depth at a pixel, metres. */
  float sigma (int i) const { return (static_cast<float> (depthNoiseSigma (points[i].z ()))); }

  /** \brief The largest width, in pixels, of the shadow beside a thing. */
  int shadowWidth () const { return (width / 16); }

  /** \brief Whether two pixels that are \a steps apart may be on one surface (largestSurfaceStep ()). */
  bool continuous (int i, int j, int steps = 1) const
  {
    const float z = std::min (points[i].z (), points[j].z ());
    return std::abs (points[i].z () - points[j].z ()) <= largestSurfaceStep (z, pitch * z * steps);
  }
};

/** \brief Call \a follow (first pixel, stride, number of pixels, axis) for all rows (axis 0) and columns (axis 1). */
template <typename Follow>
void
forEachLine (const DepthGrid& grid, Follow&& follow)
{
  for (int v = 0; v < grid.height; ++v)
    follow (v * grid.width, 1, grid.width, 0);
  for (int u = 0; u < grid.width; ++u)
    follow (u, grid.width, grid.height, 1);
}

/** \brief Unite pixels of a row or a column that continue each other, no more than \a reach_px apart, where
 * \a alike (i, j) holds. */
template <typename Alike>
DisjointSets
connectPixels (const DepthGrid& grid, int reach_px, Alike&& alike)
{
  DisjointSets sets (grid.points.size ());
  forEachLine (grid, [&] (int first, int stride, int steps, int) {
    for (int k = 0; k < steps; ++k)
      for (int gap = 1; gap <= std::min (reach_px, k); ++gap)
        if (const int i = first + k * stride, j = i - gap * stride; alike (i, j) && grid.continuous (i, j, gap))
          sets.unite (static_cast<std::size_t> (i), static_cast<std::size_t> (j));
  });
  return (sets);
}

} // namespace pcl::cosection
