// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/surface/co_section.h>

#include "complete_scene.h"
#include "pcl_cosection/common/require.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include "pcl_cosection/volume/rigid_motion.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/volume/mesh_distance.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace pcl::cosection {

struct CoSection::Impl
{
  Scene scene;
  SceneState state; // between calls of update ()
};

namespace {

void
checkPoses (const std::vector<Eigen::Isometry3d>& poses)
{
  require (!poses.empty (), "a body needs a pose");
  require (std::all_of (poses.begin (), poses.end (), isRigidMotion),
           "the pose of a body is not a finite rigid motion");
}

/** \brief The points with unit normals, as normals are directions, of whatever length. \throws InvalidArgument if a
 * weight is no likelihood */
std::vector<OrientedPoint>
checkedPoints (std::vector<OrientedPoint> points)
{
  constexpr float rounding = 1e-3f; // what is a unit vector but for it stays as it is
  for (OrientedPoint& point : points)
  {
    require (point.weight >= 0.0f && point.weight <= 1.0f, "weight of a point", point.weight, "between 0 and 1");
    if (const float length = point.normal.stableNorm (); length > 0.0f && std::abs (length - 1.0f) > rounding)
      point.normal /= length;
  }
  return points;
}

Eigen::Isometry3d
unknownPose ()
{
  Eigen::Isometry3d pose;
  pose.matrix ().setConstant (std::numeric_limits<double>::quiet_NaN ());
  return pose;
}

} // namespace

CoSection::CoSection (const CoSectionOptions& options) : impl_ (new Impl)
{
  options.validate ();
  impl_->scene.options = options;
}

CoSection::~CoSection () = default;

CoSection::CoSection (CoSection&& other) noexcept : impl_ (std::exchange (other.impl_, std::make_unique<Impl> ())) {}

CoSection&
CoSection::operator= (CoSection&& other) noexcept
{
  std::swap (impl_, other.impl_);
  return *this;
}

int
CoSection::addView (DepthView view)
{
  return addView (std::move (view), {});
}

int
CoSection::addView (DepthView view, const std::map<int, Eigen::Isometry3d>& T_world_object, ViewUse use)
{
  view.validate ();
  for (const auto& [id, T] : T_world_object)
    if (T.matrix ().allFinite () && !isRigidMotion (T)) // one that is not finite is not known
      throw InvalidArgument ("the pose of object " + std::to_string (id) + " is not a rigid motion");
  const std::size_t before = impl_->scene.views.size ();
  for (const auto& [id, T] : T_world_object)
  {
    const bool at_rest = impl_->scene.find (id) != nullptr; // in all earlier views
    impl_->scene.poses[id].resize (before, at_rest ? Eigen::Isometry3d::Identity () : unknownPose ());
  }
  for (auto& [id, poses] : impl_->scene.poses)
  {
    const auto named = T_world_object.find (id);
    poses.push_back (named == T_world_object.end () ? unknownPose () : named->second);
    if (ObjectInput* object = impl_->scene.find (id))
      object->T_world_object = poses;
  }
  impl_->scene.views.push_back ({std::move (view), use});
  return static_cast<int> (before);
}

void
CoSection::removeViews (const std::vector<bool>& remove)
{
  if (remove.size () != impl_->scene.views.size ())
    throw InvalidArgument ("there are " + std::to_string (impl_->scene.views.size ()) + " views, not " +
                           std::to_string (remove.size ()));
  std::vector<int> number (remove.size ()); // new numbers of the remaining views
  for (std::size_t v = 0, next = 0; v < remove.size (); ++v)
    number[v] = remove[v] ? -1 : static_cast<int> (next++);
  const auto compact = [&] (auto& per_view) {
    const auto is_removed = [&] (const auto& of_view) {
      const auto v = static_cast<std::size_t> (&of_view - per_view.data ());
      return v < remove.size () && remove[v];
    };
    per_view.erase (std::remove_if (per_view.begin (), per_view.end (), is_removed), per_view.end ());
  };
  compact (impl_->scene.views);
  for (auto& [id, poses] : impl_->scene.poses)
    compact (poses);
  for (ObjectInput& object : impl_->scene.objects)
    compact (object.T_world_object);
  for (auto& [id, batches] : impl_->scene.batches)
  {
    std::vector<OrientedPoint>& points = id == 0 ? impl_->scene.background : impl_->scene.find (id)->points;
    std::vector<OrientedPoint> left;
    std::vector<PointBatch> left_batches;
    auto begin = points.begin ();
    for (const PointBatch& batch : batches)
    {
      const auto end = begin + static_cast<std::ptrdiff_t> (batch.count);
      if (batch.view < 0 || !remove[batch.view])
      {
        left.insert (left.end (), begin, end);
        left_batches.push_back ({batch.view < 0 ? -1 : number[batch.view], batch.count});
      }
      begin = end;
    }
    points = std::move (left);
    batches = std::move (left_batches);
  }
  for (auto& [id, body] : impl_->state.objects)
    body.readAgain ();
  impl_->state.background.readAgain ();
  impl_->state.blocks.readAgain ();
}

