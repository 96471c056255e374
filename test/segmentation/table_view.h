// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace pcl::cosection::test {

/** \brief A noisy camera's view of a scene, and the truth. */
struct SceneView
{
  int width = 0;
  int height = 0;
  std::vector<Eigen::Vector3f> points; ///< sensor frame, NaN: no reading
  std::vector<std::uint32_t> labels;
  std::vector<char> valid;
};

/** \brief A view of objects on a table with a wall behind and a floor below.
 * \param[in] objects contents of "objects" of a scene's description
 * \param[in] eye place of the camera, which looks at the middle of the table, the origin */
SceneView viewOfTable (const std::string& objects, const Eigen::Vector3d& eye = {-0.3, -0.85, 0.65});

/** \brief A noisy camera's view of a scene.
 * \param[in] background, objects contents of "parts" and of "objects" of a scene's description */
SceneView viewOfScene (const std::string& background, const std::string& objects, const Eigen::Vector3d& eye,
                       const Eigen::Vector3d& look_at);

/** \brief A box that stands on the table. */
std::string boxOnTable (int id, const Eigen::Vector3d& size, const Eigen::Vector3d& foot, double yaw_deg);

} // namespace pcl::cosection::test
