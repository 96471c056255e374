// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief Polygons as files have them, unchecked: any number of corners, indices that may not exist. */
struct PolygonSoup
{
  std::vector<Eigen::Vector3f> points;
  std::vector<std::int64_t> corners; ///< indices of points, those of one polygon behind those of another
  std::vector<std::size_t> ends;     ///< where each polygon ends in \a corners

  /** \brief End a polygon: its corners are those that were added since the last one. */
  void endPolygon () { ends.push_back (corners.size ()); }

  /** \brief Add the triangles of a strip: each has three consecutive indices, and every other one is turned. */
  void addStrip (const std::vector<std::int64_t>& strip);
};

/** \brief The triangles of a soup: polygons are triangulated, what its vertices imply is made so
 * (cleanMesh ()), and triangles are turned to agree and face outward (orientTriangles ()).
 * \throws IoError, whose message is only the reason */
TriangleMesh makeMesh (const PolygonSoup& soup);

} // namespace pcl::cosection
