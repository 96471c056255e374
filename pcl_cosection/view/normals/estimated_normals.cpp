// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "estimated_normals.h"

#include "pcl_cosection/common/lattice_cells.h"
#include "pcl_cosection/io/quiet_console.h"

#include "pcl_cosection/common/parallel.h"

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
#include <tuple>
#include <unordered_map>

namespace pcl::cosection {
namespace {

constexpr int least_neighbours = 8; // for a normal; more where there are many points:
constexpr int points_per_neighbour = 40;
constexpr std::size_t dense_points = 20000;
constexpr std::uint64_t far_away = ~std::uint64_t (0); // key of the cell of all that is far from the others
constexpr double thinning_cells = 100.0;               // along the longest side of what is denser
constexpr int neighbours_of_means = 2; // more than of points: noise spreads over several layers of cells
constexpr std::size_t judged_points = 20000;

/** \brief Points that stand for others. */
struct ThinnedPoints
{
  std::vector<Eigen::Vector3f> points;
  std::vector<std::uint32_t> of; ///< which one stands for each of the points that were given
};

/** \brief Means of points in cells, where points are so dense that the nearest ones would show noise alone; else the
 * points themselves. */
ThinnedPoints
thin (const std::vector<Eigen::Vector3f>& points)
{
  ThinnedPoints thinned;
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
  const Eigen::Vector3f origin (some[0][some[0].size () / 2], some[1][some[1].size () / 2],
                                some[2][some[2].size () / 2]);
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
normalsOf (const PcdViewOptions& options, const std::vector<Eigen::Vector3f>& positions, int most_neighbours)
{
  std::vector<Eigen::Vector3f> result (positions.size (), Eigen::Vector3f::Constant (nan_value));
  if (positions.size () < 3)
    return result;
  const QuietConsole quiet;
  const auto count = static_cast<int> (std::min<std::size_t> (positions.size (), std::numeric_limits<int>::max ()));
  const int wanted = std::clamp (count / points_per_neighbour, std::min (least_neighbours, most_neighbours),
                                 most_neighbours);
  const int threads = obtainableThreads (resolveThreads (options.threads));
  NormalEstimationOMP<PointXYZ, Normal> estimation (static_cast<unsigned int> (threads));
  estimation.setInputCloud (asCloud (positions));
  estimation.setSearchMethod (pcl::make_shared<search::KdTree<PointXYZ>> ());
  estimation.setKSearch (std::min (wanted, count));
  PointCloud<Normal> normals;
  estimation.compute (normals);
  for (std::size_t k = 0; k < positions.size (); ++k)
    result[k] = normals[k].getNormalVector3fMap ();
  return result;
}

} // namespace

PointCloud<PointXYZ>::Ptr
asCloud (const std::vector<Eigen::Vector3f>& positions)
{
  auto points = pcl::make_shared<PointCloud<PointXYZ>> ();
  for (const Eigen::Vector3f& p : positions)
    points->emplace_back (p.x (), p.y (), p.z ());
  return points;
}

void
addNormals (const PcdViewOptions& options, const std::vector<std::size_t>& indices, SensorCloud& cloud,
            const std::function<void (const std::vector<Eigen::Vector3f>&, std::vector<Eigen::Vector3f>&)>& turn)
{
  const ThinnedPoints thinned = thin (pick (cloud.positions, indices));
  const bool dense = thinned.points.size () < indices.size ();
  std::vector<Eigen::Vector3f> normals = normalsOf (
      options, thinned.points, dense ? neighbours_of_means * options.normal_neighbours : options.normal_neighbours);
  if (turn)
    turn (thinned.points, normals);
  for (std::size_t k = 0; k < indices.size (); ++k)
    cloud.normals[indices[k]] = normals[thinned.of[k]];
}

std::vector<float>
neighbourDistances (const std::vector<Eigen::Vector3f>& points, int neighbours, int threads)
{
  std::vector<float> distances (points.size (), 0.0f);
  // Among points at one place a search takes as long as there are.
  std::vector<std::size_t> order (points.size ());
  std::iota (order.begin (), order.end (), std::size_t{0});
  const auto key = [&] (std::size_t i) { return std::tie (points[i].x (), points[i].y (), points[i].z ()); };
  std::sort (order.begin (), order.end (), [&] (std::size_t a, std::size_t b) { return key (a) < key (b); });
  std::vector<Eigen::Vector3f> places;
  std::vector<std::size_t> place_of (points.size ());
  for (const std::size_t i : order)
  {
    if (places.empty () || places.back () != points[i])
      places.push_back (points[i]);
    place_of[i] = places.size () - 1;
  }
  if (places.size () < 2)
    return distances;
  search::KdTree<PointXYZ> tree;
  tree.setInputCloud (asCloud (places));
  std::vector<float> reach (places.size (), 0.0f);
  parallelFor (0, static_cast<int> (places.size ()), threads, [&] (int i) {
    Indices indices;
    std::vector<float> squared;
    tree.nearestKSearch (i, neighbours + 1, indices, squared);
    reach[i] = squared.empty () ? 0.0f : std::sqrt (squared.back ());
  });
  for (std::size_t i = 0; i < points.size (); ++i)
    distances[i] = reach[place_of[i]];
  return distances;
}

} // namespace pcl::cosection
