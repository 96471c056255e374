// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "analytic_scene.h"

#include <limits>

namespace pcl::cosection::test {
namespace {

constexpr double hit_m = 1e-6;
constexpr double difference_m = 1e-5;
constexpr int max_steps = 400;

} // namespace

Distance
placed (const Distance& shape, const Eigen::Isometry3d& T_world_shape)
{
  return [shape, T = T_world_shape.inverse ()] (const Eigen::Vector3d& p) { return shape (T * p); };
}

Distance
placed (const Distance& shape, const Eigen::Vector3d& position)
{
  return [shape, position] (const Eigen::Vector3d& p) { return shape (p - position); };
}

Distance
cup (double outer_radius, double height, double wall)
{
  // The profile in the half plane (radius, z): a rectangle for the bottom and one for the wall.
  const auto rectangle = [] (const Eigen::Vector2d& p, const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
    const Eigen::Vector2d q = (p - 0.5 * (low + high)).cwiseAbs () - 0.5 * (high - low);
    return q.cwiseMax (0.0).norm () + std::min (q.maxCoeff (), 0.0);
  };
  return [=] (const Eigen::Vector3d& p) {
    const Eigen::Vector2d q (p.head<2> ().norm (), p.z ());
    return std::min (rectangle (q, {-outer_radius, 0.0}, {outer_radius, wall}),
                     rectangle (q, {outer_radius - wall, 0.0}, {outer_radius, height}));
  };
}

Distance
halfSpace (const Eigen::Vector4d& plane)
{
  return [plane] (const Eigen::Vector3d& p) { return plane.head<3> ().dot (p) + plane[3]; };
}

Eigen::Vector3d
gradient (const Distance& distance, const Eigen::Vector3d& p)
{
  Eigen::Vector3d g;
  for (int a = 0; a < 3; ++a)
  {
    const Eigen::Vector3d step = difference_m * Eigen::Vector3d::Unit (a);
    g[a] = distance (p + step) - distance (p - step);
  }
  return g.normalized ();
}

void
AnalyticScene::add (int label, Distance shape)
{
  shapes_[label] = std::move (shape);
}

RenderedView
AnalyticScene::render (const PinholeCamera& camera, const Eigen::Isometry3d& T_world_sensor, double max_range_m) const
{
  RenderedView out;
  out.view.camera = camera;
  out.view.T_world_sensor = T_world_sensor;
  const std::size_t pixels = static_cast<std::size_t> (camera.width) * camera.height;
  out.view.depth.assign (pixels, std::numeric_limits<float>::quiet_NaN ());
  out.labels.assign (pixels, -1);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
    {
      const Eigen::Vector3d ray = camera.unproject (u, v, 1.0).normalized ();
      const Eigen::Vector3d direction = T_world_sensor.linear () * ray;
      double range = 0.0;
      for (int step = 0; step < max_steps && range < max_range_m; ++step)
      {
        const Eigen::Vector3d p = T_world_sensor.translation () + range * direction;
        double nearest = std::numeric_limits<double>::infinity ();
        int label = -1;
        for (const auto& [l, shape] : shapes_)
          if (const double d = shape (p); d < nearest)
          {
            nearest = d;
            label = l;
          }
        range += nearest;
        if (nearest > hit_m)
          continue;
        const std::size_t n = static_cast<std::size_t> (v) * camera.width + u;
        out.view.depth[n] = static_cast<float> (range * ray.z ());
        out.labels[n] = label;
        OrientedPoint point;
        point.position = (T_world_sensor.translation () + range * direction).cast<float> ();
        point.normal = gradient (shapes_.at (label), p).cast<float> ();
        out.points[label].push_back (point);
        break;
      }
    }
  return out;
}

AnalyticScene
AnalyticScene::moved (const Eigen::Isometry3d& T) const
{
  AnalyticScene out;
  for (const auto& [label, shape] : shapes_)
    out.add (label, placed (shape, T));
  return out;
}

} // namespace pcl::cosection::test
