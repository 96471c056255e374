// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_files.h"

#include <pcl/cosection/common/camera.h>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity ();
const Eigen::Vector3d ball_centre (-0.09, 0.0, 0.06);
constexpr double ball_radius = 0.06;
const Eigen::AlignedBox3d box (Eigen::Vector3d (0.05, -0.04, 0.0), Eigen::Vector3d (0.13, 0.04, 0.08));

double
hitTable (const Eigen::Vector3d& origin, const Eigen::Vector3d& ray)
{
  return (ray.z () < 0.0 ? -origin.z () / ray.z () : infinity);
}

double
hitBall (const Eigen::Vector3d& origin, const Eigen::Vector3d& ray)
{
  const Eigen::Vector3d d = origin - ball_centre;
  const double a = ray.squaredNorm (), b = ray.dot (d), c = d.squaredNorm () - ball_radius * ball_radius;
  const double root = b * b - a * c;
  return (root > 0.0 ? (-b - std::sqrt (root)) / a : infinity);
}

double
hitBox (const Eigen::Vector3d& origin, const Eigen::Vector3d& ray)
{
  const Eigen::Array3d a = (box.min () - origin).array () / ray.array ();
  const Eigen::Array3d b = (box.max () - origin).array () / ray.array ();
  const double near = a.min (b).maxCoeff (), far = a.max (b).minCoeff ();
  return (near <= far && near > 0.0 ? near : infinity);
}

/** \brief Half a metre away, looking down at the origin. */
Eigen::Isometry3d
sensorPose ()
{
  const Eigen::Vector3d eye (0.0, -0.4, 0.35);
  const Eigen::Vector3d z = -eye.normalized ();
  const Eigen::Vector3d x = z.cross (Eigen::Vector3d::UnitZ ()).normalized ();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity ();
  T.linear () << x, z.cross (x), z;
  T.translation () = eye;
  return (T);
}

} // namespace

void
writeTableScene (const std::string& path)
{
  const pcl::cosection::PinholeCamera camera{160, 120, 150.0, 150.0, 79.5, 59.5};
  const Eigen::Isometry3d T = sensorPose ();
  pcl::PointCloud<pcl::PointXYZRGBL> cloud (camera.width, camera.height);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
    {
      const Eigen::Vector3d ray = camera.unproject (u, v, 1.0);
      const Eigen::Vector3d origin = T.translation (), direction = T.linear () * ray;
      const double hits[3] = {hitTable (origin, direction), hitBall (origin, direction), hitBox (origin, direction)};
      const auto nearest = std::min_element (hits, hits + 3);
      auto& p = cloud.at (u, v);
      p.getVector3fMap () = (ray * *nearest).cast<float> ();
      if (!std::isfinite (*nearest))
        p.getVector3fMap ().setConstant (std::numeric_limits<float>::quiet_NaN ());
      p.label = static_cast<std::uint32_t> (nearest - hits);
      p.r = p.label == 1 ? 200 : 40;
      p.g = 80;
      p.b = p.label == 2 ? 200 : 40;
    }
  cloud.is_dense = false;
  cloud.sensor_origin_.head<3> () = T.translation ().cast<float> ();
  cloud.sensor_orientation_ = Eigen::Quaternionf (T.linear ().cast<float> ());
  pcl::io::savePCDFileBinaryCompressed (path, cloud);
}

void
writeSphere (const std::string& path, int count)
{
  pcl::PointCloud<pcl::PointNormal> cloud;
  for (int i = 0; i < count; ++i) // Fibonacci's sphere
  {
    const double z = 1.0 - (2.0 * i + 1.0) / count, r = std::sqrt (1.0 - z * z), angle = 2.399963229728653 * i;
    pcl::PointNormal p;
    p.getNormalVector3fMap () = Eigen::Vector3d (r * std::cos (angle), r * std::sin (angle), z).cast<float> ();
    p.getVector3fMap () = 0.1f * p.getNormalVector3fMap () + Eigen::Vector3f (0.0f, 0.0f, 0.5f);
    cloud.push_back (p);
  }
  pcl::io::savePCDFileBinary (path, cloud);
}
