// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_priors.h"

#include "contact_prior.h"
#include "extent_prior.h"
#include "hidden_side_term.h"
#include "hidden_walls.h"
#include "inferred_support_plane.h"
#include "pcl_cosection/volume/distance_transform.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr std::size_t most_points = 10000; // even subset of the points for inferring a plane
constexpr double along_axis = 0.9;         // cosine: a round object stands on a plane across its axis
// Heights of the lowest points over a plane, of the middle observed extent: the object rests on the plane ...
constexpr double resting_reach = 0.15;        // ... in any case
constexpr double hidden_foot_reach = 0.5;     // ... unless free space or another body was observed between them
constexpr double lowest_plane_reach = 2.0;    // ... if its walls continue down to the plane behind other things
constexpr double resting_share = 0.01;        // of the points: outliers among the lowest ones
constexpr std::ptrdiff_t least_ground = 20;   // background points seen in the cavity, which make a vessel a tube
constexpr double refuted_copies = 0.1;        // of the wall columns in free space: the other side is no copy
constexpr double refuted_outline = 0.5;       // of the wall columns in free space: there are no vertical walls
constexpr double beside_steps = 2.0;          // distance from the edge of a top
constexpr double same_resting_cosine = 0.995; // planes of two views on which the object rests in the same way

double
heightOver (const Eigen::Vector4d& plane, const Eigen::Vector3d& p)
{
  return plane.head<3> ().dot (p) + plane[3];
}

/** \brief Whether the lowest points are nearer to a plane than \a reach of the middle extent. */
bool
hasFootNear (const Observation& object, const Eigen::Vector4d& plane, double reach)
{
  const std::vector<OrientedPoint>& points = object.points ();
  const std::ptrdiff_t lower = std::count_if (points.begin (), points.end (), [&] (const OrientedPoint& p) {
    return heightOver (plane, p.position.cast<double> ()) < reach * object.extents_m[1];
  });
  return lower > static_cast<std::ptrdiff_t> (resting_share * static_cast<double> (points.size ()));
}

/** \brief The symmetric extent of the points; without floor if background was seen where a vessel would have its floor.
 */
SymmetricExtent
fitExtent (const Observation& object, const ObjectSetting& setting, const std::optional<Eigen::Vector4d>& plane)
{
  const Profiles profiles{setting.priors.revolution, setting.priors.vessels};
  if (!plane)
    return SymmetricExtent (object.points (), setting.is_alone, profiles);
  const SymmetricExtent extent (object.points (), *plane, profiles);
  if (!(extent.wallThickness () > 0.0))
    return extent;
  const Eigen::Vector3d up = plane->head<3> ();
  const double near_m = object.voxel_size_m;
  const double floor_m = extent.wallThickness () + 2.0 * near_m;
  const auto is_at_floor = [&] (const Eigen::Vector3d& p, double reach_m) {
    return std::abs (heightOver (*plane, p)) < reach_m && extent.depthInCavity (p + floor_m * up) > near_m;
  };
  const auto ground = std::count_if (setting.background.begin (), setting.background.end (),
                                     [&] (const OrientedPoint& p) {
                                       return is_at_floor (setting.T_object_world * p.position.cast<double> (), near_m);
                                     });
  const auto floor = std::count_if (object.points ().begin (), object.points ().end (), [&] (const OrientedPoint& p) {
    return is_at_floor (p.position.cast<double> (), floor_m);
  });
  return ground >= least_ground && ground > floor ? extent.withoutFloor () : extent;
}

const SymmetricExtent&
extentOf (const Observation& object, const ObjectSetting& setting, const std::optional<Eigen::Vector4d>& plane)
{
  const Eigen::Vector4d p = plane.value_or (Eigen::Vector4d::Zero ());
  const ShapeFits::key_type key = {p[0], p[1], p[2], p[3]};
  const auto found = object.fits->find (key);
  return found != object.fits->end () ? found->second
                                      : object.fits->emplace (key, fitExtent (object, setting, plane)).first->second;
}

