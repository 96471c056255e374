// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "co_section_run.h"

#include "pcl_cosection/priors/contact_edge.h"
#include "pcl_cosection/priors/inferred_support_plane.h"
#include "pcl_cosection/priors/rays_without_return.h"
#include "volume_layout.h"
#include "voxel_size.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

// The part of a run that adds what is expected of hidden sides.

namespace pcl::cosection
{

namespace
{

constexpr std::size_t most_points = 10000; // an even subset of no more tells of planes
constexpr double along_axis = 0.9;         // cosine: what is round ends across its axis
constexpr double guess_reach_voxels = 2.0; // of a plane that was guessed: what it bounds
constexpr double resting_reach = 0.15;     // of the middle observed extent: what is as low over a plane rests on it
constexpr double hidden_foot_reach = 0.5;  // of the middle observed extent: what is as low rests on it, if that may be
constexpr double
    lowest_plane_reach = 2.0; // of the middle observed extent: what goes down behind others rests on what is no lower
constexpr double resting_share = 0.01;        // of the points, which may be lower
constexpr std::ptrdiff_t least_ground = 20;   // points of the background, seen through what would be a vessel else
constexpr double refuted_copies = 0.1;        // of the columns of walls: copies are not alike
constexpr double refuted_outline = 0.5;       // it has no such walls
constexpr double beside_steps = 2.0;          // from the edge of a top
constexpr double same_resting_cosine = 0.995; // planes of two views on which it rests the same way

} // namespace

bool
CoSectionRun::nothingIsKnownAround () const
{
  return scene_.planes.empty () && scene_.background.empty () && scene_.bodies.empty () && scene_.meshes.empty ();
}

void
CoSectionRun::guessPlane (Object& object) const
{
  if (!scene_.options.use_extent_prior || !scene_.options.use_planes)
    return;
  const SymmetricExtent extent = extentOf (object, std::nullopt);
  if (extent.wallThickness () > 0.0)
    return;
  const std::vector<OrientedPoint>& all = object.points ();
  std::vector<OrientedPoint> points;
  for (std::size_t p = 0; p < all.size (); p += all.size () / most_points + 1)
    if (all[p].position.allFinite () && all[p].normal.allFinite ())
      points.push_back (all[p]);
  std::optional<Eigen::Vector4d> plane = inferredSupportPlane (points);
  if (!plane && !extent.isFaceted ()) // flat faces end at edges as they do where they touch something
  {
    plane = contactBoundaryPlane (points, viewsOf (object));
    if (const std::optional<Eigen::Vector3d> axis = extent.axisDirection ();
        plane && axis && std::abs (axis->dot (plane->head<3> ())) < along_axis)
      plane.reset ();
  }
  if (!plane)
    return;
  object.planes.push_back (transformPlane (*plane, firstPose (object).inverse ()));
  object.plane_is_guessed = true;
  object.result->guessed_plane = object.planes.front ();
}

void
CoSectionRun::markGuesses (const Object& object, TriangleMesh& mesh) const
{
  if (!object.plane_is_guessed)
    return;
  const Eigen::Vector4d plane = transformPlane (object.planes.front (), firstPose (object));
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
    if (mesh.provenance[v] == static_cast<std::uint8_t> (Provenance::Intersection) &&
        std::abs (plane.head<3> ().dot (mesh.vertices[v].cast<double> ()) + plane[3]) <
            guess_reach_voxels * object.voxel_size_m)
      mesh.provenance[v] = static_cast<std::uint8_t> (Provenance::Inferred);
}

bool
CoSectionRun::footIsHidden (const Object& object, const Eigen::Vector4d& plane) const
{
  const Eigen::Vector3d up = plane.head<3> ();
  const std::vector<OrientedPoint>& points = object.points ();
  double lowest_m = std::numeric_limits<double>::infinity ();
  for (const OrientedPoint& p : points)
    lowest_m = std::min (lowest_m, up.dot (p.position.cast<double> ()) + plane[3]);
  Eigen::Vector3d foot = SymmetricExtent (points, plane).center ();
  foot -= (up.dot (foot) + plane[3]) * up;
  const UnseenPlaces places = placesOf (object);
  for (double height_m = 0.0; height_m < lowest_m; height_m += 0.5 * object.body->grid ().voxel_size_m)
    if (places.isTaken (foot + height_m * up))
      return false;
  return true;
}

UnseenPlaces
CoSectionRun::placesOf (const Object& object) const
{
  std::vector<std::pair<const Object*, std::vector<Eigen::Isometry3d>>> others;
  for (const Object& other : objects_)
    if (&other != &object && other.alive ())
      others.emplace_back (&other, relativePoses (object, &other));
  const auto is_free = [&object] (const Eigen::Vector3d& p) {
    const VoxelGrid& grid = object.body->grid ();
    const auto at = grid.nearest (p);
    return at && object.body->volume->freeSpace ()[grid.index (at->x (), at->y (), at->z ())];
  };
  const auto is_of_other = [others] (const Eigen::Vector3d& p) {
    return std::any_of (others.begin (), others.end (), [&p] (const auto& other) {
      return std::any_of (other.second.begin (), other.second.end (), [&] (const Eigen::Isometry3d& T_other_object) {
        return other.first->observed.contains (T_other_object * p);
      });
    });
  };
  return {is_free, is_of_other, [&object] (const Eigen::Vector3d& p) { return object.body->hidden.isBehindOther (p); }};
}

double
CoSectionRun::wallStep (const Object& object) const
{
  return std::max (object.body->grid ().voxel_size_m, object.spacing_m);
}

SymmetricExtent
CoSectionRun::withHiddenWalls (const Object& object, const SymmetricExtent& extent, const Eigen::Vector4d& plane) const
{
  if (extent.wallThickness () > 0.0) // goes down to its bottom anyway
    return extent;
  const UnseenPlaces places = placesOf (object);
  const double step_m = wallStep (object);
  const auto is_any = [&] (const WallColumn& wall, const std::function<bool (const Eigen::Vector3d&)>& what) {
    return std::any_of (wall.begin (), wall.end (), [&] (const OrientedPoint& p) {
      return what (p.position.cast<double> () - step_m * p.normal.cast<double> ());
    });
  };
  const auto is_refuted = [&] (const WallColumn& wall) { return is_any (wall, places.is_free); };
  const auto is_of_other = [&] (const WallColumn& wall) { return is_any (wall, places.is_of_other); };
  for (const bool of_copies : {true, false})
  {
    std::vector<WallColumn> walls = extent.verticalWalls (step_m, of_copies);
    const auto end = std::remove_if (walls.begin (), walls.end (), is_refuted);
    if (static_cast<double> (walls.end () - end) >=
        (of_copies ? refuted_copies : refuted_outline) * static_cast<double> (walls.size ()))
      continue;
    const auto kept = std::remove_if (walls.begin (), end, is_of_other);
    if (2 * (kept - walls.begin ()) < end - walls.begin ())
      continue;
    std::vector<OrientedPoint> possible;
    std::for_each (walls.begin (), kept,
                   [&] (const WallColumn& wall) { possible.insert (possible.end (), wall.begin (), wall.end ()); });
    if (!of_copies) // and where it is not convex, beside its top one sees free space
      for (const WallColumn& wall : extent.wallsBelowEdges (step_m))
        if (!wall.empty () &&
            places.is_free (wall.back ().position.cast<double> () +
                            beside_steps * step_m * wall.back ().normal.cast<double> ()) &&
            !is_refuted (wall) && !is_of_other (wall))
          possible.insert (possible.end (), wall.begin (), wall.end ());
    return extent.boundedBy (possible, !of_copies);
  }
  return extent.continuedBy (wallsBehindOthers (object.points (), plane, step_m, places));
}

bool
CoSectionRun::hasFootNear (const Object& object, const Eigen::Vector4d& plane, double reach) const
{
  const std::vector<OrientedPoint>& points = object.points ();
  const std::ptrdiff_t lower = std::count_if (points.begin (), points.end (), [&] (const OrientedPoint& p) {
    return plane.head<3> ().dot (p.position.cast<double> ()) + plane[3] < reach * object.extents_m[1];
  });
  return lower > static_cast<std::ptrdiff_t> (resting_share * static_cast<double> (points.size ()));
}

Eigen::AlignedBox3d
CoSectionRun::downToPlanesBehindOthers (const Object& object, const std::vector<Eigen::Vector4d>& planes) const
{
  Eigen::AlignedBox3d box = object.observed;
  for (const Eigen::Vector4d& plane : planes)
    if (hasFootNear (object, plane, lowest_plane_reach))
      for (const Eigen::Vector3d& corner : corners (object.observed))
      {
        const Eigen::Vector3d foot = corner - (plane.head<3> ().dot (corner) + plane[3]) * plane.head<3> ();
        if (object.body->hidden.isBehindOther (foot))
          box.extend (foot);
      }
  return box;
}

bool
CoSectionRun::mayRestOn (const Object& object, const Eigen::Vector4d& plane) const
{
  return hasFootNear (object, plane, hidden_foot_reach);
}

std::vector<Eigen::Vector4d>
CoSectionRun::restingPlanes (const Object& object) const
{
  const std::vector<Eigen::Vector4d> planes = planesAt (object, object.planes, relativePoses (object, nullptr));
  std::vector<Eigen::Vector4d> resting;
  for (const Eigen::Vector4d& plane : planes)
  {
    const bool known = std::any_of (resting.begin (), resting.end (), [&] (const Eigen::Vector4d& other) {
      return plane.head<3> ().dot (other.head<3> ()) > same_resting_cosine;
    });
    if (known)
      continue;
    if (hasFootNear (object, plane, resting_reach) || (mayRestOn (object, plane) && footIsHidden (object, plane)))
      resting.push_back (plane);
  }
  if (!resting.empty ())
    return resting;
  const auto goes_down_behind_others = [&] (const Eigen::Vector4d& plane) {
    return hasFootNear (object, plane, lowest_plane_reach) && footIsHidden (object, plane) &&
           !wallsBehindOthers (object.points (), plane, wallStep (object), placesOf (object)).empty ();
  };
  const auto plane = std::find_if (planes.begin (), planes.end (), goes_down_behind_others);
  return plane == planes.end () ? resting : std::vector<Eigen::Vector4d>{*plane};
}

SymmetricExtent
CoSectionRun::extentOf (const Object& object, const std::optional<Eigen::Vector4d>& plane) const
{
  if (!plane)
    return SymmetricExtent (object.points (), nothingIsKnownAround ());
  const SymmetricExtent extent (object.points (), *plane);
  if (!(extent.wallThickness () > 0.0))
    return extent;
  const Eigen::Vector3d up = plane->head<3> ();
  const double near_m = object.voxel_size_m;
  const double floor_m = extent.wallThickness () + 2.0 * near_m;
  const auto is_at_floor = [&] (const Eigen::Vector3d& p, double reach_m) {
    return std::abs (up.dot (p) + (*plane)[3]) < reach_m && extent.depthInCavity (p + floor_m * up) > near_m;
  };
  const Eigen::Isometry3d T_object_world = firstPose (object).inverse ();
  const auto ground = std::count_if (
      scene_.background.begin (), scene_.background.end (),
      [&] (const OrientedPoint& p) { return is_at_floor (T_object_world * p.position.cast<double> (), near_m); });
  const auto floor = std::count_if (object.points ().begin (), object.points ().end (), [&] (const OrientedPoint& p) {
    return is_at_floor (p.position.cast<double> (), floor_m);
  });
  return ground >= least_ground && ground > floor ? extent.withoutFloor () : extent;
}

void
CoSectionRun::addPriors (Object& object)
{
  ShapeVolume& volume = object.volume ();
  const bool is_cut_out = scene_.background.empty ();
  std::vector<SymmetricExtent> standing;
  const std::vector<Eigen::Vector4d> resting = restingPlanes (object);
  for (const Eigen::Vector4d& plane : resting)
    standing.push_back (withHiddenWalls (object, extentOf (object, plane), plane));
  if (standing.empty ())
    standing.push_back (extentOf (object, std::nullopt));
  const bool has_profile = std::any_of (standing.begin (), standing.end (),
                                        [] (const SymmetricExtent& extent) { return extent.hasProfile (); });
  if (scene_.options.use_extent_prior && is_cut_out && !has_profile) // guesses are worth less
    volume.setRaysWithoutReturn (
        findRaysWithoutReturn (volume.grid (), viewsOf (object), object.points (), scene_.options.threads));
  if (scene_.options.use_contact_prior && !object.plane_is_guessed) // that ends where it was seen to
    for (std::size_t n = 0; n < resting.size (); ++n)
      volume.addContactPrior (object.points (), resting[n], standing[n].center ());
  if (!scene_.options.use_extent_prior)
    return;
  if (!scene_.options.use_symmetric_extent)
    standing.clear ();
  for (const SymmetricExtent& extent : standing)
    if (extent.copiesAreAlike ())
      volume.addHiddenSide (extent, object.points ());
  volume.addExtentPrior (is_cut_out ? ExtentPrior::cutOut () : ExtentPrior (), object.extents_m, object.body->hidden,
                         standing);
}

} // namespace pcl::cosection
