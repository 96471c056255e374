// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "resting_planes.h"

#include "extrusion.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/view/support_plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr std::size_t most_feet = 10000; // even subset of the points
// Heights of the lowest points over a plane, of the middle observed extent: the object rests on the plane ...
constexpr double resting_reach = 0.15;    // ... in any case
constexpr double hidden_foot_reach = 0.5; // ... unless free space or another body was observed between them
constexpr double parallel = 0.995;        // cosine of planes on which the object rests in the same way
// Sectors around an object's middle, and the share of a top's points in one that has some: six real views of stacked
// boxes are the same with half and twice as many, and shares of 0.0005 and 0.005.
constexpr int sectors = 36;
constexpr double least_share = 0.002;

/** \brief Whether the lowest points are nearer to a plane than \a reach of the middle extent. */
bool
hasFootNear (const Observation& object, const Eigen::Vector4d& plane, double reach)
{
  const std::vector<OrientedPoint>& points = object.points ();
  const std::ptrdiff_t lower = std::count_if (points.begin (), points.end (), [&] (const OrientedPoint& p) {
    return heightOver (plane, p.position.cast<double> ()) < reach * object.extents_m[1];
  });
  return lower > static_cast<std::ptrdiff_t> (lowest_share * static_cast<double> (points.size ()));
}

/** \brief Whether neither free space nor another body was observed between the foot of the object's middle on a plane
 * and the height of the lowest point. */
bool
footIsHidden (const Observation& object, const ObjectSetting& setting, const BodyEnergy& energy,
              const Eigen::Vector4d& plane)
{
  const Eigen::Vector3d up = plane.head<3> ();
  double lowest_m = std::numeric_limits<double>::infinity ();
  for (const OrientedPoint& p : object.points ())
    lowest_m = std::min (lowest_m, heightOver (plane, p.position.cast<double> ()));
  const Eigen::Vector3d middle = object.box.center ();
  const Eigen::Vector3d foot = middle - heightOver (plane, middle) * up;
  for (double height_m = 0.0; height_m < lowest_m; height_m += 0.5 * energy.grid.voxel_size_m)
  {
    const Eigen::Vector3d place = foot + height_m * up;
    const auto at = energy.grid.nearest (place);
    if ((at && energy.free_space[energy.grid.index (at->x (), at->y (), at->z ())]) ||
        (setting.is_of_other && setting.is_of_other (place, up)))
      return false;
  }
  return true;
}

/** \brief Planes by their distance from the object's middle, the nearest first. */
std::vector<Eigen::Vector4d>
nearestFirst (const Observation& object, std::vector<Eigen::Vector4d> planes)
{
  std::stable_sort (planes.begin (), planes.end (), [&] (const Eigen::Vector4d& a, const Eigen::Vector4d& b) {
    return heightOver (a, object.box.center ()) < heightOver (b, object.box.center ());
  });
  return planes;
}

bool
isParallelToAny (const Eigen::Vector4d& plane, const std::vector<Eigen::Vector4d>& others)
{
  return std::any_of (others.begin (), others.end (), [&] (const Eigen::Vector4d& other) {
    return plane.head<3> ().dot (other.head<3> ()) > parallel;
  });
}

/** \brief Whether points lie on all sides of a place: no half of the sectors across \a up is without some. */
bool
surround (const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& place, const Eigen::Vector3d& up)
{
  const Eigen::Vector3d across = up.unitOrthogonal (), along = up.cross (across);
  std::array<std::size_t, sectors> count{};
  for (const Eigen::Vector3d& p : points)
  {
    const double turn = std::atan2 (along.dot (p - place), across.dot (p - place)) / (2.0 * M_PI) + 0.5;
    ++count[std::min<std::size_t> (sectors - 1, static_cast<std::size_t> (sectors * turn))];
  }
  const double least = least_share * static_cast<double> (points.size ());
  int gap = 0;
  for (int n = 0; n < 2 * sectors && 2 * gap < sectors; ++n)
    gap = static_cast<double> (count[n % sectors]) < least ? gap + 1 : 0;
  return 2 * gap < sectors;
}

} // namespace

