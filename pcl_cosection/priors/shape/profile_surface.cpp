// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "profile_surface.h"

#include "axes.h"
#include "pcl_cosection/common/directions.h"
#include "pcl_cosection/common/quantile.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace pcl::cosection {
namespace {

constexpr double max_radius = 1.5;      // of NormalLines::size
constexpr double cell_size = 0.05;      // of the profile, of NormalLines::size
constexpr int sectors = 36;             // around the axis
constexpr int round_sectors = 5;        // next to each other: a handle is not seen in so many
constexpr double least_step = 0.05;     // of a cell: between points of the inside of a vessel
constexpr double outlier_share = 0.002; // of the points: outliers that lie farther out

int
longestRun (const std::array<bool, sectors>& seen)
{
  int run = 0, longest = 0;
  for (int s = 0; s < 2 * sectors; ++s)
  {
    run = seen[s % sectors] ? run + 1 : 0;
    longest = std::max (longest, std::min (run, sectors));
  }
  return longest;
}

} // namespace

Eigen::Vector2d
ProfileSurface::profileOf (const Eigen::Vector3d& position) const
{
  const Eigen::Vector3d q = position - center_;
  const double height = direction_.dot (q);
  return {height, distanceOf (q - height * direction_)};
}

ProfilePoint
ProfileSurface::profilePointOf (const OrientedPoint& point) const
{
  const Eigen::Vector3d position = point.position.cast<double> (), n = point.normal.cast<double> ();
  const Eigen::Vector3d q = position - center_;
  return {profileOf (position), {direction_.dot (n), n.dot (awayOf (q - direction_.dot (q) * direction_))}};
}

bool
ProfileSurface::findProfile (const std::vector<OrientedPoint>& points, double size_m, int least_sectors)
{
  std::vector<ProfilePoint> profile;
  Eigen::AlignedBox2d box;
  for (const OrientedPoint& p : points)
  {
    profile.push_back (profilePointOf (p));
    box.extend (profile.back ().position);
  }
  if (points.empty () || box.max ().y () > max_radius * size_m)
    return false;
  const double middle = box.center ().x ();
  center_ += middle * direction_;
  box.translate (Eigen::Vector2d (-middle, 0.0));
  for (ProfilePoint& p : profile)
    p.position.x () -= middle;
  cell_m_ = cell_size * size_m;
  first_ = box.min ();
  cells_ = (box.sizes () / cell_m_).array ().floor ().cast<int> () + 1;
  std::vector<std::array<bool, sectors>> seen (static_cast<std::size_t> (cells_.prod ()));
  std::array<bool, sectors> seen_anywhere{};
  const Sectors around (direction_, sectors);
  for (std::size_t n = 0; n < points.size (); ++n)
  {
    const std::size_t sector = around.of (points[n].position.cast<double> () - center_);
    const Eigen::Vector2i cell = ((profile[n].position - first_) / cell_m_).array ().floor ().cast<int> ();
    for (int j = std::max (0, cell.y () - 1); j <= std::min (cells_.y () - 1, cell.y () + 1); ++j)
      for (int i = std::max (0, cell.x () - 1); i <= std::min (cells_.x () - 1, cell.x () + 1); ++i)
        seen[indexOf ({i, j})][sector] = true;
    if (facesSideways (direction_, points[n].normal.cast<double> ()))
      seen_anywhere[sector] = true;
  }
  if (longestRun (seen_anywhere) < least_sectors)
    return false;
  held_.resize (seen.size ());
  for (std::size_t c = 0; c < seen.size (); ++c)
    held_[c] = longestRun (seen[c]) >= round_sectors;
  for (std::size_t n = 0; n < points.size (); ++n)
    if (holds (points[n].position.cast<double> ()))
      profile_.push_back (profile[n]);
  return !profile_.empty ();
}

void
ProfileSurface::findVessel (const std::optional<Eigen::Vector4d>& plane, Hollow hollow)
{
  if (hollow == Hollow::None)
    return;
  std::optional<StandingPlane> standing;
  if (const double rise = plane ? plane->head<3> ().dot (direction_) : 0.0; std::abs (rise) > vertical_cosine)
    standing = StandingPlane{-(plane->head<3> ().dot (center_) + (*plane)[3]) / rise, rise > 0.0 ? 1.0 : -1.0};
  if (hollow != Hollow::Dish)
    vessel_ = fitVessel (profile_, cell_m_, standing);
  if (!vessel_ && hollow != Hollow::Vessel && (standing || !plane))
    vessel_ = fitDish (profile_, cell_m_, standing);
}

bool
ProfileSurface::holds (const Eigen::Vector3d& position) const
{
  const Eigen::Vector2d cell = ((profileOf (position) - first_) / cell_m_).array ().floor ();
  return (cell.array () >= 0.0).all () && (cell.array () < cells_.cast<double> ().array ()).all () &&
         held_[indexOf (cell.cast<int> ())];
}

std::vector<OrientedPoint>
ProfileSurface::copies (const std::vector<OrientedPoint>& points) const
{
  std::vector<OrientedPoint> held;
  std::copy_if (points.begin (), points.end (), std::back_inserter (held), [this] (const OrientedPoint& p) {
    return holds (p.position.cast<double> ()) && (!vessel_ || vessel_->holds (profilePointOf (p)));
  });
  std::vector<OrientedPoint> copies;
  for (const Eigen::Matrix3d& turn : turns ())
    for (OrientedPoint p : held)
    {
      p.position = (center_ + turn * (p.position.cast<double> () - center_)).cast<float> ();
      p.normal = (turn * p.normal.cast<double> ()).cast<float> ();
      copies.push_back (p);
    }
  return copies;
}

double
ProfileSurface::extent (const Eigen::Vector3d& n) const
{
  const double rise = direction_.dot (n);
  const Eigen::Vector3d across = n - rise * direction_;
  std::vector<double> extents;
  extents.reserve (profile_.size ());
  for (const ProfilePoint& p : profile_)
    extents.push_back (rise * p.position.x () + reachOf (across, p.position.y ()));
  return trimmedMax (extents, outlier_share);
}

std::vector<OrientedPoint>
ProfileSurface::depths (double step_m) const
{
  std::vector<OrientedPoint> points;
  if (!vessel_)
    return points;
  const double step = std::max (step_m, least_step * cell_m_);
  for (const ProfilePoint& p : vessel_->depths (step))
    for (const Place& place : around (p.position.y (), step))
    {
      OrientedPoint point;
      point.position = (center_ + p.position.x () * direction_ + place.offset).cast<float> ();
      point.normal = (p.normal.x () * direction_ + p.normal.y () * place.away).cast<float> ();
      points.push_back (point);
    }
  return points;
}

} // namespace pcl::cosection
