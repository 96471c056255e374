// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "free_space_votes.h"

#include "pcl_cosection/common/parallel.h"
#include "visibility.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace pcl::cosection {
namespace {

constexpr double min_margin = 0.005; // of the working range
constexpr int max_footprint = 12;    ///< pixels
constexpr int min_support = 3;       ///< neighbours of the same depth, as many as a corner of a surface has
constexpr std::size_t most_samples = 2000;
constexpr double bad_views = 0.05;  // of all views, may contradict
constexpr double least_asked = 0.1; // of the points, about which a view must say something

/** \brief The votes of one view on points. */
class Witness
{
public:
  Witness (const FreeSpaceView& view, const Eigen::Isometry3d& T_points_sensor, double margin_m)
      : view_ (view)
      , depth_ (view.view ())
      , margin_m_ (margin_m)
      , T_sensor_points_ (T_points_sensor.inverse ())
  {}

  void vote (const Eigen::Vector3f& point, FreeSpaceVotes& votes) const
  {
    const Eigen::Vector3d p = T_sensor_points_ * point.cast<double> ();
    const std::optional<Eigen::Array2i> pixel = pixelOf (depth_.camera, p);
    if (!pixel)
      return;
    const int u = pixel->x (), v = pixel->y ();
    const float reading = depth_.at (u, v);
    const PointVisibility visibility = compareWithReading (p.z (), reading, margin (reading));
    if (visibility == PointVisibility::AtSurface)
      votes.surface += !view_.atEdge (u, v) || isSupported (u, v);
    else if (visibility == PointVisibility::Free)
      votes.free += !view_.atEdge (u, v) && isClear (u, v, p.z ());
  }

private:
  double margin (double z) const { return margin_m_ > 0.0 ? margin_m_ : pointMargin (depth_, z); }

  /** \brief Whether test (depth) holds for all readings in a square window. */
  template <typename Test> bool allReadings (int u, int v, int radius, Test&& test) const
  {
    for (int row = std::max (0, v - radius); row <= std::min (depth_.camera.height - 1, v + radius); ++row)
      for (int column = std::max (0, u - radius); column <= std::min (depth_.camera.width - 1, u + radius); ++column)
        if (isReading (depth_.at (column, row)) && !test (depth_.at (column, row)))
          return false;
    return true;
  }

  bool isSupported (int u, int v) const
  {
    const float z = depth_.at (u, v);
    int same = -1; // not the pixel itself
    return !allReadings (u, v, 1, [&] (double reading) {
      same += std::abs (reading - z) <= margin (z);
      return same < min_support;
    });
  }

  bool isClear (int u, int v, double z) const
  {
    const double focal = std::max (depth_.camera.fx, depth_.camera.fy);
    const auto radius = static_cast<int> (std::ceil (std::min<double> (max_footprint, margin (z) * focal / z)));
    return allReadings (u, v, radius, [&] (double reading) { return reading - z > margin (reading); });
  }

  const FreeSpaceView& view_;
  const DepthView& depth_;
  double margin_m_;
  Eigen::Isometry3d T_sensor_points_;
};

} // namespace

double
pointMargin (const DepthView& view, double depth_m)
{
  return std::max (min_margin * view.working_range_m, freeSpaceMargin (view, depth_m, 0.0));
}

std::vector<FreeSpaceVotes>
voteOnPoints (const std::vector<Eigen::Vector3f>& points, const std::vector<FreeSpaceView>& views, double margin_m,
              int threads)
{
  std::vector<Witness> witnesses;
  witnesses.reserve (views.size ());
  for (const FreeSpaceView& view : views)
    witnesses.emplace_back (view, view.view ().T_world_sensor, margin_m);
  std::vector<FreeSpaceVotes> votes (points.size ());
  parallelFor (0, static_cast<int> (points.size ()), threads, [&] (int i) {
    for (const Witness& witness : witnesses)
      witness.vote (points[i], votes[i]);
  });
  return votes;
}

void
addVotes (const std::vector<Eigen::Vector3f>& points, const FreeSpaceView& view,
          const Eigen::Isometry3d& T_points_sensor, std::vector<FreeSpaceVotes>& votes, double margin_m, int threads)
{
  if (votes.size () != points.size ())
    throw InvalidArgument ("there are " + std::to_string (votes.size ()) + " votes for " +
                           std::to_string (points.size ()) + " points");
  const Witness witness (view, T_points_sensor, margin_m);
  parallelFor (0, static_cast<int> (points.size ()), threads, [&] (int i) { witness.vote (points[i], votes[i]); });
}

ViewAgreement::ViewAgreement (const std::vector<OrientedPoint>& points)
{
  const std::size_t stride = (points.size () + most_samples - 1) / most_samples;
  for (std::size_t p = 0; p < points.size (); p += stride)
  {
    positions_.push_back (points[p].position);
    normals_.push_back (points[p].normal);
  }
}

void
ViewAgreement::add (int number, const FreeSpaceView& view, const Eigen::Isometry3d& T_points_sensor, int threads)
{
  std::vector<FreeSpaceVotes> votes (positions_.size ());
  addVotes (positions_, view, T_points_sensor, votes, 0.0, threads);
  const Eigen::Vector3f sensor = T_points_sensor.translation ().cast<float> ();
  int free = 0, surface = 0;
  for (std::size_t p = 0; p < votes.size (); ++p)
  {
    free += votes[p].free;
    surface += votes[p].surface;
    turned_away_ += votes[p].surface > 0 && normals_[p].dot (sensor - positions_[p]) < 0.0f;
  }
  seen_ += surface;
  const std::vector<float>& depth = view.view ().depth;
  has_readings_ = has_readings_ || std::any_of (depth.begin (), depth.end (), isReading);
  if (free + surface < least_asked * static_cast<double> (positions_.size ()))
    return;
  of_views_.push_back ({static_cast<double> (free) / (free + surface), number});
}

ViewAgreement::Contradiction
ViewAgreement::worst () const
{
  if (of_views_.empty ())
    return {};
  std::vector<Contradiction> sorted = of_views_;
  std::sort (sorted.begin (), sorted.end (), [] (const Contradiction& a, const Contradiction& b) {
    return a.share > b.share || (a.share == b.share && a.view < b.view);
  });
  return sorted[static_cast<std::size_t> (bad_views * static_cast<double> (sorted.size ()))];
}

} // namespace pcl::cosection
