// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "unorganized_view.h"

#include "estimated_normals.h"
#include "place_text.h"

#include <pcl/cosection/surface/hull_constraint.h>
#include <pcl/cosection/surface/normal_orientation.h>
#include <pcl/cosection/surface/range_image.h>
#include <pcl/cosection/surface/sensor_location.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN ();
constexpr double max_default_slope = 1.7321; // of points before a camera whose pose was left at the default: 60 degrees
constexpr double max_hidden_of_label = 0.5; // points, from where they were seen
constexpr float away_cosine = -0.2f;       // of a normal that clearly points away from the viewpoint
constexpr double worth_saying = 0.02;      // share of the normals
constexpr double surely_inward = 0.3;      // outward share of a body whose normals are flipped

using Members = std::map<std::uint32_t, std::vector<std::size_t>>;

std::string
percent (double share)
{
  return std::to_string (std::lround (100.0 * share)) + " %";
}

/** \brief What tells that a sensor at some place saw the points, or did not. */
struct Sight
{
  std::optional<RangeImage> image; ///< none if they do not fit into one
  double hidden_share = 0.0;       ///< of all points, or of the label of which most are hidden if that is too much

  bool
  isTheirs () const
  {
    return image && hidden_share <= RangeImage::max_hidden_share;
  }
};

/** \brief Look at the points from \a sensor, in their frame. From below a table few of its points are hidden, but all of what is on it. */
Sight
lookFrom (const Eigen::Vector3d& sensor, const Members& members, const SensorCloud& cloud)
{
  Sight sight;
  sight.image = drawRangeImage (cloud.positions, sensor);
  if (!sight.image)
    return sight;
  sight.hidden_share = sight.image->hidden_share;
  for (const auto& [label, indices] : members)
  {
    if (indices.size () < RangeImage::min_points)
      continue;
    const auto hidden = std::count_if (indices.begin (), indices.end (),
                                       [&] (std::size_t i) { return sight.image->hides (cloud.positions[i]); });
    const double share = static_cast<double> (hidden) / static_cast<double> (indices.size ());
    if (share > max_hidden_of_label)
      sight.hidden_share = std::max (sight.hidden_share, share);
  }
  return sight;
}

/** \brief Whether the points lie as in the frame of a camera, whose pose then is the default one. */
bool
asBeforeACamera (const SensorCloud& cloud)
{
  return std::all_of (cloud.positions.begin (), cloud.positions.end (), [] (const Eigen::Vector3f& p) {
    return !p.allFinite () || (p.z () > 0.0f && p.head<2> ().norm () < max_default_slope * p.z ());
  });
}

/** \brief Take points to a sensor that was found in their frame. */
void
moveToSensor (const Eigen::Isometry3d& T_world_points, const Eigen::Isometry3d& T_points_sensor, SensorCloud& cloud)
{
  const Eigen::Isometry3f T_sensor_points = T_points_sensor.inverse ().cast<float> ();
  for (Eigen::Vector3f& position : cloud.positions)
    position = T_sensor_points * position;
  for (Eigen::Vector3f& normal : cloud.normals)
    normal = T_sensor_points.linear () * normal;
  cloud.T_world_sensor = T_world_points * T_points_sensor;
}