UnseenPlaces
unseenPlaces (const ObjectSetting& setting, const BodyEnergy& energy)
{
  const auto is_free = [&energy] (const Eigen::Vector3d& p) {
    const auto at = energy.grid.nearest (p);
    return at && energy.free_space[energy.grid.index (at->x (), at->y (), at->z ())];
  };
  const auto is_behind_other = [&setting] (const Eigen::Vector3d& p) { return setting.hidden.isBehindOther (p); };
  return {is_free, setting.is_of_other, is_behind_other};
}

/** \brief Whether neither free space nor another body was observed between the foot of the axis on a plane and the
 * height of the lowest point. */
bool
footIsHidden (const Observation& object, const ObjectSetting& setting, const UnseenPlaces& places,
              const Eigen::Vector4d& plane, double step_m)
{
  const Eigen::Vector3d up = plane.head<3> ();
  double lowest_m = std::numeric_limits<double>::infinity ();
  for (const OrientedPoint& p : object.points ())
    lowest_m = std::min (lowest_m, up.dot (p.position.cast<double> ()) + plane[3]);
  Eigen::Vector3d foot = extentOf (object, setting, plane).center ();
  foot -= (up.dot (foot) + plane[3]) * up;
  for (double height_m = 0.0; height_m < lowest_m; height_m += step_m)
    if (places.isTaken (foot + height_m * up))
      return false;
  return true;
}

/** \brief The planes on which the object rests in some view. \param[in] step_m between points of walls */
std::vector<Eigen::Vector4d>
restingPlanes (const Observation& object, const ObjectSetting& setting, const UnseenPlaces& places,
               const std::vector<Eigen::Vector4d>& planes, const BodyEnergy& energy, double step_m)
{
  const auto foot_is_hidden = [&] (const Eigen::Vector4d& plane) {
    return energy.options.use_symmetric_extent &&
           footIsHidden (object, setting, places, plane, 0.5 * energy.grid.voxel_size_m);
  };
  std::vector<Eigen::Vector4d> resting;
  for (const Eigen::Vector4d& plane : planes)
  {
    const bool known = std::any_of (resting.begin (), resting.end (), [&] (const Eigen::Vector4d& other) {
      return plane.head<3> ().dot (other.head<3> ()) > same_resting_cosine;
    });
    if (known)
      continue;
    if (hasFootNear (object, plane, resting_reach) ||
        (hasFootNear (object, plane, hidden_foot_reach) && foot_is_hidden (plane)))
      resting.push_back (plane);
  }
  if (!resting.empty ())
    return resting;
  const auto goes_down_behind_others = [&] (const Eigen::Vector4d& plane) {
    return hasFootNear (object, plane, lowest_plane_reach) && foot_is_hidden (plane) &&
           !wallsBehindOthers (object.points (), plane, step_m, places).empty ();
  };
  const auto plane = std::find_if (planes.begin (), planes.end (), goes_down_behind_others);
  return plane == planes.end () ? resting : std::vector<Eigen::Vector4d>{*plane};
}

/** \brief The points of walls that observations do not refute; nothing if too many are refuted.
 * \param[in] of_copies walls around the points and their copies; otherwise around the points alone */
