// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "co_section_run.h"

#include "assumed_view.h"
#include "mesh_attributes.h"
#include "stray_points.h"
#include "volume_layout.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr double default_padding = 0.3; // of the longest side, where views and prior do not say how far a shape reaches
constexpr double same_pose_voxels = 0.5;
constexpr std::size_t bytes_per_field_voxel = sizeof (float) + sizeof (std::uint8_t);
constexpr double stray_reach_voxels = 3.0; // of a point in the data term
constexpr double max_stray_share = 0.2;    // more are no exception
constexpr double resting_reach = 0.15;     // of the middle observed extent: what is as low over a plane rests on it
constexpr double hidden_foot_reach = 0.5;  // of the middle observed extent: what is as low rests on it, if that may be
constexpr double resting_share = 0.01;     // of the points, which may be lower
constexpr std::ptrdiff_t least_ground = 20; // points of the background, seen through what would be a vessel else
constexpr double same_resting_cosine = 0.995; // planes of two views on which it rests the same way

} // namespace

CoSectionRun::CoSectionRun (const CoSection::Impl& scene, CoSectionMemory& memory, const ProgressCallback& progress,
                            Mode mode)
: scene_ (scene), memory_ (memory), progress_ (progress), mode_ (mode)
{}

void
CoSectionRun::report (const std::string& stage, double fraction) const
{
  if (progress_ && !progress_ (stage, std::min (1.0, fraction)))
    throw Cancelled ("cancelled");
}

Eigen::Isometry3d
CoSectionRun::pose (const Object& object, std::size_t view) const
{
  const auto& poses = object.input->T_world_object;
  return poses.empty () ? Eigen::Isometry3d::Identity () : poses[std::min (view, poses.size () - 1)];
}

Eigen::Isometry3d
CoSectionRun::firstPose (const Object& object) const
{
  return pose (object, firstView (object));
}

std::size_t
CoSectionRun::firstView (const Object& object) const
{
  const std::size_t poses = object.input->T_world_object.size ();
  std::size_t view = 0;
  while (view + 1 < poses && !pose (object, view).matrix ().allFinite ())
    ++view;
  return view;
}

std::vector<std::pair<const DepthView*, Eigen::Isometry3d>>
CoSectionRun::viewsOf (const Object& object) const
{
  std::vector<std::pair<const DepthView*, Eigen::Isometry3d>> views;
  for (std::size_t v = 0; v < scene_.views.size (); ++v)
  {
    if (scene_.views[v].use == ViewUse::FreeSpace)
      continue;
    const DepthView& view = scene_.views[v].depth;
    const Eigen::Isometry3d T_object_sensor = pose (object, v).inverse () * view.T_world_sensor;
    const bool silent = std::none_of (view.depth.begin (), view.depth.end (), [] (float z) { return std::isfinite (z); });
    if (T_object_sensor.matrix ().allFinite () && !silent)
      views.emplace_back (&view, T_object_sensor);
  }
  if (views.empty () && object.assumed)
    views.emplace_back (&*object.assumed, object.assumed->T_world_sensor);
  return views;
}

std::vector<Eigen::Isometry3d>
CoSectionRun::relativePoses (const Object& of, const Object* to) const
{
  const std::size_t times =
      std::max<std::size_t> (1, std::max (of.input->T_world_object.size (), to ? to->input->T_world_object.size () : 0));
  const std::vector<Eigen::Vector3d> probes = corners (boxOf (of.volume ().grid ()));
  const double same = same_pose_voxels * of.volume ().grid ().voxel_size_m;
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t t = 0; t < times; ++t)
  {
    const Eigen::Isometry3d T = (to ? pose (*to, t).inverse () : Eigen::Isometry3d::Identity ()) * pose (of, t);
    if (!T.matrix ().allFinite ())
      continue;
    const auto moved = [&] (const Eigen::Isometry3d& other) {
      return std::any_of (probes.begin (), probes.end (),
                          [&] (const Eigen::Vector3d& p) { return (T * p - other * p).norm () > same; });
    };
    if (std::all_of (poses.begin (), poses.end (), moved))
      poses.push_back (T);
  }
  return poses;
}

void
CoSectionRun::observeObjects ()
{
  result_.objects.resize (scene_.objects.size ());
  objects_.resize (scene_.objects.size ());
  for (std::size_t i = 0; i < objects_.size (); ++i)
  {
    Object& object = objects_[i];
    object.input = &scene_.objects[i];
    object.result = &result_.objects[i];
    object.result->id = object.input->id;
    object.body = &memory_.objects[object.input->id];
  }
  for (Object& object : objects_)
    guarded (object, [&] {
      if (!object.input->T_world_object.empty () && object.input->T_world_object.size () != scene_.views.size ())
        throw InvalidArgument ("there are " + std::to_string (object.input->T_world_object.size ()) + " poses for " +
                               std::to_string (scene_.views.size ()) + " views");
      if (!firstPose (object).matrix ().allFinite ())
        throw InvalidArgument ("none of its poses is known");
      if (object.input->points.size () < scene_.options.min_points)
        throw DegenerateInput ("it has " + std::to_string (object.input->points.size ()) + " points with a normal, at least " +
                               std::to_string (scene_.options.min_points) + " are needed");
      object.observed = observedBox (object.points (), scene_.options.threads);
      object.voxel_size_m = objectVoxelSize (object.points (), object.observed, scene_.options);
      leaveOutStrays (object);
      warnIfFarApart (object);
      object.extents_m = observedExtents (object.points (), scene_.options.threads);
      if (scene_.options.use_extent_prior && viewsOf (object).empty ())
        object.assumed = assumeView (object.points ());
      if (scene_.options.use_extent_prior)
        findHidden (object);
    });
}

