// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/simulation/simulated_scene.h>
#include <pcl/cosection/volume/tsdf_volume.h>

#include <Eigen/Geometry>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace pcl::cosection::test {

/** \brief A camera that sees a body well from a distance. */
inline const PinholeCamera body_camera{320, 240, 262.5, 262.5, 159.5, 119.5};
constexpr double body_distance_m = 0.7;

/** \brief Depth image of one body; the pose is relative to the body's frame. */
struct BodyView
{
  Eigen::Isometry3d T_body_sensor;
  Image<float> depth;

  std::vector<Eigen::Vector3f> points (const PinholeCamera& camera) const;
};

/** \brief An object of one of the presets, at the origin of its frame. */
SceneBody presetBody (const std::string& preset, const std::string& name);

/** \brief Sensors on a sphere about \a center: \a count of them, spread evenly over the upper three quarters. */
std::vector<Eigen::Isometry3d> posesAroundBody (const Eigen::Vector3d& center, double distance_m, int count,
                                                double turn_rad = 0.0);

/** \brief A sensor pose on a circle above \a center, at the angle \a turn_rad. */
Eigen::Isometry3d poseOnCircle (const Eigen::Vector3d& center, double distance_m, double turn_rad);

/** \brief Depth images of a body alone. \param[in] noise of structured light */
std::vector<BodyView> renderBody (const SceneBody& body, const PinholeCamera& camera,
                                  const std::vector<Eigen::Isometry3d>& poses, bool noise);

/** \brief A cube of voxels around the body, a quarter larger than it. */
VoxelGrid bodyGrid (const SceneBody& body, int resolution);

/** \brief The body's true signed distance. */
SignedDistanceField bodyDistance (const SceneBody& body, int resolution);

TsdfVolume bodyTsdf (const SceneBody& body, const PinholeCamera& camera, const std::vector<BodyView>& views,
                     int resolution, const TsdfOptions& options = {});

/** \brief Centre of the body's box. */
Eigen::Vector3d bodyCenter (const SceneBody& body);

/** \brief A turn about a random axis through \a center, and a shift in a random direction, each uniform up to its
 * bound. */
Eigen::Isometry3d randomMotion (std::mt19937& random, const Eigen::Vector3d& center, double max_angle_rad,
                                double max_shift_m);

/** \brief Error of a sensor pose, in terms of the body: the displacement of the body's \a center, and the angle. */
struct PoseError
{
  PoseError (const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth, const Eigen::Vector3d& center)
  {
    const Eigen::Isometry3d motion = estimate * truth.inverse ();
    shift_m = (motion * center - center).norm ();
    angle_rad = Eigen::AngleAxisd (motion.linear ()).angle ();
  }

  double shift_m;
  double angle_rad;
};

constexpr double
radians (double degrees)
{
  return degrees * M_PI / 180.0;
}

} // namespace pcl::cosection::test
