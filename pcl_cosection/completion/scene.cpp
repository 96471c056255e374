// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene.h"

#include "pcl_cosection/common/boxes.h"

#include <algorithm>

namespace pcl::cosection {

ObjectInput*
Scene::find (int id)
{
  const auto found = std::find_if (objects.begin (), objects.end (),
                                   [id] (const ObjectInput& object) { return object.id == id; });
  return found == objects.end () ? nullptr : &*found;
}

void
BodyState::restart (const VoxelGrid& new_grid, const CoSectionOptions& new_options, bool carve)
{
  const bool same_lattice = grid && grid->voxel_size_m == new_grid.voxel_size_m;
  solution = same_lattice ? startFrom (solution, *grid, new_grid) : BodySolution ();
  grid = new_grid;
  options = new_options;
  evidence = std::make_unique<ShapeEvidence> (new_grid, new_options, carve);
  points_read = 0;
  views_read = 0;
}

void
BodyState::readAgain ()
{
  if (grid)
    restart (VoxelGrid (*grid), CoSectionOptions (options), evidence && evidence->carves ());
  outliers.clear ();
  wall_m = 0.0;
}

void
BodyState::readPointsAgain ()
{
  if (evidence)
    evidence->clearPoints ();
  points_read = 0;
}

void
BackgroundBlocks::readAgain ()
{
  for (auto& [place, block] : blocks)
  {
    block.body.evidence.reset ();
    block.body.views_read = 0;
    block.body.points_read = 0;
    block.is_current = false;
  }
}

Eigen::Isometry3d
poseAt (const ObjectInput& object, std::size_t view)
{
  const auto& poses = object.T_world_object;
  return poses.empty () ? Eigen::Isometry3d::Identity () : poses[std::min (view, poses.size () - 1)];
}

std::size_t
firstView (const ObjectInput& object)
{
  const std::size_t poses = object.T_world_object.size ();
  std::size_t view = 0;
  while (view + 1 < poses && !poseAt (object, view).matrix ().allFinite ())
    ++view;
  return view;
}

Eigen::Isometry3d
firstPose (const ObjectInput& object)
{
  return poseAt (object, firstView (object));
}

std::vector<Eigen::Isometry3d>
relativePoses (const ObjectInput& of, const VoxelGrid& grid, const ObjectInput* to)
{
  constexpr double same_pose_voxels = 0.5;
  const std::size_t times = std::max<std::size_t> (
      1, std::max (of.T_world_object.size (), to ? to->T_world_object.size () : 0));
  const std::vector<Eigen::Vector3d> probes = corners (grid);
  const double same = same_pose_voxels * grid.voxel_size_m;
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t t = 0; t < times; ++t)
  {
    const Eigen::Isometry3d T = (to ? poseAt (*to, t).inverse () : Eigen::Isometry3d::Identity ()) * poseAt (of, t);
    if (!T.matrix ().allFinite ())
      continue;
    const auto has_moved = [&] (const Eigen::Isometry3d& other) {
      return std::any_of (probes.begin (), probes.end (),
                          [&] (const Eigen::Vector3d& p) { return (T * p - other * p).norm () > same; });
    };
    if (std::all_of (poses.begin (), poses.end (), has_moved))
      poses.push_back (T);
  }
  return poses;
}

Eigen::Vector4d
transformPlane (const Eigen::Vector4d& plane, const Eigen::Isometry3d& T_plane_target)
{
  Eigen::Vector4d out;
  out.head<3> () = T_plane_target.linear ().transpose () * plane.head<3> ();
  out[3] = plane[3] + plane.head<3> ().dot (T_plane_target.translation ());
  return out;
}

std::vector<Eigen::Vector4d>
planesAtPoses (const ObjectInput& object, const Eigen::Vector3d& center, const std::vector<Eigen::Vector4d>& planes,
               const std::vector<Eigen::Isometry3d>& T_world_object)
{
  const Eigen::Isometry3d first = firstPose (object);
  std::vector<Eigen::Vector4d> seen;
  for (const Eigen::Isometry3d& T : T_world_object)
    for (const Eigen::Vector4d& plane : planes)
    {
      const Eigen::Vector4d local = transformPlane (plane, T);
      if (local.head<3> ().dot (center) + local[3] > 0.0 || T.matrix () == first.matrix ())
        seen.push_back (local);
    }
  return seen;
}

} // namespace pcl::cosection
