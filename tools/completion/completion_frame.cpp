// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion_frame.h"

#include "pcl_cosection/mesh/moved_mesh.h"

#include <limits>
#include <memory>
#include <optional>
#include <utility>

using namespace pcl::cosection;

namespace {

Eigen::Vector4d
turned (const Eigen::Quaterniond& R, const Eigen::Vector4d& plane)
{
  const Eigen::Vector3d normal = R * plane.head<3> ();
  return {normal.x (), normal.y (), normal.z (), plane[3]};
}

/** \brief On voxels of the same size along the turned axes. Where these reach beyond the field, its nearest value and
 * the distance from there. */
SignedDistanceField
turned (const Eigen::Quaterniond& R, const SignedDistanceField& field)
{
  const VoxelGrid& from = field.grid;
  const Eigen::Vector3d last = from.dims.cast<double> () - Eigen::Vector3d::Ones ();
  Eigen::AlignedBox3d box;
  for (int corner = 0; corner < 8; ++corner)
    box.extend (R * (from.origin_m + from.voxel_size_m * Eigen::Vector3d (corner & 1 ? last.x () : 0.0,
                                                                          corner & 2 ? last.y () : 0.0,
                                                                          corner & 4 ? last.z () : 0.0)));
  SignedDistanceField to;
  to.grid.voxel_size_m = from.voxel_size_m;
  to.grid.origin_m = box.min ();
  to.grid.dims = (box.sizes () / from.voxel_size_m).array ().ceil ().cast<int> () + 1;
  to.values.resize (to.grid.size ());
  to.supported.resize (field.supported.empty () ? 0 : to.grid.size ());
  for (int k = 0; k < to.grid.dims.z (); ++k)
    for (int j = 0; j < to.grid.dims.y (); ++j)
      for (int i = 0; i < to.grid.dims.x (); ++i)
      {
        const Eigen::Vector3d place = from.toVoxel (R.conjugate () * to.grid.center (i, j, k));
        const Eigen::Vector3d inside = place.cwiseMax (0.0).cwiseMin (last);
        const double beyond_m = from.voxel_size_m * (place - inside).norm ();
        const std::size_t n = to.grid.index (i, j, k);
        to.values[n] = field.sampleVoxel (inside).value_or (std::numeric_limits<float>::quiet_NaN ()) +
                       static_cast<float> (beyond_m);
        if (const Eigen::Vector3i nearest = (inside.array () + 0.5).cast<int> (); !to.supported.empty ())
          to.supported[n] = beyond_m > 0.0 ? 0 : field.supported[from.index (nearest.x (), nearest.y (), nearest.z ())];
      }
  return to;
}

void
turnObject (const Eigen::Quaterniond& R, ObjectResult& object)
{
  for (TriangleMesh* mesh : {&object.mesh, &object.hull, &object.inner_bound, &object.outer_bound})
    *mesh = movedMesh (std::move (*mesh), Eigen::Isometry3d (R));
  for (std::optional<ProposalFit>* fit : {&object.proposal, &object.learned})
    if (*fit)
      (*fit)->T_object_proposal = R * (*fit)->T_object_proposal;
  if (object.signed_distance)
    object.signed_distance = std::make_shared<SignedDistanceField> (turned (R, *object.signed_distance));
}

} // namespace

Eigen::Quaterniond
completionFrame (const SceneInput& scene)
{
  return scene.views.empty () ? Eigen::Quaterniond::Identity ()
                              : Eigen::Quaterniond (scene.views.front ().T_world_sensor.linear ());
}

void
turnInput (const Eigen::Quaterniond& R_frame_world, SceneInput& scene)
{
  const Eigen::Isometry3d T_frame_world (R_frame_world);
  for (auto& [label, object] : scene.objects)
  {
    if (object.T_world_object.empty ())
      transform (T_frame_world, object.points);
    for (Eigen::Isometry3d& pose : object.T_world_object)
      pose = T_frame_world * pose;
  }
  transform (T_frame_world, scene.background);
  for (std::vector<DepthView>* views : {&scene.views, &scene.free_space})
    for (DepthView& view : *views)
      view.T_world_sensor = T_frame_world * view.T_world_sensor;
  for (TriangleMesh& obstacle : scene.obstacles)
    obstacle = movedMesh (std::move (obstacle), T_frame_world);
  for (Eigen::Vector4d& plane : scene.planes)
    plane = turned (R_frame_world, plane);
}

void
turnResult (const Eigen::Quaterniond& R_world_frame, const Settings& settings, SceneResult& result)
{
  for (ObjectResult& object : result.objects)
  {
    if (settings.object_trajectories.count (object.id) == 0)
      turnObject (R_world_frame, object);
    if (object.guessed_plane)
      object.guessed_plane = turned (R_world_frame, *object.guessed_plane);
  }
  result.background = movedMesh (std::move (result.background), Eigen::Isometry3d (R_world_frame));
  result.background_pieces.clear ();
  for (Eigen::Vector4d& plane : result.planes)
    plane = turned (R_world_frame, plane);
}
