// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/io/pcd_view.h>

#include "given_ground.h"
#include "pcl_cosection/common/quantile.h"
#include "sensor_view.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <sstream>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr std::size_t most_objects = 10000;   // of one view, of ...
constexpr std::size_t points_of_object = 100; // ... so many points each
constexpr double farthest_viewpoint = 1e15;   // metres; as of the header
constexpr float absurdly_far = 1e9f;          // metres, along an axis: single precision has steps of 64 m there
constexpr double most_absurd = 0.25;        // share of the points; with their bytes in the other order, 0.45 are so far
constexpr double millimetre_extent = 100.0; // metres; a scene this large is probably not in metres, ...
constexpr double millimetre_object = 20.0;  // ... but if its objects are smaller, a lidar sees it

/** \brief Refuse labels that hardly number objects, before hours are spent on them. \throws DegenerateInput */
void
checkLabels (const std::string& path, const SensorCloud& cloud)
{
  std::map<std::uint32_t, std::size_t> counts;
  for (const std::uint32_t label : cloud.labels)
    ++counts[label];
  const auto large = static_cast<std::size_t> (std::count_if (
      counts.begin (), counts.end (), [] (const auto& label) { return label.second >= points_of_object; }));
  if (large > most_objects)
    throw DegenerateInput (path + ": has " + std::to_string (large) + " labels of " +
                           std::to_string (points_of_object) + " points or more, at most " +
                           std::to_string (most_objects) + " are possible: do they number objects? " +
                           "(else split the cloud)");
}

/** \brief Sort the points by label, in the world frame. */
void
collectObjects (const SensorCloud& cloud, LabelledView& result)
{
  const Eigen::Isometry3d& T = cloud.T_world_sensor;
  std::map<std::uint32_t, std::size_t> readings;
  for (std::size_t i = 0; i < cloud.positions.size (); ++i)
    if (cloud.positions[i].allFinite ())
      ++readings[cloud.labels[i]];
  for (const auto& [label, count] : readings)
    result.objects[label].points.reserve (count);
  for (std::size_t i = 0; i < cloud.positions.size (); ++i)
  {
    if (!cloud.positions[i].allFinite ())
      continue;
    LabelledView::Points& object = result.objects[cloud.labels[i]];
    ++object.readings;
    const Eigen::Vector3d normal = cloud.normals[i].cast<double> ();
    const double length = normal.norm ();
    if (!(length > 1e-3) || !std::isfinite (length)) // no normal; infinite where points are absurdly far apart
      continue;
    OrientedPoint point;
    point.position = (T * cloud.positions[i].cast<double> ()).cast<float> ();
    point.normal = (T.linear () * (normal / length)).cast<float> ();
    if (result.has_colour)
      point.colour = cloud.colours[i];
    if (result.has_intensity)
      point.intensity = cloud.intensities[i];
    object.points.push_back (point);
  }
}

/** \brief How many points are absurdly far from the middle of all, and how many there are. */
std::pair<std::size_t, std::size_t>
countAbsurd (const SensorCloud& cloud)
{
  std::vector<Eigen::Vector3f> points;
  std::copy_if (cloud.positions.begin (), cloud.positions.end (), std::back_inserter (points),
                [] (const Eigen::Vector3f& p) { return p.allFinite (); });
  Eigen::Vector3f middle;
  for (int axis = 0; axis < 3; ++axis)
  {
    std::vector<float> along (points.size ());
    std::transform (points.begin (), points.end (), along.begin (), [axis] (const auto& p) { return p[axis]; });
    middle[axis] = upperMedian (along);
  }
  const auto absurd = std::count_if (points.begin (), points.end (), [&middle] (const Eigen::Vector3f& p) {
    return (p - middle).cwiseAbs ().maxCoeff () > absurdly_far;
  });
  return {static_cast<std::size_t> (absurd), points.size ()};
}

