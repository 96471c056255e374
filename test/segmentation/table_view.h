// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/camera.h>

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace pcl::cosection::test
{

/** \brief What a noisy camera sees of a scene, and the truth. */
struct SceneView
{
  int width = 0;
  int height = 0;
  std::vector<Eigen::Vector3f> points; ///< sensor frame, NaN: no reading
  std::vector<std::uint32_t> labels;
  std::vector<char> valid;
};

/** \brief Objects on a table with a wall behind and a floor below.
 * \param[in] objects description of the objects, the contents of "objects" of a scene's
 * \param[in] eye where the camera is; it looks at the middle of the table, which is at the origin */
SceneView viewOfTable (const std::string& objects, const Eigen::Vector3d& eye = {-0.3, -0.85, 0.65});

/** \brief What a noisy camera sees of a scene.
 * \param[in] background, objects descriptions of their shapes, the contents of "parts" and of "objects" of a scene's */
SceneView viewOfScene (const std::string& background, const std::string& objects, const Eigen::Vector3d& eye,
                       const Eigen::Vector3d& look_at);

/** \brief A box on the table, vertical. */
std::string boxOnTable (int id, const Eigen::Vector3d& size, const Eigen::Vector3d& foot, double yaw_deg);

} // namespace pcl::cosection::test
