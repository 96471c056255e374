// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "sensor_view.h"

#include "pcl_cosection/common/boxes.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/io/place_text.h"
#include "pcl_cosection/view/normals/estimated_normals.h"
#include "pcl_cosection/view/scan/steady_scan.h"
#include "range_image.h"
#include "sensor_location.h"
#include "sensor_noise.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr double max_default_slope = 1.7321; // of points before a camera whose pose was left at the default: 60 degrees
// Of such a camera: several times what real ones have (a Kinect 280, a robot's 470, a RealSense 620, YCB-Video 1070).
constexpr double most_px_per_radian = 4000.0;
// A share of all points, from where the header does not say that they were seen ...
constexpr double max_hidden_from_guess = 0.02;
// ... and of those of a label (from a camera whose pose was left at the default 0 to 0.07; clouds in other frames,
// which lie before their origin by chance, 0.35 to 0.8),
constexpr double max_hidden_of_label_from_guess = 0.1;
// ... of which more may be from where it does, and of all points of a scan in steady angles.
constexpr double max_hidden_of_label = 0.5;
// RangeImage::seenThrough (). From where they were seen at most 0.04 (OSD, RealSense, YCB-Video, scanned meshes; 17
// clouds, 80 objects), from places turned about the vertical by 90 and 180 degrees 0.47 to 1: halfway.
constexpr double max_seen_through = 0.25;
// Of what is hidden if points are in the sensor's frame, if they are in the world's: 0.03 to 0.2 of 12 clouds of the
// world in cells of 3 to 10 mm.
constexpr double clearly_less = 0.5;
constexpr double same_place = 0.1;            // of the distance to the points
constexpr int lonely_neighbours = 6;          // of which the farthest ...
constexpr float lonely_factor = 2.0f;         // ... is so much farther than usual
constexpr double outermost_share = 0.02;      // of an object's points on each side, which may be wrong
constexpr float nearness = 1.0f;              // to an object, of its longest side
constexpr std::size_t most_to_judge = 500000; // points: of more, trails are no share worth mentioning

/** \brief Evidence that a sensor at some place saw the points, or did not. */
struct Sight
{
  std::optional<RangeImage> image; ///< none if they do not fit into one
  /// Share of all points; if that is too much, of the label of which most are hidden, or of the object that most is
  /// seen through.
  double hidden_share = 0.0;

  /** \param[in] most that may be hidden */
  bool isTheirs (double most = RangeImage::max_hidden_share) const { return image && hidden_share <= most; }
};

/** \brief Look at the points from \a sensor, in their frame. From below a table few of its points are hidden, but all
 * of what is on it. \param[in] all_around what spans too much for one image is looked at, too */
Sight
lookFrom (const Eigen::Vector3d& sensor, const Members& members, const SensorCloud& cloud,
          double most_of_label = max_hidden_of_label, bool all_around = false)
{
  Sight sight;
  sight.image = drawRangeImage (cloud.positions, sensor);
  if (!sight.image && all_around)
    sight.image = drawPanorama (cloud.positions, sensor);
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
    if (share > most_of_label)
      sight.hidden_share = std::max (sight.hidden_share, share);
  }
  const double through = sight.image->seenThrough (cloud.positions, cloud.labels);
  if (through > max_seen_through)
    sight.hidden_share = std::max (sight.hidden_share, through);
  return sight;
}

/** \brief Without points that are so much farther from others than is usual of their label that they may be nowhere, as
 * trails behind edges. */
SensorCloud
withoutLonely (const PcdViewOptions& options, const Members& members, const SensorCloud& cloud)
{
  SensorCloud core;
  core.labels = cloud.labels;
  core.positions.assign (cloud.positions.size (), Eigen::Vector3f::Constant (nan_value));
  for (const auto& [label, indices] : members)
  {
    const std::vector<float> reach = neighbourDistances (pick (cloud.positions, indices), lonely_neighbours,
                                                         options.threads);
    std::vector<float> sorted = reach;
    const float usual = upperMedian (sorted);
    for (std::size_t k = 0; k < indices.size (); ++k)
      if (reach[k] <= lonely_factor * usual)
        core.positions[indices[k]] = cloud.positions[indices[k]];
  }
  return core;
}

