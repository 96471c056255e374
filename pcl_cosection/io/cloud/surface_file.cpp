// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "surface_file.h"

#include "cloud_file.h"
#include "pcl_cosection/io/lower_case.h"
#include "sensor_cloud.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>

namespace pcl::cosection {
namespace {

bool
holdsPoints (const std::string& path)
{
  const std::string extension = lowerCaseExtension (path);
  if (extension == ".pcd")
    return true;
  return extension == ".ply" && !readCloudHeader (path).has_faces;
}

} // namespace

SurfaceFile
loadSurface (const std::string& path, const std::optional<Eigen::Vector3d>& origin)
{
  SurfaceFile surface;
  if (!holdsPoints (path))
  {
    surface.origin = origin ? *origin : localOrigin (path);
    surface.mesh = loadMesh (path, surface.origin);
    return surface;
  }
  PcdViewOptions options;
  if (origin)
    options.origin = {origin->x (), origin->y (), origin->z ()};
  const SensorCloud cloud = readSensorCloud (path, options, false);
  surface.origin = cloud.origin;
  for (const Eigen::Vector3f& p : cloud.positions)
    if (p.allFinite ())
      surface.mesh.vertices.push_back ((cloud.T_world_sensor * p.cast<double> ()).cast<float> ());
  if (surface.mesh.vertices.empty ())
    throw DegenerateInput (path + ": none of its points is finite");
  return surface;
}

} // namespace pcl::cosection
