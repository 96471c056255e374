// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Geometry>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace pcl::cosection::test {

/** \brief Length of a ray (unit direction) to a surface; NaN: it misses. */
using RayLength = std::function<double (const Eigen::Vector3d& origin, const Eigen::Vector3d& direction)>;

inline RayLength
sphereRay (double radius, const Eigen::Vector3d& center = Eigen::Vector3d::Zero ())
{
  return [=] (const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
    const Eigen::Vector3d p = origin - center;
    const double b = p.dot (direction);
    return -b - std::sqrt (b * b - p.squaredNorm () + radius * radius);
  };
}

/** \brief The plane of points p with normal . p = offset. */
inline RayLength
planeRay (const Eigen::Vector3d& normal, double offset)
{
  return [=] (const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
    const double length = (offset - normal.dot (origin)) / normal.dot (direction);
    return length > 0.0 ? length : std::numeric_limits<double>::quiet_NaN ();
  };
}

/** \brief The first of two surfaces. */
inline RayLength
nearerRay (const RayLength& a, const RayLength& b)
{
  return [=] (const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
    return std::fmin (a (origin, direction), b (origin, direction));
  };
}

inline PinholeCamera
smallCamera ()
{
  return {160, 120, 140.0, 142.0, 79.2, 60.3};
}

inline Image<float>
renderDepth (const RayLength& surface, const PinholeCamera& camera, const Eigen::Isometry3d& T_grid_sensor)
{
  Image<float> depth (camera.width, camera.height);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
    {
      const Eigen::Vector3d ray = camera.unproject (u, v, 1.0);
      const double length = surface (T_grid_sensor.translation (), T_grid_sensor.linear () * ray.normalized ());
      depth.at (u, v) = static_cast<float> (length / ray.norm ());
    }
  return depth;
}

/** \brief Pose of a sensor at \a eye that looks at the origin. */
inline Eigen::Isometry3d
lookAtOrigin (const Eigen::Vector3d& eye)
{
  const Eigen::Vector3d z = -eye.normalized ();
  const Eigen::Vector3d x = z.unitOrthogonal ();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity ();
  pose.linear () << x, z.cross (x), z;
  pose.translation () = eye;
  return pose;
}

/** \brief Sensors all around the origin, at the corners and the face centres of a cube. */
inline std::vector<Eigen::Isometry3d>
posesAround (double distance)
{
  std::vector<Eigen::Isometry3d> poses;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (const int n = std::abs (x) + std::abs (y) + std::abs (z); n == 1 || n == 3)
          poses.push_back (lookAtOrigin (Eigen::Vector3d (x, y, z).normalized () * distance));
  return poses;
}

/** \brief A sensor half a metre before the origin, looking along z. */
inline Eigen::Isometry3d
frontPose ()
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity ();
  pose.translation ().z () = -0.5;
  return pose;
}

/** \brief A constant depth image of smallCamera (). */
inline Image<float>
wallDepth (float depth_m)
{
  const PinholeCamera camera = smallCamera ();
  return Image<float> (camera.width, camera.height, depth_m);
}

/** \brief A cube of voxels about the origin. */
inline VoxelGrid
cubeGrid (int dim, double voxel_size_m)
{
  VoxelGrid grid;
  grid.dims.setConstant (dim);
  grid.voxel_size_m = voxel_size_m;
  grid.origin_m.setConstant (-0.5 * voxel_size_m * (dim - 1));
  return grid;
}

} // namespace pcl::cosection::test
