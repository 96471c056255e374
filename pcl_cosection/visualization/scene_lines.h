// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/visualization/run_scene.h>

#include <Eigen/Geometry>

#include <vector>

namespace pcl::cosection {

/** \brief A straight line in the world. */
struct SceneLine
{
  Eigen::Vector3d begin, end; ///< metres
  TriangleMesh::Colour colour;
};

/** \brief The way of the camera up to a time. */
PCL_COSECTION_EXPORT std::vector<SceneLine> pathLines (const RunScene& scene, double stamp);

/** \brief What a camera sees up to half a metre away, or less in small scenes. */
PCL_COSECTION_EXPORT std::vector<SceneLine> frustumLines (const RunScene& scene,
                                                          const Eigen::Isometry3d& T_world_camera);

/** \brief The box around an object, along the axes of its frame; nothing where it is not known. */
PCL_COSECTION_EXPORT std::vector<SceneLine> boxLines (const RunScene& scene, const SceneRecord::Object& object,
                                                      SurfaceMode surface, double stamp);

/** \brief Points of lines, so near each other that they touch in the picture of a camera. */
void samplePoints (const std::vector<SceneLine>& lines, const PinholeCamera& camera,
                   const Eigen::Isometry3d& T_world_camera, std::vector<Eigen::Vector3f>& points,
                   std::vector<TriangleMesh::Colour>& colours);

} // namespace pcl::cosection