void
checkExtent (const std::string& path, const PcdViewOptions& options, const SensorCloud& cloud, LabelledView& result)
{
  Eigen::AlignedBox3f box;
  std::map<std::uint32_t, Eigen::AlignedBox3f> objects;
  for (std::size_t i = 0; i < cloud.positions.size (); ++i)
    if (const Eigen::Vector3f& p = cloud.positions[i]; p.allFinite ())
    {
      box.extend (p);
      if (cloud.labels[i] != 0)
        objects[cloud.labels[i]].extend (p);
    }
  if (box.isEmpty ())
    throw DegenerateInput (path + ": none of its " + std::to_string (cloud.positions.size ()) + " points is finite" +
                           (cloud.has_labels ? " and has a label that counts" : ""));
  const float extent = box.sizes ().maxCoeff ();
  if (extent > absurdly_far)
    if (const auto [absurd, all] = countAbsurd (cloud);
        static_cast<double> (absurd) > most_absurd * static_cast<double> (all))
      throw DegenerateInput (path + ": " + std::to_string (absurd) + " of its " + std::to_string (all) +
                             " points are over 1e9 m from the middle of all: it is damaged, has the sky of a rendering "
                             "(NaN is no reading), or is of a big-endian machine (binary PCD files are little-endian)");
  const bool has_large = objects.empty () || std::any_of (objects.begin (), objects.end (), [] (const auto& object) {
                           return object.second.sizes ().maxCoeff () > millimetre_object;
                         });
  if (extent > millimetre_extent && has_large)
  {
    std::ostringstream text;
    text.precision (3);
    text << path << ": extends over " << extent << " m";
    if (options.scale == 1.0)
      text << "; if its unit is the millimetre, give --scale 0.001";
    else
      text << " with --scale " << options.scale;
    result.warnings.push_back (text.str ());
  }
}

/** \brief Give points that were read their rays and normals, and sort them by label. */
LabelledView
toView (const std::string& path, const PcdViewOptions& options, SensorCloud cloud)
{
  LabelledView result;
  result.warnings = cloud.warnings;
  checkLabels (path, cloud);
  checkExtent (path, options, cloud, result);
  result.origin = cloud.origin;
  result.organized = cloud.height > 1;
  result.has_labels = cloud.has_labels;
  result.has_colour = !cloud.colours.empty ();
  result.has_intensity = !cloud.intensities.empty ();
  if (cloud.ignored > 0)
    result.warnings.push_back (path + ": " + std::to_string (cloud.ignored) + " points of a negative label, or of " +
                               (options.ignored_labels.empty () ? "65535" : "one that is ignored") + ", are ignored");
  labelGround (options, cloud);
  if (cloud.height > 1)
    completeOrganized (path, options, cloud, result);
  else
    completeUnorganized (path, options, cloud, result);
  if (result.view)
    result.view->name = path;
  for (DepthView& view : result.other_views)
    view.name = path;
  collectObjects (cloud, result);
  return (result);
}

} // namespace

void
PcdViewOptions::validate () const
{
  if (!(std::isfinite (scale) && scale > 0.0))
    throw InvalidArgument ("scale must be positive and finite");
  if (viewpoint && !std::all_of (viewpoint->begin (), viewpoint->end (),
                                 [] (double x) { return std::abs (x) <= farthest_viewpoint; }))
    throw InvalidArgument ("viewpoint must be at most 1e15 m away along each axis");
  if (normal_neighbours < 3 || normal_neighbours > 1000)
    throw InvalidArgument ("normal_neighbours must be between 3 and 1000");
  if (origin && !std::all_of (origin->begin (), origin->end (), [] (double x) { return std::isfinite (x); }))
    throw InvalidArgument ("origin must be finite");
  for (const auto& [a, b, c, d] : planes)
    if (!std::isfinite (a + b + c + d) || (a == 0.0 && b == 0.0 && c == 0.0))
      throw InvalidArgument ("a plane must be finite, with a normal that is not zero");
  if (intrinsics)
    PinholeCamera{1, 1, (*intrinsics)[0], (*intrinsics)[1], (*intrinsics)[2], (*intrinsics)[3]}.validate ();
}

LabelledView
readPcdView (const std::string& path, const PcdViewOptions& options)
{
  options.validate ();
  return (toView (path, options, readSensorCloud (path, options)));
}

LabelledView
toLabelledView (const PCLPointCloud2& cloud, const Eigen::Isometry3d& T_world_sensor, const PcdViewOptions& options,
                const std::string& name)
{
  options.validate ();
  const CloudHeader header = describeCloud (name, cloud, T_world_sensor);
  checkMemory (name, header, options.max_memory_bytes);
  return (toView (name, options, toSensorCloud (name, header, cloud, options)));
}

} // namespace pcl::cosection