std::optional<std::vector<OrientedPoint>>
possibleWalls (const SymmetricExtent& extent, const UnseenPlaces& places, double step_m, bool of_copies)
{
  const auto is_any = [&] (const WallColumn& wall, const std::function<bool (const Eigen::Vector3d&)>& what) {
    return std::any_of (wall.begin (), wall.end (), [&] (const OrientedPoint& p) {
      return what (p.position.cast<double> () - step_m * p.normal.cast<double> ());
    });
  };
  const auto is_refuted = [&] (const WallColumn& wall) { return is_any (wall, places.is_free); };
  const auto is_of_other = [&] (const WallColumn& wall) { return is_any (wall, places.is_of_other); };
  std::vector<WallColumn> walls = extent.verticalWalls (step_m, of_copies);
  const auto end = std::remove_if (walls.begin (), walls.end (), is_refuted);
  if (static_cast<double> (walls.end () - end) >=
      (of_copies ? refuted_copies : refuted_outline) * static_cast<double> (walls.size ()))
    return std::nullopt;
  const auto kept = std::remove_if (walls.begin (), end, is_of_other);
  if (2 * (kept - walls.begin ()) < end - walls.begin ())
    return std::nullopt;
  std::vector<OrientedPoint> possible;
  std::for_each (walls.begin (), kept,
                 [&] (const WallColumn& wall) { possible.insert (possible.end (), wall.begin (), wall.end ()); });
  if (of_copies)
    return possible;
  // Where the outline is not convex, free space was seen beside its top.
  for (const WallColumn& wall : extent.wallsBelowEdges (step_m))
    if (!wall.empty () &&
        places.is_free (wall.back ().position.cast<double> () +
                        beside_steps * step_m * wall.back ().normal.cast<double> ()) &&
        !is_refuted (wall) && !is_of_other (wall))
      possible.insert (possible.end (), wall.begin (), wall.end ());
  return possible;
}

/** \brief The extent with its vertical walls; without vertical walls, with the walls that other things hide; nothing if
 * neither a profile, copies nor walls are wanted, or known. */
std::optional<SymmetricExtent>
withHiddenWalls (const Observation& object, const SymmetricExtent& extent, const UnseenPlaces& places,
                 const Eigen::Vector4d& plane, double step_m, const Priors& priors)
{
  if (extent.wallThickness () > 0.0) // a vessel's profile already extends down to its bottom
    return extent;
  const bool with_copies = priors.symmetry || extent.hasProfile ();
  for (const bool of_copies : {true, false})
    if (priors.walls && (with_copies || !of_copies))
      if (const auto walls = possibleWalls (extent, places, step_m, of_copies))
        return extent.boundedBy (*walls, !of_copies);
  if (!with_copies)
    return std::nullopt;
  if (!priors.walls)
    return extent;
  return extent.continuedBy (wallsBehindOthers (object.points (), plane, step_m, places));
}

/** \brief Mark voxels on rays without return as empty, for an object that was cut out of its scene. */
void
addRaysWithoutReturn (const Observation& object, BodyEnergy& energy)
{
  const std::vector<std::uint8_t> open = findRaysWithoutReturn (energy.grid, object.views, object.points (),
                                                                energy.options.threads);
  energy.empty = energy.free_space;
  for (std::size_t n = 0; n < open.size (); ++n)
    energy.empty[n] |= open[n] && !energy.data[n];
}

/** \brief Add the contact prior on a support plane. */
void
addContactPrior (const Observation& object, const Eigen::Vector4d& plane, const Eigen::Vector3d& center,
                 BodyEnergy& energy)
{
  const VoxelGrid& grid = energy.grid;
  const double beta = energy.options.beta_contact;
  if (beta <= 0.0)
    return;
  const std::vector<std::uint8_t> patch = contactPatch (grid, plane, object.points (), center, energy.empty);
  for (std::size_t n = 0; n < patch.size (); ++n)
  {
    if (!patch[n] || energy.data[n])
      continue;
    const auto i = static_cast<int> (n % grid.dims.x ());
    const auto j = static_cast<int> (n / grid.dims.x () % grid.dims.y ());
    const auto k = static_cast<int> (n / grid.dims.x () / grid.dims.y ());
    const double height_vox = heightOver (plane, grid.center (i, j, k)) / grid.voxel_size_m;
    energy.problem.weight[n] += static_cast<float> (beta);
    energy.problem.weighted_target[n] -= static_cast<float> (beta * height_vox);
  }
}

