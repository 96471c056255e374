// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "unorganized_view.h"

#include "object_surroundings.h"
#include "pcl_cosection/view/normals/consistent_normals.h"
#include "pcl_cosection/view/normals/estimated_normals.h"
#include "pcl_cosection/view/outliers/mixed_pixels.h"
#include "pcl_cosection/view/outliers/points_behind_edges.h"
#include "pcl_cosection/view/outliers/scattered_points.h"
#include "sensor_view.h"

#include "pcl_cosection/view/range_image.h"
#include <pcl/cosection/surface/normals.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace pcl::cosection {
namespace {

constexpr float away_cosine = -0.2f;       // of a normal that clearly points away from the viewpoint
constexpr double least_filled = 0.01;      // share of normals with a direction, of which fields have some
constexpr double worth_saying = 0.02;      // share of the normals
constexpr double surely_inward = 0.3;      // outward share of a body whose normals are flipped
constexpr std::size_t least_points = 100;  // of an object: as many remain if some are left out, ...
constexpr double most_left_out = 0.3;      // ... which are no larger a share than this
constexpr std::size_t most_points = 20000; // of an object: of more, trails are a small share

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

/** \brief Check normals of the file against the shape, where no viewpoint gives their sign. */
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

/** \brief Take the normals of points of an object that are nowhere, behind its own edges, if enough others remain. */
void
leaveOutTrails (const PcdViewOptions& options, const DepthView& view, const std::vector<std::size_t>& indices,
                SensorCloud& cloud)
{
  std::vector<std::size_t> usable;
  for (const std::size_t i : indices)
    if (cloud.normals[i].allFinite ())
      usable.push_back (i);
  if (usable.size () <= least_points || usable.size () > most_points)
    return;
  std::vector<Eigen::Vector3f> points = pick (cloud.positions, usable);
  const Eigen::Isometry3f T_view_points = (view.T_world_sensor.inverse () * cloud.T_world_sensor).cast<float> ();
  for (Eigen::Vector3f& point : points)
    point = T_view_points * point;
  const std::vector<bool> behind = findBehindEdges (points, options.threads);
  const auto left_out = static_cast<std::size_t> (std::count (behind.begin (), behind.end (), true));
  if (usable.size () < least_points + left_out ||
      static_cast<double> (left_out) > most_left_out * static_cast<double> (usable.size ()))
    return;
  for (std::size_t k = 0; k < usable.size (); ++k)
    if (behind[k])
      cloud.normals[usable[k]].setConstant (std::numeric_limits<float>::quiet_NaN ());
}

/** \brief Estimate the normals of some of the points, of any sign. */
void
addNormals (const PcdViewOptions& options, const std::vector<std::size_t>& indices, SensorCloud& cloud)
{
  const EstimatedNormals estimated = estimateNormals (options, pick (cloud.positions, indices));
  for (std::size_t k = 0; k < indices.size (); ++k)
    cloud.normals[indices[k]] = estimated.normals[estimated.of[k]];
}

/** \brief Fields without values, all zero or not finite, count as absent. */
void
dropUnfilledNormals (SensorCloud& cloud)
{
  const auto filled = std::count_if (cloud.normals.begin (), cloud.normals.end (), [] (const Eigen::Vector3f& normal) {
    return normal.allFinite () && !normal.isZero (0.0f);
  });
  if (static_cast<double> (filled) < least_filled * static_cast<double> (cloud.normals.size ()))
    cloud.normals.clear ();
}

} // namespace

void
completeUnorganized (const std::string& path, const PcdViewOptions& options, SensorCloud& cloud, LabelledView& result)
{
  const Members members = membersOf (cloud);
  result.view = viewFromSensor (path, options, members, cloud, result);
  dropUnfilledNormals (cloud);
  const bool given = !cloud.normals.empty ();
  if (!given)
    cloud.normals.assign (cloud.positions.size (),
                          Eigen::Vector3f::Constant (std::numeric_limits<float>::quiet_NaN ()));
  if (!result.view && given)
    checkWithoutViewpoint (path, members, cloud, result);
  else if (!result.view)
  {
    addConsistentNormals (options, members, cloud);
    result.warnings.push_back (path +
                               ": where its points were seen from is not known; their normals were turned so that "
                               "neighbours agree, and hollow things " +
                               "may be filled or inside out (better: " +
                               (cloud.has_viewpoint ? "give merged views as separate INPUTs, each with its VIEWPOINT"
                                                    : "give --viewpoint, set the VIEWPOINT") +
                               ", or add fields normal_x normal_y normal_z)");
  }
  if (!result.view)
    return;

  const Surroundings objects = surroundingsOf (members, cloud);
  const BackgroundParts background = partsOfBackground (objects, members, cloud);
  if (!given)
  {
    addNormals (options, background.near, cloud);
    addNormals (options, background.far, cloud);
    for (const auto& [label, indices] : members)
      if (label != 0)
        addNormals (options, indices, cloud);
  }
  if (const double turned = turnTowardsViewpoint (given ? away_cosine : 0.0f, cloud); given && turned > worth_saying)
    result.warnings.push_back (path + ": " + percentText (turned) +
                               " of the normals point away from the VIEWPOINT; they were turned");
  for (const auto& [label, indices] : members)
    if (label != 0)
      leaveOutTrails (options, *result.view, indices, cloud);
  leaveOutMixedPixels (*result.view, cloud);
  leaveOutScattered (options, objects, background.near, cloud);
}

} // namespace pcl::cosection