double
meanDistance (const Eigen::Vector3d& place, const SensorCloud& cloud)
{
  double mean = 0.0, count = 0.0;
  for (const Eigen::Vector3f& p : cloud.positions)
    if (p.allFinite ())
      mean += ((p.cast<double> () - place).norm () - mean) / ++count;
  return mean;
}

struct FoundSensor
{
  Eigen::Vector3d place;
  Sight sight;
};

/** \brief The one place from which all points were seen by their order; nothing if there are several, as of
 * merged views. */
std::optional<FoundSensor>
findSensor (const Members& members, const SensorCloud& cloud)
{
  std::optional<FoundSensor> found;
  for (const Eigen::Vector3d& place : locateSensor (cloud.positions)) // the likeliest first
  {
    Sight sight = lookFrom (place, members, cloud, max_hidden_of_label_from_guess);
    if (!sight.isTheirs (max_hidden_from_guess))
      continue;
    if (found && (found->place - place).norm () > same_place * meanDistance (place, cloud))
      return std::nullopt;
    if (!found)
      found = FoundSensor{place, std::move (sight)};
  }
  return found;
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

/** \brief Take what is seen for the rays of the cloud. */
void
useSight (Sight sight, const Eigen::Isometry3d& T_world_points, LabelledView& result)
{
  result.view = std::move (sight.image->view);
  result.other_views = std::move (sight.image->others);
  result.view->T_world_sensor = T_world_points * result.view->T_world_sensor;
  for (DepthView& view : result.other_views)
    view.T_world_sensor = T_world_points * view.T_world_sensor;
}

} // namespace

Members
membersOf (const SensorCloud& cloud)
{
  Members members;
  for (std::size_t i = 0; i < cloud.positions.size (); ++i)
    if (cloud.positions[i].allFinite ())
      members[cloud.labels[i]].push_back (i);
  return members;
}

void
setWorkingRange (const Members& members, SensorCloud& cloud, LabelledView& result)
{
  const bool has_objects = std::any_of (members.begin (), members.end (), [] (const auto& m) { return m.first != 0; });
  std::vector<float> distances;
  for (const auto& [label, indices] : members)
    if (label != 0 || !has_objects)
      for (const std::size_t i : indices)
        distances.push_back (cloud.positions[i].norm ());
  cloud.working_range_m = workingRange (std::move (distances));
  if (result.view)
    result.view->working_range_m = cloud.working_range_m;
  for (DepthView& view : result.other_views)
    view.working_range_m = cloud.working_range_m;
}

std::vector<Eigen::Vector3f>
pick (const std::vector<Eigen::Vector3f>& all, const std::vector<std::size_t>& indices)
{
  std::vector<Eigen::Vector3f> picked (indices.size ());
  std::transform (indices.begin (), indices.end (), picked.begin (), [&] (std::size_t i) { return all[i]; });
  return picked;
}

Surroundings
surroundingsOf (const Members& members, const SensorCloud& cloud)
{
  Surroundings boxes;
  for (const auto& [label, indices] : members)
    if (label != 0)
    {
      const Eigen::AlignedBox3f box = trimmedBox<float> (indices, outermost_share,
                                                         [&] (std::size_t i) { return cloud.positions[i]; });
      const Eigen::Vector3f reach = Eigen::Vector3f::Constant (nearness * box.sizes ().maxCoeff ());
      boxes[label] = Eigen::AlignedBox3f (box.min () - reach, box.max () + reach);
    }
  return boxes;
}

BackgroundParts
partsOfBackground (const Surroundings& objects, const Members& members, const SensorCloud& cloud)
{
  BackgroundParts parts;
  if (const auto background = members.find (0); background != members.end ())
    for (const std::size_t i : background->second)
    {
      const bool near = std::any_of (objects.begin (), objects.end (),
                                     [&] (const auto& object) { return object.second.contains (cloud.positions[i]); });
      (near ? parts.near : parts.far).push_back (i);
    }
  return parts;
}

