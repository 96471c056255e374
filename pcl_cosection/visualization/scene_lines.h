// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/visualization/scene_picture.h>

#include <vector>

namespace pcl::cosection {

/** \brief A straight line in the world. */
struct SceneLine
{
  Eigen::Vector3d begin, end; ///< metres
  TriangleMesh::Colour colour;
};

/** \brief The lines that a view shows: the way of the camera so far, what it sees up to half a metre away, or less in
 * small scenes, and boxes around objects along the axes of their frames. */
PCL_COSECTION_EXPORT std::vector<SceneLine> linesOf (const RunScene& scene, double stamp, const SceneView& view);

} // namespace pcl::cosection
