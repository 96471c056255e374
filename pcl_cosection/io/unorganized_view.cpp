// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "unorganized_view.h"

#include "../common/cell_key.h"
#include "quiet_console.h"

#include <pcl/cosection/common/parallel.h>
#include <pcl/cosection/surface/hull_constraint.h>
#include <pcl/cosection/surface/normal_orientation.h>
#include <pcl/cosection/surface/range_image.h>

// With its templates: loading libpcl_features for them costs every program a twentieth of a second.
#include <pcl/features/impl/normal_3d.hpp>
#include <pcl/features/impl/normal_3d_omp.hpp>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <unordered_map>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN ();
constexpr double max_default_slope = 1.7321; // of points before a camera whose pose was left at the default: 60 degrees
constexpr float away_cosine = -0.2f;       // of a normal that clearly points away from the viewpoint
constexpr double worth_saying = 0.02;      // share of the normals
constexpr double surely_inward = 0.3;      // outward share of a body whose normals are flipped
constexpr int least_neighbours = 8;        // for a normal; more where there are many points:
constexpr int points_per_neighbour = 40;
constexpr std::size_t dense_points = 20000;  // of one label
constexpr std::uint64_t far_away = ~std::uint64_t (0); // key of the cell of all that is far from the others
constexpr double thinning_cells = 100.0;     // along the longest side of what is denser
constexpr int neighbours_of_means = 2;       // more than of points: noise spreads over several layers of cells
constexpr std::size_t judged_points = 20000;

using Members = std::map<std::uint32_t, std::vector<std::size_t>>;

std::string
percent (double share)
{
  return std::to_string (std::lround (100.0 * share)) + " %";
}

/** \brief Some points that stand for many. */
struct Thinned
{
  std::vector<Eigen::Vector3f> points;
  std::vector<std::uint32_t> of; ///< which one stands for each point
};

/** \brief Means of points in cells, where points are so dense that the nearest ones would show noise alone; else the
 * points themselves. */
Thinned
thin (const std::vector<Eigen::Vector3f>& points)
{
  Thinned thinned;
  thinned.of.resize (points.size ());
  if (points.size () <= dense_points)
  {
    thinned.points = points;
    std::iota (thinned.of.begin (), thinned.of.end (), std::uint32_t{0});
    return thinned;
  }
  std::array<std::vector<float>, 3> some;
  for (std::size_t i = 0; i < points.size (); i += points.size () / judged_points)
    for (int axis = 0; axis < 3; ++axis)
      some[axis].push_back (points[i][axis]);
  float longest = std::numeric_limits<float>::min ();
  for (std::vector<float>& along : some)
  {
    std::sort (along.begin (), along.end ());
    longest = std::max (longest, along[along.size () * 99 / 100] - along[along.size () / 100]);
  }
  const Eigen::Vector3f origin (some[0][some[0].size () / 2], some[1][some[1].size () / 2], some[2][some[2].size () / 2]);
  std::unordered_map<std::uint64_t, std::uint32_t> cells;
  std::vector<float> counts;
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    const auto at = cellOf ((points[i] - origin).cast<double> () * thinning_cells / longest);
    const auto next = static_cast<std::uint32_t> (thinned.points.size ());
    const auto [cell, fresh] = cells.emplace (at ? keyOf (*at) : far_away, next);
    if (fresh)
    {
      thinned.points.emplace_back (Eigen::Vector3f::Zero ());
      counts.push_back (0.0f);
    }
    thinned.of[i] = cell->second;
    counts[cell->second] += 1.0f;
    thinned.points[cell->second] += (points[i] - origin - thinned.points[cell->second]) / counts[cell->second];
  }
  for (Eigen::Vector3f& point : thinned.points)
    point += origin;
  return thinned;
}

/** \brief Estimated normals of any sign. */
std::vector<Eigen::Vector3f>
estimateNormals (const PcdViewOptions& options, const std::vector<Eigen::Vector3f>& positions, int most_neighbours)
{
  std::vector<Eigen::Vector3f> result (positions.size (), Eigen::Vector3f::Constant (nan_value));
  if (positions.size () < 3)
    return result;
  auto points = pcl::make_shared<PointCloud<PointXYZ>> ();
  for (const Eigen::Vector3f& p : positions)
    points->emplace_back (p.x (), p.y (), p.z ());
  const QuietConsole quiet;
  const auto count = static_cast<int> (std::min<std::size_t> (positions.size (), std::numeric_limits<int>::max ()));
  const int wanted = std::clamp (count / points_per_neighbour, std::min (least_neighbours, most_neighbours),
                                 most_neighbours);
  NormalEstimationOMP<PointXYZ, Normal> estimation (static_cast<unsigned int> (resolveThreads (options.threads)));
  estimation.setInputCloud (points);
  estimation.setSearchMethod (pcl::make_shared<search::KdTree<PointXYZ>> ());
  estimation.setKSearch (std::min (wanted, count));
  PointCloud<Normal> normals;
  estimation.compute (normals);
  for (std::size_t k = 0; k < positions.size (); ++k)
    result[k] = normals[k].getNormalVector3fMap ();
  return result;
}

/** \brief The cloud as seen from the viewpoint, if that is where it was seen from. */
std::optional<DepthView>
viewFromViewpoint (const std::string& path, const PcdViewOptions& options, const SensorCloud& cloud,
                   LabelledView& result)
{
  if (!cloud.has_viewpoint)
  {
    const bool as_before_a_camera = std::all_of (cloud.positions.begin (), cloud.positions.end (), [] (const auto& p) {
      return !p.allFinite () || (p.z () > 0.0f && p.template head<2> ().norm () < max_default_slope * p.z ());
    });
    if (options.world_points || !as_before_a_camera)
      return std::nullopt;
  }
  std::optional<RangeImage> image = drawRangeImage (cloud.positions, Eigen::Vector3d::Zero ());
  if (image && image->hidden_share <= RangeImage::max_hidden_share)
  {
    image->view.T_world_sensor = cloud.T_world_sensor * image->view.T_world_sensor;
    return std::move (image->view);
  }
  if (cloud.has_viewpoint && cloud.positions.size () >= RangeImage::min_points)
    result.warnings.push_back (path + ": its points were not seen from its VIEWPOINT alone (" +
                               (image ? percent (image->hidden_share) + " of them are hidden from there"
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
  const Thinned thinned = thin (pick (cloud.positions, members));
  const bool dense = thinned.points.size () < members.size ();
  std::vector<Eigen::Vector3f> normals = estimateNormals (
      options, thinned.points, dense ? neighbours_of_means * options.normal_neighbours : options.normal_neighbours);
  if (!has_viewpoint)
  {
    orientConsistently (thinned.points, normals);
    double towards = 0.0;
    for (std::size_t n = 0; label == 0 && n < normals.size (); ++n)
      if (normals[n].allFinite ())
        towards += normals[n].cast<double> ().dot (middle - thinned.points[n].cast<double> ());
    if (towards < 0.0)
      for (Eigen::Vector3f& normal : normals)
        normal = -normal;
  }
  for (std::size_t k = 0; k < members.size (); ++k)
    cloud.normals[members[k]] = normals[thinned.of[k]];
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
  result.view = viewFromViewpoint (path, options, cloud, result);
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
                             "neighbours agree (better: set the VIEWPOINT, or add fields normal_x normal_y normal_z)");
}

} // namespace cosection
} // namespace pcl
