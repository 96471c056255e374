// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "cluster_segmentation.h"

#include "pcl_cosection/common/boxes.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/io/quiet_console.h"
#include "pcl_cosection/view/normals/estimated_normals.h"

#include <pcl/cosection/common/error.h>

#include <pcl/point_types.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_plane.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/impl/extract_clusters.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr std::size_t least_points = 100;
constexpr int spacing_neighbours = 4;
constexpr double sheet_spacings = 2.0;   // half thickness of a plane, of the distance of neighbours ...
constexpr double sheet_of_object = 0.25; // ... or of the smallest object, whichever is larger
constexpr double gap_spacings = 3.0;     // distance of clusters, likewise
constexpr double cell_spacings = 4.0;    // side of the cells by which a plane's area is measured, at least a sheet
constexpr int most_planes = 6;
constexpr double least_filled = 0.5; // of the box around a plane's points: less is a cut through several things
constexpr int ransac_iterations = 1000;
constexpr double outlier_share = 0.02;
constexpr int least_cluster = 50; // points
// Height of the foot of what stands on a plane, in gaps between clusters ...
constexpr double near_gaps = 3.0;
// ... or in heights of what is seen of it: a ball that is seen from 60 degrees above level hides a third of that, and
// its lowest points are the sparsest.
constexpr double noise_sheets = 1.5; // how far below a plane its noise is looked for: there table tops do not end yet
// Points in the place of a cluster below its plane, of those of the cluster. Clusters of objects have at most 0.05 (132
// of 133 on OSD, YCB-Video, RealSense and scanned meshes), three quarters of those of ground more than this.
constexpr double most_below = 0.1;
constexpr float hidden_foot = 0.5f;

using Points = PointCloud<PointXYZ>;

/** \brief Lengths that the points and the objects ask for, metres. */
struct Lengths
{
  double sheet, gap, cell;
};

/** \brief A plane with the part of it that has points. */
class Support
{
public:
  Support (const Eigen::Vector4f& coefficients, const Points& cloud, const Indices& inliers, double cell_m)
      : plane_ (coefficients / coefficients.head<3> ().norm ())
      , u_ (plane_.head<3> ().unitOrthogonal ())
      , v_ (plane_.head<3> ().cross (u_))
      , cell_m_ (cell_m)
  {
    std::set<Cell> cells;
    std::vector<Eigen::Vector3f> along;
    for (const auto i : inliers)
    {
      const Eigen::Vector2f at = project (cloud[i].getVector3fMap ());
      along.emplace_back (at.x (), at.y (), 0.0f);
      cells.insert (cellOf (cloud[i].getVector3fMap ()));
    }
    area_m2_ = static_cast<double> (cells.size ()) * cell_m * cell_m;
    box_ = trimmedBox<float> (along, outlier_share, [] (const Eigen::Vector3f& p) { return p; });
  }

  double area () const { return area_m2_; }
  bool isFilled () const { return area_m2_ > least_filled * box_.sizes ().x () * box_.sizes ().y (); }
  double longest () const { return box_.sizes ().maxCoeff (); }
  float height (const Eigen::Vector3f& p) const { return plane_.head<3> ().dot (p) + plane_[3]; }
  const Eigen::Vector4f& plane () const { return plane_; }

  /** \brief Let the normal point to the side on which more of \a left is near the plane, and note what is on the other
   * one. */
  void turnToObjects (const Points& cloud, const Indices& left, double reach_m, double sheet_m, double depth_m)
  {
    std::ptrdiff_t balance = 0;
    for (const auto i : left)
      if (const Eigen::Vector3f p = cloud[i].getVector3fMap (); covers (p))
        if (const float distance = height (p); std::abs (distance) < reach_m)
          balance += distance > 0.0f ? 1 : -1;
    if (balance < 0)
      plane_ = -plane_;
    for (const PointXYZ& point : cloud)
      if (const float distance = height (point.getVector3fMap ()); distance < -sheet_m && distance > -depth_m)
        ++below_[cellOf (point.getVector3fMap ())];
  }

  /** \brief Whether a cluster is noise of the plane, which is on both of its sides; nothing is below what stands. */
  bool isNoise (const std::vector<Eigen::Vector3f>& cluster) const
  {
    std::set<Cell> cells;
    for (const Eigen::Vector3f& p : cluster)
      cells.insert (cellOf (p));
    std::size_t below = 0;
    for (const Cell& cell : cells)
      if (const auto found = below_.find (cell); found != below_.end ())
        below += found->second;
    return static_cast<double> (below) > most_below * static_cast<double> (cluster.size ());
  }

  /** \brief Whether a place is above or below the part that has points. */
  bool covers (const Eigen::Vector3f& p) const
  {
    const Eigen::Vector2f at = project (p);
    return box_.contains (Eigen::Vector3f (at.x (), at.y (), 0.0f));
  }

private:
  Eigen::Vector2f project (const Eigen::Vector3f& p) const { return {u_.dot (p), v_.dot (p)}; }

  using Cell = std::pair<std::int64_t, std::int64_t>;

  Cell cellOf (const Eigen::Vector3f& p) const
  {
    const Eigen::Vector2f at = project (p);
    return {static_cast<std::int64_t> (std::floor (at.x () / cell_m_)),
            static_cast<std::int64_t> (std::floor (at.y () / cell_m_))};
  }

  Eigen::Vector4f plane_;
  Eigen::Vector3f u_, v_;
  double cell_m_;
  std::map<Cell, std::size_t> below_; // points
  Eigen::AlignedBox3f box_;           // along u and v
  double area_m2_ = 0.0;
};