/** \brief Distance to data, to walls that are expected behind other things, and to the space they enclose; voxels. */
std::vector<float>
distanceToExpected (const BodyEnergy& energy, const std::vector<SymmetricExtent>& plausible)
{
  const VoxelGrid& grid = energy.grid;
  std::vector<std::uint8_t> expected;
  for (const SymmetricExtent& extent : plausible)
    for (const OrientedPoint& point : extent.continuation ())
    {
      // The wall, and the enclosed space from it to the level of the centre.
      const Eigen::Vector3d wall = point.position.cast<double> ();
      const Eigen::Vector3d outwards = point.normal.cast<double> ();
      const double middle_m = std::max (0.0, outwards.dot (wall - extent.center ()));
      for (double depth_m = 0.0; depth_m <= middle_m; depth_m += grid.voxel_size_m)
        if (const auto at = grid.nearest (wall - depth_m * outwards))
        {
          if (expected.empty ())
            expected = energy.data;
          expected[grid.index (at->x (), at->y (), at->z ())] = 1;
        }
    }
  return expected.empty () ? energy.data_distance_vox : distanceTransform (grid.dims, expected, energy.options.threads);
}

/** \brief Add the extent bound. */
void
addExtentPrior (const ExtentPrior& prior, const Observation& object, OcclusionMap& hidden,
                const std::vector<SymmetricExtent>& plausible, BodyEnergy& energy)
{
  const VoxelGrid& grid = energy.grid;
  const CoSectionOptions& options = energy.options;
  if (options.beta_extent <= 0.0)
    return;
  std::vector<LowerBound>& exterior = energy.problem.exterior;
  exterior.resize (grid.size ());
  std::vector<std::uint8_t> bounded (grid.size ());
  for (std::size_t n = 0; n < grid.size (); ++n)
    bounded[n] = static_cast<bool> (exterior[n]);
  std::vector<float> bounds = prior.bounds (grid, distanceToExpected (energy, plausible), object.extents_m, hidden,
                                            plausible, bounded, options.threads);
  if (energy.empty != energy.free_space)
  {
    // The bound on a ray without return is at most the distance to the nearest voxel that is not on such a ray.
    std::vector<std::uint8_t> closed (grid.size ());
    for (std::size_t n = 0; n < grid.size (); ++n)
      closed[n] = !energy.empty[n];
    const std::vector<float> depth_vox = distanceTransform (grid.dims, closed, options.threads);
    const auto side_vox = static_cast<float> (prior.side_factor * object.extents_m[1] / grid.voxel_size_m);
    for (std::size_t n = 0; n < grid.size (); ++n)
      if (!bounded[n] && energy.empty[n] && !energy.free_space[n])
        bounds[n] = std::max (bounds[n], std::min (energy.data_distance_vox[n] - side_vox, depth_vox[n]));
  }
  for (std::size_t n = 0; n < grid.size (); ++n)
    if (bounds[n] > 0.0f)
      exterior[n] = LowerBound (bounds[n], static_cast<float> (options.beta_extent));
}

} // namespace

double
wallThickness (const Observation& object, const ObjectSetting& setting, const std::vector<Eigen::Vector4d>& planes)
{
  std::optional<Eigen::Vector4d> nearest;
  double least_m = std::numeric_limits<double>::infinity ();
  for (const Eigen::Vector4d& plane : planes)
    if (const double height_m = heightOver (plane, object.box.center ());
        height_m < least_m && hasFootNear (object, plane, hidden_foot_reach))
    {
      least_m = height_m;
      nearest = plane;
    }
  return extentOf (object, setting, nearest).wallThickness ();
}

