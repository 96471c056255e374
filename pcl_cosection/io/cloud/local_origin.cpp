// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "local_origin.h"

#include "pcl_cosection/common/boxes.h"
#include "pcl_cosection/common/round_origin.h"
#include "pcl_cosection/io/place_text.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <vector>

namespace pcl::cosection {
namespace {

// Shares of the distance between neighbouring points, to which floats may round coordinates ...
constexpr double most_rounding = 0.5;       // ... of points that have a shape,
constexpr double worth_saying = 1.0 / 16.0; // ... of points without a loss.
constexpr double outlier_share = 0.02;      // of the points, on each side
constexpr std::size_t judged_points = 20000;
constexpr double farthest = 1e16; // metres: squares of more are no floats
constexpr std::size_t least_points = 3;

/** \brief Where the points of a file are, without outliers, after the scale. */
struct Extent
{
  Eigen::Vector3d centre;
  double longest = 0.0;
  double spacing = 0.0; ///< of points on a surface
};

/** \brief Nothing if there are too few points, or all at one place. */
std::optional<Extent>
extentOf (const std::array<CloudColumn, 3>& columns, std::size_t points, double scale)
{
  std::vector<Eigen::Vector3d> places;
  for (std::size_t i = 0, step = std::max<std::size_t> (1, points / judged_points); i < points; i += step)
  {
    const Eigen::Vector3d p = scale *
                              Eigen::Vector3d (columns[0].number (i), columns[1].number (i), columns[2].number (i));
    if (std::isfinite (p.squaredNorm ()) && !p.isZero (0.0))
      places.push_back (p);
  }
  const std::size_t count = places.size ();
  if (count < least_points)
    return std::nullopt;
  const Eigen::AlignedBox3d box = trimmedBox<double> (places, outlier_share,
                                                      [] (const Eigen::Vector3d& p) { return p; });
  Extent extent;
  extent.centre = 0.5 * box.min () + 0.5 * box.max ();
  extent.longest = box.sizes ().maxCoeff ();
  const double all = static_cast<double> (count) * std::max (1.0, static_cast<double> (points) / judged_points);
  extent.spacing = extent.longest / std::sqrt (all);
  if (!(extent.spacing > 0.0))
    return std::nullopt;
  return extent;
}

std::string
lengthText (double length)
{
  std::ostringstream text;
  text.precision (3);
  text << length;
  return text.str ();
}

/** \brief Refuse, or warn of, coordinates that the file has rounded. */
void
checkRounding (const std::string& path, const std::array<const CloudField*, 3>& fields, double scale,
               const Extent& extent, SensorCloud& cloud)
{
  if (std::none_of (fields.begin (), fields.end (),
                    [] (const CloudField* f) { return f->type == 'F' && f->size == 4; }))
    return;
  const double rounding = roundingAt (extent.centre);
  const double share = rounding / extent.spacing;
  if (share <= worth_saying)
    return;
  const std::string reason = path + ": its coordinates, about " + placeText (extent.centre / scale) +
                             ", are rounded to " + lengthText (rounding / scale) +
                             " by single precision; write x, y and z as doubles (PCD: SIZE 8), or take an offset off "
                             "them";
  if (share > most_rounding)
    throw IoError (reason);
  cloud.warnings.push_back (reason);
}

} // namespace

Eigen::Affine3d
takeToLocalOrigin (const std::string& path, const std::array<const CloudField*, 3>& fields,
                   const std::array<CloudColumn, 3>& columns, const PcdViewOptions& options, SensorCloud& cloud)
{
  if (options.origin)
    cloud.origin = Eigen::Map<const Eigen::Vector3d> (options.origin->data ());
  Eigen::Isometry3d T_sensor_points = cloud.in_world ? cloud.T_world_sensor.inverse ()
                                                     : cloud.T_points_sensor.inverse ();
  const std::size_t points = static_cast<std::size_t> (cloud.width) * static_cast<std::size_t> (cloud.height);
  if (const auto extent = extentOf (columns, points, options.scale))
  {
    checkRounding (path, fields, options.scale, *extent, cloud);
    const auto isFar = [&] (const Eigen::Vector3d& place, double share) {
      return roundingAt (place) > share * extent->spacing;
    };
    if (isFar (T_sensor_points * extent->centre, worth_saying) && cloud.has_viewpoint && !cloud.in_world)
    {
      T_sensor_points = cloud.T_world_sensor.inverse ();
      cloud.in_world = true;
      cloud.warnings.push_back (path + ": its points are " + lengthText (extent->centre.norm ()) +
                                " m from the sensor if they are in its frame: taken as with --world-points");
    }
    if (const Eigen::Vector3d centre = T_sensor_points * extent->centre; isFar (centre, worth_saying))
    {
      if (cloud.has_viewpoint)
        cloud.warnings.push_back (path + ": its points are " + lengthText (centre.norm ()) +
                                  " m from where the sensor is said to have stood, which is not used");
      const Eigen::Translation3d there (roundOrigin (centre, extent->longest));
      T_sensor_points = there.inverse () * T_sensor_points;
      cloud.T_world_sensor = cloud.T_world_sensor * there;
      cloud.has_viewpoint = false;
      cloud.in_world = true; // at any rate not before the sensor
    }
    const Eigen::Vector3d centre = cloud.T_world_sensor * (T_sensor_points * extent->centre);
    if (!options.origin && needsLocalOrigin (centre, extent->longest, extent->spacing))
    {
      cloud.origin = roundOrigin (centre, extent->longest);
      cloud.warnings.push_back (path + ": its coordinates are far from their origin; they are taken relative to " +
                                placeText (cloud.origin));
    }
    else if (options.origin && isFar (centre - cloud.origin, worth_saying))
      cloud.warnings.push_back (path + ": is " + lengthText ((centre - cloud.origin).norm ()) +
                                " m from the first view; its coordinates are rounded");
  }
  cloud.T_world_sensor = Eigen::Translation3d (-cloud.origin) * cloud.T_world_sensor;
  if (!(cloud.T_world_sensor.translation ().norm () < farthest))
    throw IoError (path + ": its coordinates are up to " + lengthText (cloud.T_world_sensor.translation ().norm ()) +
                   " m from the origin, which is too far");
  return Eigen::Affine3d (T_sensor_points) * Eigen::Scaling (options.scale);
}

} // namespace pcl::cosection
