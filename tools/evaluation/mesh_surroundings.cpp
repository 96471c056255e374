// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mesh_surroundings.h"

#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/evaluation/penetration.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/io/pcd_view.h>

#include <algorithm>

using namespace pcl::cosection;

namespace {

std::vector<Surroundings::Obstacle>
measureObstacles (const MeshSettings& settings, const Eigen::Vector3d& origin, const TriangleMesh& reconstruction,
                  std::vector<std::string>& warnings)
{
  std::vector<Surroundings::Obstacle> obstacles;
  if (settings.obstacles.empty ())
    return (obstacles);
  PenetrationOptions options;
  options.seed = settings.seed;
  options.voxel_size_m = settings.penetration_voxel_m;
  options.threads = settings.threads;
  const PenetrationBody body (reconstruction, options);
  for (const std::string& file : settings.obstacles)
  {
    const PenetrationBody obstacle (loadMesh (file, origin), options);
    Surroundings::Obstacle result;
    result.file = file;
    result.is_open = obstacle.isOpen ();
    result.depth_m = obstacle.depthOf (body);
    result.volume_m3 = obstacle.sharedVolume (body);
    if (result.is_open)
      warnings.push_back (file + " is open and has no inside: only what is less than " +
                          inMillimetres (options.band_m) + " mm behind it counts as penetration");
    obstacles.push_back (result);
  }
  return (obstacles);
}

FreeSpaceViolation
measureFreeSpace (const MeshSettings& settings, const Eigen::Vector3d& origin, const TriangleMesh& reconstruction,
                  std::vector<std::string>& warnings)
{
  std::vector<DepthView> views;
  PcdViewOptions options;
  options.threads = settings.threads;
  options.origin = {origin.x (), origin.y (), origin.z ()};
  for (const std::string& file : settings.views)
  {
    LabelledView view = readPcdView (file, options);
    warnings.insert (warnings.end (), view.warnings.begin (), view.warnings.end ());
    if (!view.view)
      throw DegenerateInput (
          file + ": has no depth image that shows free space; it must be an organised cloud of a pinhole camera");
    views.push_back (std::move (*view.view));
  }
  const auto points = sampleSurface (reconstruction, static_cast<std::size_t> (settings.samples), settings.seed);
  const FreeSpaceViolation result = measureFreeSpaceViolation (points, views, settings.free_space_tolerance_m);
  if (result.in_view == 0)
    warnings.emplace_back ("no view has readings where the reconstruction is: they say nothing about free space");
  return (result);
}

} // namespace

double
Surroundings::penetration_m () const
{
  double depth_m = 0.0;
  for (const Obstacle& obstacle : obstacles)
    depth_m = std::max (depth_m, obstacle.depth_m);
  return (depth_m);
}

Surroundings
measureSurroundings (const MeshSettings& settings, const Eigen::Vector3d& origin, const TriangleMesh& reconstruction,
                     std::vector<std::string>& warnings)
{
  Surroundings surroundings;
  surroundings.obstacles = measureObstacles (settings, origin, reconstruction, warnings);
  if (!settings.views.empty ())
    surroundings.free_space = measureFreeSpace (settings, origin, reconstruction, warnings);
  return (surroundings);
}

void
print (const Surroundings& surroundings, Terminal& terminal)
{
  for (const Surroundings::Obstacle& obstacle : surroundings.obstacles)
    terminal.result ("penetration of " + obstacle.file + ": " +
                     (obstacle.depth_m > 0.0 ? inMillimetres (obstacle.depth_m) + " mm deep" : "none") +
                     (obstacle.volume_m3 ? ", " + inMillilitres (*obstacle.volume_m3) + " ml" : ""));
  if (surroundings.free_space)
    terminal.result (
        "in seen free space: " + inPercent (surroundings.free_space->share) + " of the surface" +
        (surroundings.free_space->share > 0.0
             ? ", up to " + inMillimetres (surroundings.free_space->max_depth_m) + " mm in front of a reading"
             : ""));
}

void
addSurroundings (const Surroundings& surroundings, Json& json)
{
  if (!surroundings.obstacles.empty ())
  {
    json["penetration_m"] = surroundings.penetration_m ();
    json["obstacles"] = Json::array ();
    for (const Surroundings::Obstacle& obstacle : surroundings.obstacles)
      json["obstacles"].push_back ({{"file", obstacle.file},
                                    {"open", obstacle.is_open},
                                    {"penetration_m", obstacle.depth_m},
                                    {"penetration_m3", orNull (obstacle.volume_m3)}});
  }
  if (surroundings.free_space)
    json["free_space"] = {{"violation", surroundings.free_space->share},
                          {"max_depth_m", surroundings.free_space->max_depth_m},
                          {"points_in_view", surroundings.free_space->in_view}};
}