std::optional<Eigen::Vector4d>
inferSupportPlane (const Observation& object, const ObjectSetting& setting)
{
  const SymmetricExtent& extent = extentOf (object, setting, std::nullopt);
  if (extent.wallThickness () > 0.0)
    return std::nullopt;
  const std::vector<OrientedPoint>& all = object.points ();
  std::vector<OrientedPoint> points;
  for (std::size_t p = 0; p < all.size (); p += all.size () / most_points + 1)
    if (all[p].position.allFinite () && all[p].normal.allFinite ())
      points.push_back (all[p]);
  std::optional<Eigen::Vector4d> plane = inferredSupportPlane (points);
  if (plane || extent.isFaceted ()) // flat faces end at edges, so their ends show no contact
    return plane;
  plane = contactBoundaryPlane (points, object.views);
  if (const std::optional<Eigen::Vector3d> axis = extent.axisDirection ();
      plane && axis && std::abs (axis->dot (plane->head<3> ())) < along_axis)
    plane.reset ();
  return plane;
}

Eigen::AlignedBox3d
boxDownToPlanes (const Observation& object, const ObjectSetting& setting, const std::vector<Eigen::Vector4d>& planes)
{
  Eigen::AlignedBox3d box = object.box;
  for (const Eigen::Vector4d& plane : planes)
    if (hasFootNear (object, plane, lowest_plane_reach))
      for (int c = 0; c < 8; ++c)
      {
        const Eigen::Vector3d corner = object.box.corner (static_cast<Eigen::AlignedBox3d::CornerType> (c));
        const Eigen::Vector3d foot = corner - heightOver (plane, corner) * plane.head<3> ();
        if (setting.hidden.isBehindOther (foot))
          box.extend (foot);
      }
  return box;
}

void
addPriors (const Observation& object, const ObjectSetting& setting, const std::vector<Eigen::Vector4d>& planes,
           bool plane_is_inferred, OcclusionMap& hidden, BodyEnergy& energy)
{
  const CoSectionOptions& options = energy.options;
  if (!options.use_extent_prior && !options.use_contact_prior)
    return;
  const bool is_cut_out = setting.background.empty ();
  const UnseenPlaces places = unseenPlaces (setting, energy);
  const double step_m = std::max (energy.grid.voxel_size_m, object.spacing_m); // no denser than observed points
  const std::vector<Eigen::Vector4d> resting = restingPlanes (object, setting, places, planes, energy, step_m);
  std::vector<SymmetricExtent> standing; // one per plane, or one without a plane
  if (options.use_symmetric_extent)
  {
    for (const Eigen::Vector4d& plane : resting)
      if (auto extent = withHiddenWalls (object, extentOf (object, setting, plane), places, plane, step_m,
                                         setting.priors))
        standing.push_back (std::move (*extent));
    if (resting.empty ())
      if (const SymmetricExtent& extent = extentOf (object, setting, std::nullopt);
          setting.priors.symmetry || extent.hasProfile ())
        standing.push_back (extent);
  }
  const bool has_profile = std::any_of (standing.begin (), standing.end (),
                                        [] (const SymmetricExtent& extent) { return extent.hasProfile (); });
  if (setting.priors.rays && is_cut_out && !has_profile) // a profile is more reliable
    addRaysWithoutReturn (object, energy);
  if (setting.priors.contact && !plane_is_inferred) // observed points already end at an inferred plane
    for (std::size_t n = 0; n < resting.size (); ++n)
      addContactPrior (object, resting[n],
                       standing.size () < resting.size () ? object.box.center () : standing[n].center (), energy);
  if (!options.use_extent_prior)
    return;
  for (const SymmetricExtent& extent : standing)
    if (extent.copiesAreAlike ())
    {
      if (options.beta_extent > 0.0)
        addHiddenSide (energy, extent, object.points ());
      if (extent.wallThickness () > 0.0)
        energy.facing = NormalBinOccupancy (energy.grid, object.points ());
    }
  if (setting.priors.extent)
    addExtentPrior (is_cut_out ? ExtentPrior::cutOut () : ExtentPrior (), object, hidden, standing, energy);
}

} // namespace pcl::cosection