/** \brief The cloud as seen from where it was seen from, if that can be told; else why not. Points of another frame than the sensor's are taken to it. */
std::optional<DepthView>
viewFromSensor (const std::string& path, const PcdViewOptions& options, const Members& members, SensorCloud& cloud,
                LabelledView& result)
{
  const auto viewOf = [&] (Sight& sight, const Eigen::Isometry3d& T_world_points) {
    sight.image->view.T_world_sensor = T_world_points * sight.image->view.T_world_sensor;
    return std::move (sight.image->view);
  };
  const bool header_tells = cloud.has_viewpoint || (!options.world_points && asBeforeACamera (cloud));
  Sight sight;
  if (header_tells)
    if (sight = lookFrom (Eigen::Vector3d::Zero (), members, cloud); sight.isTheirs ())
      return viewOf (sight, cloud.T_world_sensor);
  if (cloud.has_viewpoint && !options.world_points && !options.viewpoint)
    if (Sight other = lookFrom (cloud.T_world_sensor.translation (), members, cloud); other.isTheirs ())
    {
      result.warnings.push_back (path + ": its points were seen from its VIEWPOINT if they are in the world frame, and not if they are in the "
                                        "sensor's: taken as with --world-points");
      moveToSensor (Eigen::Isometry3d::Identity (), cloud.T_world_sensor, cloud);
      return viewOf (other, Eigen::Isometry3d::Identity ());
    }
  std::optional<Eigen::Vector3d> found;
  Sight best;
  for (const Eigen::Vector3d& sensor : locateSensor (cloud.positions))
    if (Sight other = lookFrom (sensor, members, cloud); other.isTheirs () && !(found && best.hidden_share <= other.hidden_share))
    {
      found = sensor;
      best = std::move (other);
    }
  if (found)
  {
    const Eigen::Isometry3d T_world_points = cloud.T_world_sensor;
    moveToSensor (T_world_points, Eigen::Isometry3d (Eigen::Translation3d (*found)), cloud);
    result.warnings.push_back (path + ": the order of its points tells that they were seen from " + placeText (cloud.T_world_sensor.translation ()) +
                               ", which is used instead of the VIEWPOINT");
    return viewOf (best, T_world_points);
  }
  if (cloud.has_viewpoint && cloud.positions.size () >= RangeImage::min_points)
    result.warnings.push_back (path + ": its points were not seen from its VIEWPOINT alone (" +
                               (sight.image ? percent (sight.hidden_share) + " of them are hidden from there"
                                            : std::string ("they span more than 120 degrees")) +
                               "): no free space is taken from it");
  return std::nullopt;
}

std::vector<Eigen::Vector3f>
pick (const std::vector<Eigen::Vector3f>& all, const std::vector<std::size_t>& members)
{
  std::vector<Eigen::Vector3f> picked;
  picked.reserve (members.size ());
  for (const std::size_t i : members)
    picked.push_back (all[i]);
  return picked;
}

/** \brief Middle of all points that belong to objects. */
Eigen::Vector3d
middleOfObjects (const Members& members, const SensorCloud& cloud)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
  std::size_t count = 0;
  for (const auto& [label, indices] : members)
    for (const std::size_t i : indices)
      if (label != 0)
      {
        sum += cloud.positions[i].cast<double> ();
        ++count;
      }
  return sum / static_cast<double> (std::max<std::size_t> (1, count));
}

/** \brief Estimate the normals of one label. Without a viewpoint they are turned consistently: those of bodies outward,
 * those of the background to the side of \a middle. */
void
addNormals (const PcdViewOptions& options, std::uint32_t label, const std::vector<std::size_t>& members,
            bool has_viewpoint, const Eigen::Vector3d& middle, SensorCloud& cloud)
{
  EstimatedNormals estimated = estimateNormals (options, pick (cloud.positions, members));
  if (!has_viewpoint)
  {
    orientConsistently (estimated.points, estimated.normals);
    double towards = 0.0;
    for (std::size_t n = 0; label == 0 && n < estimated.normals.size (); ++n)
      if (estimated.normals[n].allFinite ())
        towards += estimated.normals[n].cast<double> ().dot (middle - estimated.points[n].cast<double> ());
    if (towards < 0.0)
      for (Eigen::Vector3f& normal : estimated.normals)
        normal = -normal;
  }
  for (std::size_t k = 0; k < members.size (); ++k)
    cloud.normals[members[k]] = estimated.normals[estimated.of[k]];
}

/** \brief Take the normals of points of the background at depth edges, so that they are left out: between something and what is behind it a sensor
 * measures what is nowhere, and walls of such points would stand between things. Those of objects are too few to do without. */
