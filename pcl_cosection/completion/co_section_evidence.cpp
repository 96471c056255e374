// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "co_section_run.h"

#include "pcl_cosection/energy/data/measured_surface.h"
#include "pcl_cosection/view/outliers/point_groups.h"
#include "pcl_cosection/view/outliers/residual_clusters.h"
#include "volume_layout.h"
#include "voxel_size.h"

#include "pcl_cosection/energy/constraints/free_space_votes.h"
#include "pcl_cosection/priors/shape/symmetric_extent.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <map>
#include <optional>
#include <sstream>

// The part of a run that gives bodies their volumes and lets them read what was measured.

namespace pcl::cosection
{

namespace
{

constexpr double follow_tolerance = 0.5; // of that of the solver: what one update leaves, the next begins with
constexpr double
    max_change = 1.2; // of voxels and of their points' Gaussians, until a body that is followed gets others
constexpr int forgotten_after = 2;      // updates in which what was a vessel is none
constexpr int least_free_views = 2;     // that look through a point of the background, for it to have moved ...
constexpr double free_share = 0.25;     // ... and so many of those that see it there
constexpr double most_of_memory = 0.67; // is for objects, of what points and views leave; the rest for the background
constexpr double max_sigma_vox = 10.0;  // as for the option
constexpr double max_contradicted_share = 0.1; // of an object's points; good poses leave .03 or less
constexpr double least_spacings_across = 5.0;  // an object, along the middle of its extents: with fewer it is a lump
constexpr double residual_cell_m = 0.02;
constexpr double max_empty_share = 0.5; // of a volume that was large enough for what was known before

/** \brief Is what a body that is followed has near enough to what it should have? */
bool
isSimilar (double earlier, double wanted)
{
  return earlier > wanted / max_change && earlier < wanted * max_change;
}

} // namespace

const IncrementalState*
CoSectionRun::earlierBody (const IncrementalState& body, int id) const
{
  if (body.volume)
    return &body;
  const auto followed = scene_.memory.objects.find (id);
  const IncrementalState* earlier = id == 0                                    ? &scene_.memory.background
                                    : followed == scene_.memory.objects.end () ? nullptr
                                                                               : &followed->second;
  return earlier && earlier->volume ? earlier : nullptr;
}

double
CoSectionRun::wallThickness (const Object& object) const
{
  std::optional<Eigen::Vector4d> nearest;
  double least_m = std::numeric_limits<double>::infinity ();
  for (const Eigen::Vector4d& plane : planesAt (object, object.planes, {firstPose (object)}))
  {
    if (!mayRestOn (object, plane))
      continue;
    const double height_m = plane.head<3> ().dot (object.observed.center ()) + plane[3];
    if (height_m < least_m)
    {
      least_m = height_m;
      nearest = plane;
    }
  }
  return extentOf (object, nearest).wallThickness ();
}

double
CoSectionRun::gridVoxelSize (Object& object) const
{
  const CoSectionOptions& options = scene_.options;
  double voxel_size_m = object.voxel_size_m;
  if (!fixedVoxelSize (options) && options.use_extent_prior && options.use_symmetric_extent)
  {
    const IncrementalState* earlier = earlierBody (*object.body, object.input->id);
    const double earlier_m = earlier ? earlier->wall_m : 0.0;
    IncrementalState& body = *object.body;
    body.wall_m = wallThickness (object);
    body.updates_without_wall = body.wall_m > 0.0 ? 0 : body.updates_without_wall + 1;
    if (!(body.wall_m > 0.0) && body.updates_without_wall < forgotten_after) // it may be less plain for a while
      body.wall_m = earlier_m;
    if (body.wall_m > 0.0)
      voxel_size_m = std::min (voxel_size_m, vesselVoxelSize (object.spacing_m, body.wall_m, object.observed));
  }
  return voxel_size_m;
}

double
CoSectionRun::followedSize (const Object& object, double voxel_size_m) const
{
  const IncrementalState* earlier = earlierBody (*object.body, object.input->id);
  return earlier && isSimilar (earlier->grid ().voxel_size_m, voxel_size_m) ? earlier->grid ().voxel_size_m
                                                                            : voxel_size_m;
}

void
CoSectionRun::place (IncrementalState& body, int id, const Eigen::AlignedBox3d& box, double voxel_size_m, bool carve,
                     double blur)
{
  VoxelGrid grid = layoutBox (box, voxel_size_m);
  CoSectionOptions options = scene_.options;
  if (mode_ == Mode::Follow)
    options.solver.tolerance_vox *= follow_tolerance;
  options.sigma_vox = std::min (max_sigma_vox, blur * options.sigma_vox);
  const IncrementalState* earlier = earlierBody (body, id);
  if (earlier && earlier->grid ().voxel_size_m == voxel_size_m)
  {
    const double sigma_vox = earlier->volume->options ().sigma_vox;
    const bool same_blur = isSimilar (sigma_vox, options.sigma_vox);
    if (same_blur)
      options.sigma_vox = sigma_vox;
    // On its lattice; the same as long as it is large enough and not much too large.
    const Eigen::Vector3d first = earlier->grid ().toVoxel (box.min ()).array ().floor ();
    const Eigen::Vector3d last = earlier->grid ().toVoxel (box.max ()).array ().ceil ();
    if (body.volume && same_blur && (first.array () >= 0.0).all () &&
        (last.array () <= earlier->grid ().dims.cast<double> ().array () - 1.0).all () &&
        (last - first + Eigen::Vector3d::Ones ()).prod () >
            max_empty_share * static_cast<double> (earlier->grid ().size ()))
      return;
    grid.origin_m = earlier->grid ().origin_m + voxel_size_m * first;
    grid.dims = (last - first).cast<int> ().array () + 1;
  }
  checkMemory (grid, scene_.options.max_memory_bytes,
               bytesInUse () - (body.volume ? ShapeVolume::estimateBytes (body.grid ()) : 0));
  body.restart (grid, options, carve);
}

std::array<double, 3>
CoSectionRun::possibleVoxelSizes (Object& object) const
{
  const double fine_m = gridVoxelSize (object);
  if (fixedVoxelSize (scene_.options))
    return {fine_m, fine_m, fine_m};
  return {fine_m, std::max (fine_m, object.voxel_size_m), std::max (fine_m, object.spacing_m)};
}

void
CoSectionRun::createVolumes ()
{
  const bool carve = scene_.options.use_hull && scene_.options.carve_free_space && !scene_.views.empty ();
  struct Place
  {
    Eigen::AlignedBox3d box;
    std::array<double, 3> sizes_m; // from the finest to the coarsest
  };
  std::map<const Object*, Place> places;
  std::size_t volumes = 0;
  std::array<std::size_t, 3> bytes{};
  for (Object& object : objects_)
    if (object.alive ())
      guarded (object, [&] {
        Place& place = places[&object];
        place.box = volumeBox (object);
        place.sizes_m = possibleVoxelSizes (object);
        for (std::size_t n = 0; n < bytes.size (); ++n)
          bytes[n] += ShapeVolume::estimateBytes (layoutBox (place.box, place.sizes_m[n]));
        volumes += object.body->volume ? ShapeVolume::estimateBytes (object.body->grid ()) : 0;
      });
  // As fine as leaves room for all of them and the background: coarse meshes of all rather than fine ones of some.
  const std::size_t limit = scene_.options.max_memory_bytes, used = bytesInUse () - volumes;
  std::size_t level = 0;
  while (limit > 0 && level + 1 < bytes.size () &&
         static_cast<double> (used) + static_cast<double> (bytes[level]) / most_of_memory > static_cast<double> (limit))
    ++level;
  for (Object& object : objects_)
    if (object.alive ())
      guarded (object, [&] {
        const Place& place_of = places.at (&object);
        const double voxel_size_m = followedSize (object, place_of.sizes_m[level]);
        const double smooth_m = object.body->wall_m > 0.0 && !fixedVoxelSize (scene_.options) ? object.spacing_m
                                                                                              : object.voxel_size_m;
        place (*object.body, object.input->id, place_of.box, voxel_size_m, carve,
               std::max (1.0, smooth_m / voxel_size_m));
      });
}

void
CoSectionRun::readPoints (Object& object)
{
  IncrementalState& body = *object.body;
  const std::vector<OrientedPoint>& all = object.input->points;
  std::vector<OrientedPoint> fresh;
  fresh.reserve (all.size () - body.points_read);
  for (std::size_t p = body.points_read; p < all.size (); ++p)
    if (!body.outlier[p])
      fresh.push_back (all[p]);
  if (!fresh.empty ())
    body.evidence->addPoints (fresh);
  body.points_read = all.size ();
}

void
CoSectionRun::findPointsOf (const Object& object, std::vector<bool>& found) const
{
  const auto batches = scene_.batches.find (0);
  if (!object.alive () || batches == scene_.batches.end ())
    return;
  const MeasuredSurface surface (object.points (), object.voxel_size_m);
  const std::size_t first_view = firstView (object);
  std::size_t begin = 0;
  for (const PointBatch& batch : batches->second)
  {
    const std::size_t end = begin + batch.count;
    const bool was_known = batch.view >= static_cast<int> (first_view);
    const Eigen::Isometry3d T_world_object = pose (object,
                                                   was_known ? static_cast<std::size_t> (batch.view) : first_view);
    const double depth_vox = was_known ? MeasuredSurface::voxels_beside
                                       : MeasuredSurface::voxels_deep; // it may not have been quite at rest
    if (T_world_object.matrix ().allFinite ())
    {
      const Eigen::Isometry3f T = T_world_object.inverse ().cast<float> ();
      for (std::size_t n = begin; n < end; ++n)
        found[n] = found[n] ||
                   surface.has ({T * scene_.background[n].position, T.linear () * scene_.background[n].normal},
                                depth_vox);
    }
    begin = end;
  }
}

std::vector<OrientedPoint>
CoSectionRun::backgroundAtRest () const
{
  std::vector<FreeSpaceView> views;
  for (const SceneView& view : scene_.views)
    if (view.use != ViewUse::FreeSpace)
      views.emplace_back (view.depth);
  std::vector<Eigen::Vector3f> positions (scene_.background.size ());
  std::transform (scene_.background.begin (), scene_.background.end (), positions.begin (),
                  [] (const OrientedPoint& point) { return point.position; });
  const std::vector<FreeSpaceVotes> votes = voteOnPoints (positions, views, 0.0, scene_.options.threads);
  std::vector<bool> moved (votes.size ());
  for (std::size_t n = 0; n < votes.size (); ++n)
    moved[n] = votes[n].free >= least_free_views && votes[n].free >= free_share * votes[n].surface;
  for (const Object& object : objects_)
    findPointsOf (object, moved);
  addResidualClusters (scene_.background, residual_cell_m, moved);
  std::vector<OrientedPoint> at_rest;
  for (std::size_t n = 0; n < moved.size (); ++n)
    if (!moved[n])
      at_rest.push_back (scene_.background[n]);
  return at_rest;
}

void
CoSectionRun::gatherEvidence ()
{
  timed ("data_term", [&] {
    for (Object& object : objects_)
      if (object.alive ())
        guarded (object, [&] { readPoints (object); });
    std::vector<OrientedPoint> at_rest;
    const bool all = !scene_.options.leave_out_moved || mode_ == Mode::Follow;
    if (!all)
      at_rest = backgroundAtRest ();
    for (IncrementalState* body : backgroundBodies ())
    {
      if (all)
        body->evidence->addPoints (
            {scene_.background.begin () + static_cast<std::ptrdiff_t> (body->points_read), scene_.background.end ()});
      else
        body->evidence->addPoints (at_rest);
      body->points_read = scene_.background.size ();
    }
  });
  timed ("constraints", [&] {
    if (mode_ == Mode::Once && scene_.options.use_hull)
      for (Object& object : objects_)
        if (object.alive ())
          object.agreement.emplace (object.points ());
    for (std::size_t v = 0; v < scene_.views.size (); ++v)
    {
      const DepthView& depth = scene_.views[v].depth;
      std::optional<FreeSpaceView> view; // prepared once, for the first that asks
      const auto show = [&] (IncrementalState& body, ViewAgreement* agreement, const Eigen::Isometry3d& T_body_sensor) {
        if (body.views_read > v)
          return;
        body.views_read = v + 1;
        if (!T_body_sensor.matrix ().allFinite ())
          return;
        if (!view)
          view.emplace (depth);
        body.evidence->addView (*view, T_body_sensor, scene_.views[v].use == ViewUse::Full);
        if (agreement)
          agreement->add (static_cast<int> (v), *view, T_body_sensor, scene_.options.threads);
      };
      for (IncrementalState* body : backgroundBodies ())
        if (scene_.views[v].use != ViewUse::FreeSpace)
          show (*body, nullptr, depth.T_world_sensor);
      for (Object& object : objects_)
        if (object.alive () && scene_.options.use_hull)
          guarded (object, [&] {
            show (*object.body, object.agreement ? &*object.agreement : nullptr,
                  pose (object, v).inverse () * depth.T_world_sensor);
          });
      report ("free space", 0.05 * static_cast<double> (v + 1) / static_cast<double> (scene_.views.size ()));
    }
    for (Object& object : objects_)
      if (object.alive () && object.agreement)
        judgeAgreement (object);
  });
}

void
CoSectionRun::warnIfFarApart (const Object& object)
{
  const double gap_m = gapBetweenGroups (object.points (), object.observed);
  if (gap_m > 0.0)
    result_.warnings.push_back ("object " + std::to_string (object.input->id) + ": its points lie in groups " +
                                std::to_string (std::lround (100.0 * gap_m)) +
                                " cm apart, each smaller than that: a pose may be wrong, or two things have one label");
}

std::string
CoSectionRun::nameOf (std::size_t view) const
{
  const std::string& name = scene_.views[view].depth.name;
  return name.empty () ? "view " + std::to_string (view) : name;
}

void
CoSectionRun::warnIfCoarse (const Object& object)
{
  const double h = object.spacing_m;
  if (mode_ != Mode::Once || fixedVoxelSize (scene_.options) || object.extents_m[1] > least_spacings_across * h)
    return;
  std::ostringstream text;
  text << std::fixed << std::setprecision (1);
  text << "object " << object.input->id << ": its points are so far apart that what is finer than " << 1e3 * h
       << " mm cannot be told, and it is only " << 1e3 * object.extents_m[1]
       << " mm across (points nearer together tell more)";
  result_.warnings.push_back (text.str ());
}

void
CoSectionRun::judgeAgreement (Object& object)
{
  const auto [share, view] = object.agreement->worst ();
  object.result->contradicted_share = share;
  if (share > max_contradicted_share)
    result_.warnings.push_back ("object " + std::to_string (object.input->id) + ": " +
                                nameOf (static_cast<std::size_t> (view)) + " looks through " +
                                std::to_string (std::lround (100.0 * share)) +
                                " % of its points there: a pose may be wrong, or it has moved");
  object.agreement.reset ();
}

} // namespace pcl::cosection
