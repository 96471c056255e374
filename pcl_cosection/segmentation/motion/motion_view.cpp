// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "motion_view.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/segmentation/geometry/support_surfaces.h"

#include "pcl_cosection/common/parallel.h"
#include <pcl/cosection/surface/normals.h>

#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr int columns = 320;               // about
constexpr float min_area_m2 = 0.1f;        // of the room's largest plane
constexpr int least_known = 6;             // of the nine readings around a place
constexpr float noise_sigmas = 10.0f;      // larger differences are no noise
constexpr float quartile_sigmas = 1.1503f; // three quarters of a normal distribution are within
constexpr float aside_share = 0.002f; // of the depth: what a step to the next pixel counts beside a difference in depth

/** \brief Every how manieth pixel of a row or column is kept. */
int
reductionOf (const PinholeCamera& camera)
{
  return std::max (1, static_cast<int> (std::lround (static_cast<double> (camera.width) / columns)));
}

} // namespace

MotionView
makeMotionView (const MotionFrame& frame)
{
  const PinholeCamera& camera = frame.camera;
  const int step = reductionOf (camera);
  const int first = step / 2;
  MotionView view;
  view.camera = PinholeCamera{camera.width / step, camera.height / step,       camera.fx / step,
                              camera.fy / step,    (camera.cx - first) / step, (camera.cy - first) / step};
  view.T_world_sensor = frame.T_world_sensor;
  view.T_world_body = frame.T_world_body;
  for (int v = 0; v < view.camera.height; ++v)
    for (int u = 0; u < view.camera.width; ++u)
    {
      const std::size_t n = static_cast<std::size_t> (v * step + first) * camera.width + u * step + first;
      view.points.push_back (frame.points[n]);
      view.bodies.push_back (frame.bodies.empty () ? 0u : frame.bodies[n]);
    }
  return view;
}

void
analyse (MotionView& view, const MotionSegmentationOptions& options)
{
  if (!view.room.empty ())
    return;
  OrganizedNormalsOptions normals;
  normals.threads = options.threads;
  view.normals = computeOrganizedNormals (view.points, view.camera.width, view.camera.height, {}, normals);
  const DepthGrid grid = view.grid ();
  const std::vector<SupportSurface> surfaces = findSupportSurfaces (
      grid, static_cast<float> (options.max_object_size_m), min_area_m2);
  view.room.assign (view.points.size (), 0);
  parallelFor (0, grid.height, options.threads, [&] (int v) {
    for (int u = 0; u < grid.width; ++u)
      if (const int i = v * grid.width + u; grid.valid (i))
        view.room[i] = std::any_of (surfaces.begin (), surfaces.end (), [&] (const SupportSurface& surface) {
          return surface.distance (grid, u, v) < 1.0f;
        });
  });
}

Sighting
sightAt (const MotionView& view, const Eigen::Vector3f& q)
{
  Sighting result;
  if (!(q.z () > 0.0f))
    return result;
  const int width = view.camera.width;
  const int height = view.camera.height;
  const auto u = static_cast<int> (std::lround (view.camera.fx * q.x () / q.z () + view.camera.cx));
  const auto v = static_cast<int> (std::lround (view.camera.fy * q.y () / q.z () + view.camera.cy));
  if (u < 1 || v < 1 || u + 1 >= width || v + 1 >= height)
    return result;
  int known = 0;
  for (int vv = v - 1; vv <= v + 1; ++vv)
    for (int uu = u - 1; uu <= u + 1; ++uu)
    {
      const int i = vv * width + uu;
      const float ahead = view.points[i].z () - q.z ();
      if (!std::isfinite (ahead))
        continue;
      ++known;
      if (result.pixel < 0 || std::abs (ahead) < std::abs (result.ahead_m))
        result = {i, ahead};
    }
  return known >= least_known ? result : Sighting ();
}

std::vector<Sighting>
compareViews (const MotionView& view, const MotionView& other, const Eigen::Isometry3d& T_other_view, int threads)
{
  std::vector<Sighting> sightings (view.points.size ());
  const Eigen::Isometry3f T = T_other_view.cast<float> ();
  parallelFor (0, static_cast<int> (view.points.size ()), threads, [&] (int i) {
    if (std::isfinite (view.points[i].z ()))
      sightings[i] = sightAt (other, T * view.points[i]);
  });
  return sightings;
}

float
noiseScale (const MotionView& view, const std::vector<Sighting>& sightings)
{
  std::vector<float> sizes;
  for (std::size_t i = 0; i < sightings.size (); ++i)
    if (sightings[i].pixel >= 0)
    {
      const float size = std::abs (sightings[i].ahead_m) / differenceSigma (view.points[i].z ());
      if (size < noise_sigmas)
        sizes.push_back (size);
    }
  if (sizes.empty ())
    return 1.0f;
  return std::max (1.0f, valueOfRank (sizes, 3 * sizes.size () / 4) / quartile_sigmas);
}

std::vector<std::uint32_t>
enlarged (const std::vector<std::uint32_t>& labels, const MotionView& view, const MotionFrame& frame)
{
  const int step = reductionOf (frame.camera);
  if (step == 1)
    return labels;
  std::vector<std::uint32_t> result (frame.points.size (), 0);
  for (int v = 0; v < frame.camera.height; ++v)
    for (int u = 0; u < frame.camera.width; ++u)
    {
      const std::size_t n = static_cast<std::size_t> (v) * frame.camera.width + u;
      const float z = frame.points[n].z ();
      if (!std::isfinite (z))
        continue;
      const int column = std::min (view.camera.width - 1, u / step);
      const int row = std::min (view.camera.height - 1, v / step);
      float best = std::numeric_limits<float>::max ();
      for (int j = std::max (0, row - 1); j <= std::min (view.camera.height - 1, row + 1); ++j)
        for (int i = std::max (0, column - 1); i <= std::min (view.camera.width - 1, column + 1); ++i)
        {
          const int k = j * view.camera.width + i;
          const auto aside = static_cast<float> (std::abs (i - column) + std::abs (j - row));
          const float distance = std::abs (view.points[k].z () - z) + aside_share * z * aside;
          if (distance < best)
          {
            best = distance;
            result[n] = labels[k];
          }
        }
    }
  return result;
}

} // namespace pcl::cosection