void
leaveOutFlyingPixels (const DepthView& view, SensorCloud& cloud)
{
  const FreeSpaceView seen (view);
  const Eigen::Isometry3d T_view_points = view.T_world_sensor.inverse () * cloud.T_world_sensor;
  for (std::size_t i = 0; i < cloud.positions.size (); ++i)
  {
    if (cloud.labels[i] != 0 || !cloud.positions[i].allFinite ())
      continue;
    const Eigen::Vector2d pixel = view.camera.project (T_view_points * cloud.positions[i].cast<double> ());
    const Eigen::Vector2i at = (pixel.array () + 0.5).floor ().cast<int> ();
    if (at.x () >= 0 && at.x () < view.camera.width && at.y () >= 0 && at.y () < view.camera.height && seen.atEdge (at.x (), at.y ()))
      cloud.normals[i].setConstant (nan_value);
  }
}

/** \brief Turn normals that clearly point away from the viewpoint, which is the origin. \return their share */
double
turnTowardsViewpoint (float away, SensorCloud& cloud)
{
  std::size_t turned = 0;
  std::size_t all = 0;
  std::size_t opposed = 0;
  for (std::size_t i = 0; i < cloud.positions.size (); ++i)
    if (cloud.positions[i].allFinite () && cloud.normals[i].allFinite ())
    {
      ++all;
      opposed += cloud.positions[i].dot (cloud.normals[i]) > 0.0f;
    }
  if (2 * opposed > all) // all are flipped, also those at grazing angles
  {
    for (Eigen::Vector3f& normal : cloud.normals)
      normal = -normal;
    return static_cast<double> (opposed) / static_cast<double> (all);
  }
  for (std::size_t i = 0; i < cloud.positions.size (); ++i)
  {
    Eigen::Vector3f& normal = cloud.normals[i];
    if (!cloud.positions[i].allFinite () || !normal.allFinite ())
      continue;
    if (-cloud.positions[i].normalized ().dot (normal) >= away * normal.norm ())
      continue;
    normal = -normal;
    ++turned;
  }
  return all == 0 ? 0.0 : static_cast<double> (turned) / static_cast<double> (all);
}

/** \brief Check normals of the file against the shape, where no viewpoint tells their sign. */
void
checkWithoutViewpoint (const std::string& path, const Members& members, SensorCloud& cloud, LabelledView& result)
{
  for (const auto& [label, indices] : members)
  {
    if (label == 0 || indices.size () < RangeImage::min_points)
      continue;
    const double outward = outwardShare (pick (cloud.positions, indices), pick (cloud.normals, indices));
    if (outward >= surely_inward)
      continue;
    for (const std::size_t i : indices)
      cloud.normals[i] = -cloud.normals[i];
    result.warnings.push_back (path + ": the normals " +
                               (result.has_labels ? "of label " + std::to_string (label) + " " : std::string ()) +
                               "point inward; they were turned");
  }
}

} // namespace

void
completeUnorganized (const std::string& path, const PcdViewOptions& options, SensorCloud& cloud, LabelledView& result)
{
  Members members;
  for (std::size_t i = 0; i < cloud.positions.size (); ++i)
    if (cloud.positions[i].allFinite ())
      members[cloud.labels[i]].push_back (i);
  result.view = viewFromSensor (path, options, members, cloud, result);
  if (!cloud.normals.empty ())
  {
    if (!result.view)
      checkWithoutViewpoint (path, members, cloud, result);
    else if (const double turned = turnTowardsViewpoint (away_cosine, cloud); turned > worth_saying)
      result.warnings.push_back (path + ": " + percent (turned) +
                                 " of the normals point away from the VIEWPOINT; they were turned");
    return;
  }
  cloud.normals.assign (cloud.positions.size (), Eigen::Vector3f::Constant (nan_value));
  const Eigen::Vector3d middle = middleOfObjects (members, cloud);
  for (const auto& [label, indices] : members)
    addNormals (options, label, indices, result.view.has_value (), middle, cloud);
  if (result.view)
  {
    turnTowardsViewpoint (0.0f, cloud);
    leaveOutFlyingPixels (*result.view, cloud);
    return;
  }
  result.warnings.push_back (path + ": where its points were seen from is not known; their normals were turned so that " +
                             "neighbours agree (better: give --viewpoint, set the VIEWPOINT, or add fields normal_x normal_y normal_z)");
}

} // namespace cosection
} // namespace pcl