void
CoSectionRun::leaveOutStrays (Object& object)
{
  const std::vector<OrientedPoint>& all = object.input->points;
  // No nearer than the points' own spacing allows, however fine the voxels.
  const double spacing_m = supportedVoxelSize (all, object.observed);
  std::vector<bool> stray = findStrayPoints (all, object.observed.center (),
                                             stray_reach_voxels * std::max (object.voxel_size_m, spacing_m));
  auto strays = static_cast<std::size_t> (std::count (stray.begin (), stray.end (), true));
  if (static_cast<double> (strays) > max_stray_share * static_cast<double> (all.size ()))
  {
    strays = 0;
    stray.assign (all.size (), false);
  }
  FollowedBody& body = *object.body;
  if (!std::equal (body.stray.begin (), body.stray.end (), stray.begin ()))
    body.readPointsAgain ();
  body.stray = std::move (stray);
  if (strays == 0)
    return;
  object.result->stray_points = strays;
  object.kept.reserve (all.size () - strays);
  for (std::size_t p = 0; p < all.size (); ++p)
    if (!body.stray[p])
      object.kept.push_back (all[p]);
  object.observed = observedBox (object.points (), scene_.options.threads);
  object.voxel_size_m = objectVoxelSize (object.points (), object.observed, scene_.options);
}

void
CoSectionRun::findHidden (Object& object) const
{
  if (object.assumed) // of all points: another one each time
    object.body->hidden.clear ();
  object.body->hidden.add (viewsOf (object), object.points (), scene_.options.threads);
}

Eigen::AlignedBox3d
CoSectionRun::volumeBox (const Object& object) const
{
  const CoSectionOptions& options = scene_.options;
  const auto views = viewsOf (object);
  if (options.padding > 0.0 || !options.use_extent_prior || !options.use_hull || views.empty ())
  {
    const double fraction = options.padding > 0.0 ? options.padding : default_padding;
    const Eigen::Vector3d pad =
        Eigen::Vector3d::Constant (fraction * object.observed.sizes ().maxCoeff () + 2.0 * object.voxel_size_m);
    return {object.observed.min () - pad, object.observed.max () + pad};
  }
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t v = 0; v < std::max<std::size_t> (1, object.input->T_world_object.size ()); ++v)
    if (pose (object, v).matrix ().allFinite ())
      poses.push_back (pose (object, v));
  const std::vector<Eigen::Vector4d> planes = planesAt (object, object.planes, poses);
  return possibleBox (object.points (), object.observed, object.extents_m, object.voxel_size_m, views, object.body->hidden,
                      planes, options.threads);
}