void
CoSection::removeObject (int id)
{
  if (const ObjectInput* object = impl_->scene.find (id)) // each is there once
    impl_->scene.objects.erase (impl_->scene.objects.begin () + (object - impl_->scene.objects.data ()));
  impl_->scene.poses.erase (id);
  impl_->state.objects.erase (id);
  if (id != 0)
    impl_->scene.batches.erase (id);
}

void
CoSection::setBackground (std::vector<OrientedPoint> points)
{
  impl_->scene.background = checkedPoints (std::move (points));
  impl_->scene.batches[0] = {{-1, impl_->scene.background.size ()}};
  impl_->state.background = {};
  impl_->state.blocks = {};
}

void
CoSection::addBackground (const std::vector<OrientedPoint>& points)
{
  const std::vector<OrientedPoint> checked = checkedPoints (points);
  impl_->scene.background.insert (impl_->scene.background.end (), checked.begin (), checked.end ());
  impl_->scene.countBatch (0, points.size ());
}

void
CoSection::addObject (ObjectInput object)
{
  if (object.id <= 0)
    throw InvalidArgument ("object id is " + std::to_string (object.id) + "; it must be positive");
  if (impl_->scene.find (object.id))
    throw InvalidArgument ("object " + std::to_string (object.id) + " was added twice");
  for (const TriangleMesh& proposal : object.proposals)
    requireSurface (proposal, "proposal");
  object.points = checkedPoints (std::move (object.points));
  impl_->scene.batches[object.id] = {{-1, object.points.size ()}};
  impl_->scene.objects.push_back (std::move (object));
}

void
CoSection::addPoints (int id, const std::vector<OrientedPoint>& points)
{
  const std::vector<OrientedPoint> checked = checkedPoints (points);
  ObjectInput* object = impl_->scene.find (id);
  if (!object)
  {
    ObjectInput fresh;
    fresh.id = id;
    const auto poses = impl_->scene.poses.find (id);
    if (poses != impl_->scene.poses.end ())
      fresh.T_world_object = poses->second;
    addObject (std::move (fresh));
    object = impl_->scene.find (id);
  }
  object->points.insert (object->points.end (), checked.begin (), checked.end ());
  impl_->scene.countBatch (id, points.size ());
}

void
CoSection::addSupportPlane (const Eigen::Vector4d& plane)
{
  const double norm = plane.head<3> ().stableNorm ();
  if (!(norm > 0.0) || !plane.allFinite ())
    throw InvalidArgument ("the coefficients of a plane must be finite and its normal not zero");
  impl_->scene.planes.push_back (plane / norm);
}

void
CoSection::addObstacle (SignedDistanceField::ConstPtr body, const std::vector<Eigen::Isometry3d>& T_body_world)
{
  require (body && body->values.size () == body->grid.size () &&
               (body->supported.empty () || body->supported.size () == body->grid.size ()),
           "a signed distance field must have one value per voxel");
  const VoxelGrid& grid = body->grid;
  require (grid.dims.minCoeff () > 0 && grid.voxel_size_m > 0.0 && std::isfinite (grid.voxel_size_m) &&
               grid.origin_m.allFinite (),
           "the grid of a signed distance field must have voxels, of positive size, at a finite place");
  checkPoses (T_body_world);
  impl_->scene.obstacles.push_back ({std::move (body), T_body_world});
}

void
CoSection::addObstacle (TriangleMesh body, const std::vector<Eigen::Isometry3d>& T_body_world)
{
  checkPoses (T_body_world);
  VoxelGrid somewhere;
  somewhere.dims.setConstant (2);
  somewhere.voxel_size_m = 1.0;
  sampleSignedDistance (body, somewhere, somewhere.voxel_size_m); // validates
  impl_->scene.mesh_obstacles.push_back ({std::move (body), T_body_world});
}

SceneResult
CoSection::reconstruct (const ProgressCallback& progress) const
{
  SceneState state;
  SceneResult result = completeScene (impl_->scene, CompletionMode::Once, UpdateOutput::Meshes, progress, state);
  SceneState without;
  for (const ObjectResult& object : result.objects)
    if (object.proposal && object.proposal->withdrawn)
      without.without_proposals.insert (object.id);
  if (without.without_proposals.empty ())
    return result;
  // Proposals that turned out worse had their part in grids and priors: without them, all is as if there were none.
  SceneResult again = completeScene (impl_->scene, CompletionMode::Once, UpdateOutput::Meshes, progress, without);
  for (std::size_t o = 0; o < again.objects.size (); ++o)
    if (without.without_proposals.count (again.objects[o].id))
      again.objects[o].proposal = result.objects[o].proposal;
  for (const auto& [stage, seconds] : result.timings_s)
    again.timings_s[stage] += seconds;
  return again;
}

SceneResult
CoSection::update (UpdateOutput output, const ProgressCallback& progress)
{
  return completeScene (impl_->scene, CompletionMode::Incremental, output, progress, impl_->state);
}

void
CoSection::forgetUpdates ()
{
  impl_->state = {};
}

} // namespace pcl::cosection