std::string
percentText (double share)
{
  return std::to_string (std::lround (100.0 * share)) + " %";
}

bool
lookAround (const Members& members, const SensorCloud& cloud, LabelledView& result)
{
  const std::optional<ScanSteps> steps = stepsOfScan (cloud);
  if (!steps)
    return false;
  // The steady steps are the evidence. Ground seen nearly level has many depths in a pixel, which look hidden.
  Sight sight = lookFrom (Eigen::Vector3d::Zero (), members, cloud, max_hidden_of_label, true);
  if (!sight.isTheirs (max_hidden_of_label))
    return false;
  std::vector<DepthView> images = imagesOfScan (cloud, *steps);
  if (images.empty ())
    return false;
  sight.image->view = std::move (images.front ());
  sight.image->others.assign (std::make_move_iterator (images.begin () + 1), std::make_move_iterator (images.end ()));
  useSight (std::move (sight), cloud.T_world_sensor, result);
  return true;
}

void
viewFromSensor (const std::string& path, const PcdViewOptions& options, const Members& members, SensorCloud& cloud,
                LabelledView& result)
{
  const bool header_tells = cloud.has_viewpoint || (!cloud.in_world && asBeforeACamera (cloud));
  const double most_of_label = cloud.has_viewpoint ? max_hidden_of_label : max_hidden_of_label_from_guess;
  const auto saw = [&] (const Sight& from_origin) {
    return from_origin.isTheirs () && (cloud.has_viewpoint || from_origin.image->view.camera.fx <= most_px_per_radian);
  };
  Sight sight;
  if (header_tells)
  {
    sight = lookFrom (Eigen::Vector3d::Zero (), members, cloud, most_of_label, options.viewpoint.has_value ());
    if (saw (sight))
      return useSight (std::move (sight), cloud.T_world_sensor, result);
    if (cloud.positions.size () <= most_to_judge)
      if (Sight of_core = lookFrom (Eigen::Vector3d::Zero (), members, withoutLonely (options, members, cloud),
                                    most_of_label);
          saw (of_core))
        return useSight (std::move (of_core), cloud.T_world_sensor, result);
  }
  if (cloud.has_viewpoint && !cloud.in_world && options.axes == SensorAxes::Optical)
    if (Sight other = lookFrom (cloud.T_world_sensor.translation (), members, cloud);
        other.isTheirs () && (!sight.image || other.hidden_share < clearly_less * sight.hidden_share))
    {
      result.warnings.push_back (
          path + ": its points were seen from its VIEWPOINT if they are in the world frame, and not if they are in the "
                 "sensor's: taken as with --world-points");
      moveToSensor (Eigen::Isometry3d::Identity (), cloud.T_world_sensor, cloud);
      return useSight (std::move (other), Eigen::Isometry3d::Identity (), result);
    }
  if (auto found = findSensor (members, cloud))
  {
    const Eigen::Isometry3d T_world_points = cloud.T_world_sensor;
    moveToSensor (T_world_points, Eigen::Isometry3d (Eigen::Translation3d (found->place)), cloud);
    result.warnings.push_back (path + ": the order of its points tells that they were seen from " +
                               placeText (cloud.origin + cloud.T_world_sensor.translation ()) +
                               ", which is used instead of " + sourceOfViewpoint (options));
    return useSight (std::move (found->sight), T_world_points, result);
  }
  if (cloud.has_viewpoint && cloud.positions.size () >= RangeImage::min_points)
    result.warnings.push_back (path + ": its points were not seen from " + sourceOfViewpoint (options) + " alone (" +
                               (sight.image ? percentText (sight.hidden_share) +
                                                  " of them, or of one object, are hidden or seen through from there"
                                            : std::string ("they span more than 120 degrees; give --viewpoint if so")) +
                               "): no free space is taken from it" +
                               (cloud.in_world ? "" : "; if they are in the world frame, give --world-points"));
}

} // namespace pcl::cosection
