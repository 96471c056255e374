// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "merged_views.h"

#include "pcl_cosection/io/place_text.h"
#include "pcl_cosection/view/sensor_location.h"
#include "pcl_cosection/view/sensor_view.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

namespace pcl::cosection {
namespace {

constexpr double same_place = 0.1; // of the distance to the points

/** \brief The points from \a begin to \a end, in the frame of the sensor at the place that their order tells; nothing
 * if it tells none. */
std::optional<SensorCloud>
partOf (const SensorCloud& cloud, std::size_t begin, std::size_t end)
{
  SensorCloud part;
  const auto copy = [begin, end] (const auto& from, auto& to) {
    if (!from.empty ())
      to.assign (from.begin () + static_cast<std::ptrdiff_t> (begin),
                 from.begin () + static_cast<std::ptrdiff_t> (end));
  };
  copy (cloud.positions, part.positions);
  copy (cloud.normals, part.normals);
  copy (cloud.labels, part.labels);
  part.width = static_cast<int> (end - begin);
  part.height = 1;
  part.origin = cloud.origin;
  part.has_labels = cloud.has_labels;
  const std::vector<Eigen::Vector3d> places = locateSensor (part.positions);
  if (places.empty ())
    return std::nullopt;
  part.T_world_sensor = cloud.T_world_sensor * Eigen::Translation3d (places.front ());
  for (Eigen::Vector3f& position : part.positions)
    position -= places.front ().cast<float> ();
  part.has_viewpoint = part.in_world = true;
  return part;
}

/** \brief Put the points of a part, which were taken to their sensor, back. */
void
putBack (const SensorCloud& part, std::size_t begin, SensorCloud& cloud)
{
  const Eigen::Isometry3f T = (cloud.T_world_sensor.inverse () * part.T_world_sensor).cast<float> ();
  for (std::size_t i = 0; i < part.positions.size (); ++i)
  {
    cloud.positions[begin + i] = T * part.positions[i];
    cloud.normals[begin + i] = T.linear () * part.normals[i];
    cloud.labels[begin + i] = part.labels[i];
  }
}

/** \brief Whether one of the views was seen from the VIEWPOINT of the header if that is in the frame of the points: the
 * header of the first one was kept, though all points are in the world frame. */
bool
areInWorld (const SensorCloud& cloud, const std::vector<DepthView>& views)
{
  if (!cloud.has_viewpoint || cloud.in_world)
    return false;
  const Eigen::Isometry3d T_points_world = cloud.T_world_sensor.inverse ();
  return std::any_of (views.begin (), views.end (), [&] (const DepthView& view) {
    const Eigen::Vector3d place = T_points_world * view.T_world_sensor.translation ();
    return (place - cloud.T_world_sensor.translation ()).norm () < same_place * view.working_range_m;
  });
}

} // namespace

bool
completeMerged (const std::string& path, const PcdViewOptions& options, SensorCloud& cloud, LabelledView& result)
{
  std::vector<std::size_t> bounds = beginningsOfViews (cloud.positions);
  if (bounds.empty ())
    return false;
  bounds.push_back (cloud.positions.size ());
  SensorCloud whole = cloud;
  whole.normals.assign (cloud.positions.size (), Eigen::Vector3f::Constant (nan_value));
  std::vector<DepthView> views;
  for (std::size_t v = 0; v + 1 < bounds.size (); ++v)
  {
    std::optional<SensorCloud> part = partOf (cloud, bounds[v], bounds[v + 1]);
    if (!part)
      return false;
    LabelledView of_part;
    of_part.has_labels = result.has_labels;
    completeUnorganized (path, options, *part, of_part);
    if (!of_part.view)
      return false;
    putBack (*part, bounds[v], whole);
    views.push_back (std::move (*of_part.view));
    std::move (of_part.other_views.begin (), of_part.other_views.end (), std::back_inserter (views));
  }
  if (areInWorld (cloud, views))
  {
    const Eigen::Isometry3d T_points_world = cloud.T_world_sensor.inverse ();
    for (DepthView& view : views)
      view.T_world_sensor = T_points_world * view.T_world_sensor;
    whole.T_world_sensor.setIdentity ();
  }
  std::string places;
  for (const DepthView& view : views)
    places += (places.empty () ? "" : "; ") + placeText (cloud.origin + view.T_world_sensor.translation ());
  result.warnings.push_back (path + ": the order of its points tells that it holds " + std::to_string (views.size ()) +
                             " views, which were seen from " + places + ": each is used");
  cloud = std::move (whole);
  result.view = std::move (views.front ());
  result.other_views.assign (std::make_move_iterator (views.begin () + 1), std::make_move_iterator (views.end ()));
  return true;
}

} // namespace pcl::cosection
