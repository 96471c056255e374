// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "table_views.h"

#include "doc/demo/shapes.h"

#include "pcl_cosection/rendering/picture.h"
#include "pcl_cosection/view/look_at.h"
#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/rendering/rasterizer.h>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

using namespace pcl::cosection;

namespace {

constexpr double depth_edge_m = 0.05;  ///< across larger steps between pixels a reading may be a mixture
constexpr double mixed_share = 0.3;    ///< of the pixels at such steps
constexpr double min_incidence = 0.17; ///< cosine; at flatter angles nothing is read
constexpr float missing = std::numeric_limits<float>::quiet_NaN ();

/** \brief Numbers that are the same with every standard library. */
class Random
{
public:
  double uniform () { return (generator_ () + 0.5) / 4294967296.0; }

  double gauss ()
  {
    const double radius = std::sqrt (-2.0 * std::log (uniform ()));
    return radius * std::cos (2.0 * M_PI * uniform ());
  }

private:
  std::mt19937 generator_{2020};
};

RasterImage
render (const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera, bool with_visitor)
{
  const TriangleMesh bottle = revolve ({{0.0f, 0.0f},
                                        {0.036f, 0.0f},
                                        {0.038f, 0.002f},
                                        {0.038f, 0.110f},
                                        {0.034f, 0.125f},
                                        {0.020f, 0.145f},
                                        {0.015f, 0.155f},
                                        {0.015f, 0.190f},
                                        {0.0f, 0.190f}});
  const auto at = [] (double x, double y, double z, double turn_rad = 0.0) {
    return Eigen::Isometry3d (Eigen::Translation3d (x, y, z) * Eigen::AngleAxisd (turn_rad, Eigen::Vector3d::UnitZ ()));
  };
  Rasterizer rasterizer (camera, T_world_camera);
  rasterizer.draw (makeBox ({1.3f, 1.1f, 0.03f}), 0, at (0.0, 0.15, -0.015), {196, 164, 124}); // the table
  rasterizer.draw (makeBox ({6.0f, 6.0f, 0.03f}), 0, at (0.0, 0.0, -0.75), {120, 120, 125});   // the floor
  rasterizer.draw (makeBox ({0.16f, 0.10f, 0.12f}), 1, at (-0.12, 0.04, 0.06, 0.5), {60, 120, 190});
  rasterizer.draw (makeBall (0.055f), 2, at (0.035, -0.06, 0.055), {205, 75, 60});
  rasterizer.draw (bottle, 3, at (0.15, 0.07, 0.0), {80, 160, 95});
  if (with_visitor)
    rasterizer.draw (makeBall (0.045f), 4, at (0.0, 0.1, 0.17), {230, 190, 160});
  return rasterizer.image ();
}

pcl::PointCloud<pcl::PointXYZRGBL>
measure (const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera, bool with_visitor, Random& random)
{
  const RasterImage image = render (camera, T_world_camera, with_visitor);
  const Picture picture = shade (image, camera);
  pcl::PointCloud<pcl::PointXYZRGBL> cloud (camera.width, camera.height);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
    {
      const std::size_t n = static_cast<std::size_t> (v) * camera.width + u;
      pcl::PointXYZRGBL& point = cloud[n];
      point.r = picture.pixels[n][0];
      point.g = picture.pixels[n][1];
      point.b = picture.pixels[n][2];
      point.label = static_cast<std::uint32_t> (std::max (0, image.ids[n]));
      point.getVector3fMap ().setConstant (missing);

      const Eigen::Vector3d ray = camera.unproject (u, v, 1.0);
      if (-ray.normalized ().dot (image.normals[n].cast<double> ()) < min_incidence)
        continue;
      double depth = image.depth[n];
      const double noise = random.gauss ();
      const double other = u + 1 < camera.width ? image.depth[n + 1] : depth;
      if (std::abs (other - depth) > depth_edge_m && random.uniform () < mixed_share)
        depth += random.uniform () * (other - depth);
      point.getVector3fMap () = ((depth + noise * depthNoiseSigma (depth)) * ray).cast<float> ();
    }
  cloud.is_dense = false;
  cloud.sensor_origin_ << T_world_camera.translation ().cast<float> (), 1.0f;
  cloud.sensor_orientation_ = Eigen::Quaternionf (T_world_camera.linear ().cast<float> ());
  return cloud;
}

} // namespace

std::vector<std::string>
writeTableViews (const std::string& folder)
{
  const PinholeCamera camera{320, 240, 262.5, 262.5, 159.5, 119.5};
  const Eigen::Vector3d middle (0.02, 0.02, 0.05);
  const std::vector<Eigen::Vector3d> eyes{{0.02, -0.55, 0.42}, {0.45, -0.38, 0.45}, {-0.45, -0.36, 0.45}};
  Random random;
  std::vector<std::string> paths;
  for (const Eigen::Vector3d& eye : eyes)
  {
    const bool with_visitor = paths.size () == 1;
    paths.push_back (folder + "/view_" + std::to_string (paths.size () + 1) + ".pcd");
    const auto cloud = measure (camera, lookAt (eye, middle), with_visitor, random);
    if (pcl::io::savePCDFileBinaryCompressed (paths.back (), cloud) != 0)
      throw std::runtime_error ("cannot write " + paths.back ());
  }
  return paths;
}