std::optional<Eigen::Vector4d>
levelTopBelow (const std::vector<OrientedPoint>& object, const std::vector<OrientedPoint>& other,
               const Eigen::Vector4d& below, double tolerance_m)
{
  const Eigen::Vector3d up = below.head<3> ();
  std::vector<double> heights_m, top_m;
  Eigen::AlignedBox3d box;
  for (const OrientedPoint& p : object)
  {
    heights_m.push_back (heightOver (below, p.position.cast<double> ()));
    box.extend (p.position.cast<double> ());
  }
  if (heights_m.empty ())
    return std::nullopt;
  const double lowest_m = quantile (heights_m, lowest_share);
  if (lowest_m < 2.0 * tolerance_m) // it stands on the plane below
    return std::nullopt;
  std::vector<Eigen::Vector3d> top;
  for (const OrientedPoint& p : other)
    if (const double height_m = heightOver (below, p.position.cast<double> ());
        std::abs (height_m - lowest_m) < tolerance_m && up.cast<float> ().dot (p.normal) > level_top_cosine)
    {
      top.push_back (p.position.cast<double> ());
      top_m.push_back (height_m);
    }
  if (top.empty () || !surround (top, box.center (), up))
    return std::nullopt;
  const double height_m = upperMedian (top_m);
  const auto lower = std::count_if (heights_m.begin (), heights_m.end (),
                                    [&] (double h) { return h < height_m - tolerance_m; });
  if (static_cast<double> (lower) > SupportPlaneOptions ().max_below * static_cast<double> (heights_m.size ()))
    return std::nullopt;
  return below - height_m * Eigen::Vector4d::UnitW ();
}

std::optional<Eigen::Vector4d>
nearestPlaneBelow (const Observation& object, const std::vector<Eigen::Vector4d>& planes)
{
  for (const Eigen::Vector4d& plane : nearestFirst (object, planes))
    if (hasFootNear (object, plane, hidden_foot_reach))
      return plane;
  return std::nullopt;
}

std::vector<Eigen::Vector4d>
restingPlanes (const Observation& object, const ObjectSetting& setting, const std::vector<Eigen::Vector4d>& planes,
               const BodyEnergy& energy)
{
  std::vector<Eigen::Vector4d> resting;
  for (const Eigen::Vector4d& plane : nearestFirst (object, planes))
    if (!isParallelToAny (plane, resting) &&
        (hasFootNear (object, plane, resting_reach) ||
         (footIsHidden (object, setting, energy, plane) &&
          (hasFootNear (object, plane, hidden_foot_reach) || Extrusion (energy, object.points (), plane).hasWalls ()))))
      resting.push_back (plane);
  return resting;
}

Eigen::AlignedBox3d
boxWithFeet (const Observation& object, const ObjectSetting& setting, const std::vector<Eigen::Vector4d>& planes)
{
  std::vector<Eigen::Vector4d> nearest;
  for (const Eigen::Vector4d& plane : nearestFirst (object, planes))
    if (!isParallelToAny (plane, nearest))
      nearest.push_back (plane);
  Eigen::AlignedBox3d box = object.box;
  const auto footOn = [] (const Eigen::Vector4d& plane, const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return p - heightOver (plane, p) * plane.head<3> ();
  };
  for (const Eigen::Vector4d& plane : nearest)
    for (std::size_t p = 0; p < object.points ().size (); p += object.points ().size () / most_feet + 1)
    {
      const Eigen::Vector3d foot = footOn (plane, object.points ()[p].position.cast<double> ());
      if (object.hidden.at (foot) != Hidden::Nothing)
        box.extend (foot);
    }
  // Its corners may be behind others, where it goes on beside what was seen.
  const Eigen::AlignedBox3d seen = box;
  for (const Eigen::Vector4d& plane : nearest)
    for (int c = 0; c < 8; ++c)
    {
      const Eigen::Vector3d foot = footOn (plane, seen.corner (static_cast<Eigen::AlignedBox3d::CornerType> (c)));
      if (object.hidden.isBehindOther (foot))
        box.extend (foot);
    }
  return box;
}

} // namespace pcl::cosection
