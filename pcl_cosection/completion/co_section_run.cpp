// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "co_section_run.h"

#include "pcl_cosection/mesh/mesh_attributes.h"
#include "pcl_cosection/view/outliers/outlier_points.h"
#include "pcl_cosection/view/virtual_viewpoint.h"
#include "volume_layout.h"
#include "voxel_size.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pcl::cosection
{

namespace
{

constexpr double default_padding = 0.3; // of the longest side, where views and prior do not say how far a shape reaches
constexpr double same_pose_voxels = 0.5;
constexpr std::size_t bytes_per_field_voxel = sizeof (float) + sizeof (std::uint8_t);
constexpr double outlier_reach_voxels = 3.0; // of a point in the data term
constexpr double max_outlier_share = 0.2;    // more are no exception

} // namespace

CoSectionRun::CoSectionRun (const CoSection::Impl& scene, CoSectionMemory& memory, const ProgressCallback& progress,
                            Mode mode)
    : scene_ (scene)
    , memory_ (memory)
    , progress_ (progress)
    , mode_ (mode)
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
    const bool silent = std::none_of (view.depth.begin (), view.depth.end (),
                                      [] (float z) { return std::isfinite (z); });
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
  const std::size_t times = std::max<std::size_t> (
      1, std::max (of.input->T_world_object.size (), to ? to->input->T_world_object.size () : 0));
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
        throw DegenerateInput ("it has " + std::to_string (object.input->points.size ()) +
                               " points with a normal, at least " + std::to_string (scene_.options.min_points) +
                               " are needed");
      measure (object);
      leaveOutOutliers (object);
      warnIfFarApart (object);
      object.extents_m = observedExtents (object.points (), scene_.options.threads);
      warnIfCoarse (object);
      if (scene_.options.use_extent_prior && viewsOf (object).empty ())
        object.assumed = virtualViewpoint (object.points ());
      if (scene_.options.use_extent_prior)
        findHidden (object);
    });
}

void
CoSectionRun::measure (Object& object) const
{
  object.observed = observedBox (object.points (), scene_.options.threads);
  const PointSpacing spacing = measureSpacing (object.points (), object.observed);
  object.spacing_m = spacing.supported_m;
  object.voxel_size_m = objectVoxelSize (spacing, object.observed, scene_.options);
}

void
CoSectionRun::leaveOutOutliers (Object& object)
{
  const std::vector<OrientedPoint>& all = object.input->points;
  std::vector<bool> outlier = findOutlierPoints (
      all, object.observed.center (),
      outlier_reach_voxels * std::max (object.voxel_size_m, object.spacing_m)); // however fine the voxels
  auto outliers = static_cast<std::size_t> (std::count (outlier.begin (), outlier.end (), true));
  if (static_cast<double> (outliers) > max_outlier_share * static_cast<double> (all.size ()))
  {
    outliers = 0;
    outlier.assign (all.size (), false);
  }
  IncrementalState& body = *object.body;
  if (!std::equal (body.outlier.begin (), body.outlier.end (), outlier.begin ()))
    body.readPointsAgain ();
  body.outlier = std::move (outlier);
  if (outliers == 0)
    return;
  object.result->outlier_points = outliers;
  object.kept.reserve (all.size () - outliers);
  for (std::size_t p = 0; p < all.size (); ++p)
    if (!body.outlier[p])
      object.kept.push_back (all[p]);
  measure (object);
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
    const Eigen::Vector3d pad = Eigen::Vector3d::Constant (fraction * object.observed.sizes ().maxCoeff () +
                                                           2.0 * object.voxel_size_m);
    return {object.observed.min () - pad, object.observed.max () + pad};
  }
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t v = 0; v < std::max<std::size_t> (1, object.input->T_world_object.size ()); ++v)
    if (pose (object, v).matrix ().allFinite ())
      poses.push_back (pose (object, v));
  const std::vector<Eigen::Vector4d> planes = planesAt (object, object.planes, poses);
  return possibleBox (object.points (), object.observed, downToPlanesBehindOthers (object, planes), object.extents_m,
                      object.voxel_size_m, views, object.body->hidden, planes, options.threads);
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
    addPriors (object);
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
  markGuesses (object, object.result->mesh);
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

} // namespace pcl::cosection
