// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "organized_view.h"

#include "pcl_cosection/io/place_text.h"
#include "pcl_cosection/view/normals/estimated_normals.h"
#include "pcl_cosection/view/normals/grazing_surfaces.h"
#include "pcl_cosection/view/outliers/mixed_pixels.h"
#include "sensor_view.h"

#include "pcl_cosection/view/camera_resection.h"
#include <pcl/cosection/surface/normals.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN ();
constexpr double intrinsics_tolerance_px = 2.0;
constexpr double same_place = 0.05;       // of the distance to the points: two places of one sensor
constexpr double least_reliable = 0.15;   // share of a label's points with a reliable normal ...
constexpr std::size_t least_points = 100; // ... and their number: with fewer, points without an order say more

/** \brief Root mean square distance of the points from their pixels under a camera. */
double
reprojectionError (const SensorCloud& cloud, const PinholeCamera& camera)
{
  double sum = 0.0;
  std::size_t count = 0;
  for (int v = 0; v < cloud.height; ++v)
    for (int u = 0; u < cloud.width; ++u)
    {
      const Eigen::Vector3f& p = cloud.positions[static_cast<std::size_t> (v) * cloud.width + u];
      if (!(p.z () > 0.0f))
        continue;
      sum += (camera.project (p.cast<double> ()) - Eigen::Vector2d (u, v)).squaredNorm ();
      ++count;
    }
  return (count == 0 ? std::numeric_limits<double>::infinity () : std::sqrt (sum / static_cast<double> (count)));
}

/** \brief Take the points to the sensor at which the camera was found, and say so. */
void
moveToSensor (const std::string& path, const PcdViewOptions& options, const LocatedCamera& located, SensorCloud& cloud,
              LabelledView& result)
{
  cloud.positions = takeToSensor (located.T_points_sensor.inverse (), cloud.positions);
  double distance = 0.0;
  std::size_t count = 0;
  for (const Eigen::Vector3f& p : cloud.positions)
    if (p.allFinite ())
      distance += (p.z () - distance) / static_cast<double> (++count);
  const Eigen::Vector3d found = located.T_points_sensor.translation ();
  const Eigen::Isometry3d given = cloud.T_world_sensor;
  const auto isNear = [&] (const Eigen::Vector3d& place) { return (found - place).norm () < same_place * distance; };
  const bool at_origin = isNear (
      Eigen::Vector3d::Zero ()); // of the points: their axes alone are others than the sensor's
  const bool in_world = !at_origin && cloud.has_viewpoint && !options.world_points && !options.viewpoint &&
                        isNear (given.translation ());
  cloud.T_world_sensor = in_world ? located.T_points_sensor : given * located.T_points_sensor;
  if (in_world)
    result.warnings.push_back (path + ": its VIEWPOINT is where its points were seen from if they are in the world "
                                      "frame: taken as with --world-points");
  else if (at_origin && !options.viewpoint)
    result.warnings.push_back (
        path +
        ": the axes of its points are not x right, y down, z forward; their pixels tell which way the sensor looked");
  else if (!at_origin)
    result.warnings.push_back (
        path + ": its points are not in the frame of their sensor; their pixels tell that it stood at " +
        placeText (cloud.T_world_sensor.translation ()) + ", which is used instead of " + sourceOfViewpoint (options));
}

/** \brief The camera of the cloud, which is taken to its frame. */
std::optional<PinholeCamera>
findCamera (const std::string& path, const PcdViewOptions& options, SensorCloud& cloud, LabelledView& result)
{
  if (const auto fitted = fitPinholeCamera (cloud.positions, cloud.width, cloud.height))
    return fitted;
  std::optional<PinholeCamera> given;
  double error = 0.0;
  if (options.intrinsics)
  {
    const auto& k = *options.intrinsics;
    given = PinholeCamera{cloud.width, cloud.height, k[0], k[1], k[2], k[3]};
    error = reprojectionError (cloud, *given);
    if (error <= intrinsics_tolerance_px)
      return given;
  }
  if (const auto located = locateCamera (cloud.positions, cloud.width, cloud.height))
  {
    moveToSensor (path, options, *located, cloud, result);
    return located->camera;
  }
  if (given)
  {
    std::ostringstream text;
    text.precision (3);
    text << path << ": the points are " << error << " pixels off the given intrinsics; its free space may be wrong";
    result.warnings.push_back (text.str ());
  }
  else
    result.warnings.push_back (
        path + ": organised, but not the image of a pinhole camera in any frame: no free space is taken from it (give "
               "--intrinsics, with --world-points if the points are in the world frame)");
  return given;
}

/** \brief Give labels of which hardly anything has a reliable normal those of points without an order, towards the
 * sensor.
 * \return whether there is any */
bool
addMissingNormals (const PcdViewOptions& options, const Members& members, SensorCloud& cloud)
{
  bool any = false;
  for (const auto& [label, readings] : members)
  {
    const auto reliable = static_cast<std::size_t> (std::count_if (
        readings.begin (), readings.end (), [&] (std::size_t i) { return cloud.normals[i].allFinite (); }));
    if (readings.size () < least_points ||
        (reliable >= least_points &&
         static_cast<double> (reliable) >= least_reliable * static_cast<double> (readings.size ())))
      continue;
    any = true;
    const std::vector<Eigen::Vector3f> positions = pick (cloud.positions, readings);
    const EstimatedNormals estimated = estimateNormals (options, positions);
    for (std::size_t k = 0; k < readings.size (); ++k)
    {
      const Eigen::Vector3f& normal = estimated.normals[estimated.of[k]];
      cloud.normals[readings[k]] = normal.dot (positions[k]) > 0.0f ? Eigen::Vector3f (-normal) : normal;
    }
  }
  return any;
}

} // namespace

void
completeOrganized (const std::string& path, const PcdViewOptions& options, SensorCloud& cloud, LabelledView& result)
{
  if (const auto camera = findCamera (path, options, cloud, result))
  {
    DepthView view;
    view.camera = *camera;
    view.T_world_sensor = cloud.T_world_sensor;
    view.depth.resize (cloud.positions.size ());
    for (std::size_t i = 0; i < view.depth.size (); ++i)
      view.depth[i] = cloud.positions[i].z () > 0.0f ? cloud.positions[i].z () : nan_value;
    result.view = std::move (view);
  }
  OrganizedNormalsOptions normal_options;
  normal_options.threads = options.threads;
  cloud.normals = computeOrganizedNormals (cloud.positions, cloud.width, cloud.height, cloud.labels, normal_options);
  const Members members = membersOf (cloud);
  if (addMissingNormals (options, members, cloud) && result.view)
    leaveOutMixedPixels (*result.view, cloud);
  addGrazingNormals (options.threads, members, cloud);
}

} // namespace pcl::cosection