/** \brief The plane of most of the points that are left, which it takes; nothing if it is too small. */
std::optional<Support>
takePlane (const Points::Ptr& cloud, const ObjectSegmentationOptions& options, const Lengths& lengths, bool is_first,
           Indices& left)
{
  if (left.size () < least_points)
    return std::nullopt;
  const QuietConsole quiet;
  auto model = pcl::make_shared<SampleConsensusModelPlane<PointXYZ>> (cloud, left); // its seed is always the same
  RandomSampleConsensus<PointXYZ> ransac (model, lengths.sheet);
  ransac.setMaxIterations (ransac_iterations);
  Eigen::VectorXf found, refined;
  Indices inliers;
  if (!ransac.computeModel (0))
    return std::nullopt;
  ransac.getModelCoefficients (found);
  ransac.getInliers (inliers);
  model->optimizeModelCoefficients (inliers, found, refined);
  model->selectWithinDistance (refined, lengths.sheet, inliers);
  if (inliers.size () < least_points)
    return std::nullopt;
  Support support (refined.head<4> (), *cloud, inliers, lengths.cell);
  if (support.area () < options.min_support_area_m2 || !support.isFilled () ||
      (!is_first && support.longest () < options.max_object_size_m))
    return std::nullopt;
  Indices rest;
  std::sort (inliers.begin (), inliers.end ());
  std::set_difference (left.begin (), left.end (), inliers.begin (), inliers.end (), std::back_inserter (rest));
  left = std::move (rest);
  return support;
}

/** \brief Whether a cluster is as large as an object, and stands on a plane, if there is any.
 * \param[out] is_too_long whether it stands there, but is larger */
bool
standsOn (const std::vector<Support>& supports, const Points& cloud, const Indices& cluster,
          const ObjectSegmentationOptions& options, const Lengths& lengths, bool& is_too_long)
{
  std::vector<Eigen::Vector3f> points;
  for (const auto i : cluster)
    points.emplace_back (cloud[i].getVector3fMap ());
  const Eigen::AlignedBox3f box = trimmedBox<float> (points, outlier_share,
                                                     [] (const Eigen::Vector3f& p) { return p; });
  const double longest = box.sizes ().maxCoeff ();
  if (longest < options.min_object_size_m)
    return false;
  bool stands = supports.empty ();
  for (const Support& support : supports)
  {
    std::vector<float> heights;
    for (const Eigen::Vector3f& p : points)
      heights.push_back (support.height (p));
    const float foot = trimmedMin (heights, outlier_share), top = trimmedMax (heights, outlier_share);
    const double highest = std::max (near_gaps * lengths.gap, static_cast<double> (hidden_foot * (top - foot)));
    if (!support.covers (box.center ()) || !(foot > 0.0f && foot < highest))
      continue;
    if (support.isNoise (points))
      return false;
    stands = true;
  }
  is_too_long = stands && longest > options.max_object_size_m;
  return stands && !is_too_long;
}

} // namespace

ObjectSegmentation
segmentClusters (const std::vector<Eigen::Vector3f>& points, const ObjectSegmentationOptions& options)
{
  options.validate ();
  std::vector<std::size_t> of; // indices of the points that have a place
  std::vector<Eigen::Vector3f> places;
  for (std::size_t i = 0; i < points.size (); ++i)
    if (points[i].allFinite ())
    {
      places.push_back (points[i]);
      of.push_back (i);
    }
  if (of.size () < least_points)
    throw DegenerateInput ("has " + std::to_string (of.size ()) + " readings, at least " +
                           std::to_string (least_points) + " are needed");
  const Points::Ptr cloud = asCloud (places);
  std::vector<float> distances = neighbourDistances (places, spacing_neighbours, options.threads);
  const double spacing = upperMedian (distances);
  const double sheet = std::max (sheet_spacings * spacing, sheet_of_object * options.min_object_size_m);
  const Lengths lengths{sheet, std::max (gap_spacings * spacing, sheet), std::max (cell_spacings * spacing, sheet)};

  Indices left (cloud->size ());
  for (std::size_t i = 0; i < left.size (); ++i)
    left[i] = static_cast<index_t> (i);
  std::vector<Support> supports;
  while (static_cast<int> (supports.size ()) < most_planes)
    if (auto support = takePlane (cloud, options, lengths, supports.empty (), left))
      supports.push_back (*support);
    else
      break;
  for (Support& support : supports)
    support.turnToObjects (*cloud, left, options.max_object_size_m, lengths.sheet, noise_sheets * lengths.sheet);

  std::vector<PointIndices> clusters;
  if (!left.empty ())
  {
    const auto tree = pcl::make_shared<search::KdTree<PointXYZ>> ();
    tree->setInputCloud (cloud, pcl::make_shared<Indices> (left));
    extractEuclideanClusters<PointXYZ> (*cloud, left, tree, static_cast<float> (lengths.gap), clusters, least_cluster);
  }
  std::stable_sort (clusters.begin (), clusters.end (), [] (const PointIndices& a, const PointIndices& b) {
    return a.indices.size () > b.indices.size ();
  });
  ObjectSegmentation result;
  result.labels.assign (points.size (), 0);
  result.too_long.assign (points.size (), 0);
  for (const PointIndices& cluster : clusters)
  {
    bool is_too_long = false;
    const bool is_object = standsOn (supports, *cloud, cluster.indices, options, lengths, is_too_long);
    result.objects += is_object;
    for (const auto i : cluster.indices)
    {
      result.labels[of[i]] = is_object ? result.objects : 0;
      result.too_long[of[i]] = is_too_long;
    }
  }
  for (const Support& support : supports)
    result.support_planes.push_back (support.plane ());
  return result;
}

} // namespace pcl::cosection