std::size_t
CoSectionRun::bytesInUse () const
{
  std::size_t points = scene_.background.size ();
  std::size_t bytes = 0;
  for (const Object& object : objects_)
  {
    points += object.input->points.size () + object.kept.size ();
    if (object.body->volume)
      bytes += ShapeVolume::estimateBytes (object.body->grid ());
    bytes += object.body->hidden.bytes ();
  }
  for (const SignedDistanceField::ConstPtr& field : background_)
    bytes += field->grid.size () * bytes_per_field_voxel;
  for (const Obstacle& body : bodies_)
    bytes += body.field->grid.size () * bytes_per_field_voxel;
  std::size_t largest_view = 0;
  for (const SceneView& view : scene_.views)
  {
    bytes += view.depth.depth.size () * sizeof (float);
    largest_view = std::max (largest_view, view.depth.depth.size ());
  }
  bytes += largest_view * FreeSpaceView::bytes_per_pixel;
  if (memory_.background.volume)
    bytes += ShapeVolume::estimateBytes (memory_.background.grid ());
  return bytes + points * sizeof (OrientedPoint);
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
  const VoxelGrid& grid = object.body->grid ();
  for (double height_m = 0.0; height_m < lowest_m; height_m += 0.5 * grid.voxel_size_m)
  {
    const Eigen::Vector3d p = foot + height_m * up;
    const auto at = grid.nearest (p);
    if (at && object.body->volume->freeSpace ()[grid.index (at->x (), at->y (), at->z ())])
      return false;
    for (const Object& other : objects_)
      if (&other != &object && other.alive ())
        for (const Eigen::Isometry3d& T_other_object : relativePoses (object, &other))
          if (other.observed.contains (T_other_object * p))
            return false;
  }
  return true;
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

bool
CoSectionRun::mayRestOn (const Object& object, const Eigen::Vector4d& plane) const
{
  return hasFootNear (object, plane, hidden_foot_reach);
}

std::vector<Eigen::Vector4d>
CoSectionRun::restingPlanes (const Object& object) const
{
  std::vector<Eigen::Vector4d> resting;
  for (const Eigen::Vector4d& plane : planesAt (object, object.planes, relativePoses (object, nullptr)))
  {
    const bool known = std::any_of (resting.begin (), resting.end (), [&] (const Eigen::Vector4d& other) {
      return plane.head<3> ().dot (other.head<3> ()) > same_resting_cosine;
    });
    if (known)
      continue;
    if (hasFootNear (object, plane, resting_reach) || (mayRestOn (object, plane) && footIsHidden (object, plane)))
      resting.push_back (plane);
  }
  return resting;
}

SymmetricExtent
CoSectionRun::extentOf (const Object& object, const std::optional<Eigen::Vector4d>& plane) const
{
  if (!plane)
    return SymmetricExtent (object.points ());
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
  const auto ground = std::count_if (scene_.background.begin (), scene_.background.end (), [&] (const OrientedPoint& p) {
    return is_at_floor (T_object_world * p.position.cast<double> (), near_m);
  });
  const auto floor = std::count_if (object.points ().begin (), object.points ().end (),
                                    [&] (const OrientedPoint& p) { return is_at_floor (p.position.cast<double> (), floor_m); });
  return ground >= least_ground && ground > floor ? extent.withoutFloor () : extent;
}

void
CoSectionRun::prepareObject (Object& object)
{
  ShapeVolume& volume = object.volume ();
  timed ("constraints", [&] {
    volume.prepare (*object.body->evidence);
    if (mode_ == Mode::Once)
      object.body->evidence.reset ();
    if (!volume.hasData ())
      throw DegenerateInput ("no usable measurements: all of its points lie in space that was seen free");
    std::vector<SymmetricExtent> standing;
    const std::vector<Eigen::Vector4d> resting = restingPlanes (object);
    for (const Eigen::Vector4d& plane : resting)
      standing.push_back (extentOf (object, plane));
    if (scene_.options.use_contact_prior)
      for (std::size_t n = 0; n < resting.size (); ++n)
        volume.addContactPrior (object.points (), resting[n], standing[n].center ());
    if (standing.empty ())
      standing.push_back (extentOf (object, std::nullopt));
    if (!scene_.options.use_symmetric_extent)
      standing.clear ();
    if (scene_.options.use_extent_prior)
      for (const SymmetricExtent& extent : standing)
        if (extent.copiesAreAlike ())
          volume.addHiddenSide (extent, object.points ());
    if (scene_.options.use_extent_prior)
      volume.addExtentPrior (scene_.background.empty () ? ExtentPrior::cutOut () : ExtentPrior (), object.extents_m,
                             object.body->hidden, standing);
    if (mode_ == Mode::Once || object.assumed)
      object.body->hidden.clear ();
  });
  object.told = volume.measuredField ();
}

void
CoSectionRun::finishObject (Object& object, UpdateOutput output)
{
  object.field = object.volume ().solvedField ();
  object.result->signed_distance = std::make_shared<SignedDistanceField> (object.field);
  if (output == UpdateOutput::Fields)
    return;
  object.result->mesh = object.volume ().closedMesh ();
  if (object.result->mesh.empty ())
    throw DegenerateInput ("its measurements determine no closed surface, or lie inside another body");
  transferAttributes (object.points (), object.volume ().grid (), object.result->mesh);
  if (scene_.options.compute_bounds)
    object.result->inner_bound = object.volume ().innerMesh (object.points ());
}

SceneResult
CoSectionRun::run (UpdateOutput output)
{
  report ("measurements", 0.0);
  bodies_ = scene_.bodies;
  timed ("data_term", [&] { observeObjects (); });
  timed ("constraints", [&] {
    findPlanes ();
    createVolumes ();
    sampleMeshes ();
    createBackground ();
  });
  gatherEvidence ();
  solveBackground (output);
  for (Object& object : objects_)
    if (object.alive ())
      guarded (object, [&] { prepareObject (object); });
  solveObjects ();
  timed ("mesh", [&] {
    for (Object& object : objects_)
      if (object.alive ())
        guarded (object, [&] { finishObject (object, output); });
    if (output == UpdateOutput::Meshes && (scene_.options.compute_hull || scene_.options.compute_bounds))
      findHulls ();
    for (Object& object : objects_)
      if (object.alive () && scene_.options.use_intersection)
        guarded (object, [&] { object.result->penetration_m = penetration (object); });
  });
  report ("done", 1.0);
  return std::move (result_);
}

} // namespace cosection
} // namespace pcl
