// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "co_section_run.h"

#include "volume_layout.h"

#include "pcl_cosection/energy/constraints/support_plane.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/volume/mesh_distance.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

// The part of a run that learns what else surrounds the objects: support planes and given bodies.

namespace pcl::cosection
{

namespace
{

constexpr double plane_inlier_voxels = 2.0;
constexpr double min_plane_inlier_m = 0.004;
constexpr double hidden_plane_reach = 2.0; // of its longest side: where support is looked for if none is seen near it
constexpr double same_plane_cosine = 0.999;
constexpr double same_plane_m = 0.005;
constexpr std::size_t most_samples = 2000; // of an object's points
constexpr double cut_voxels = 2.0;         // so deep a point cannot be for its noise
constexpr double max_share_behind = 0.05;  // of an object's points, behind a plane or in a body that the user gave

} // namespace

Eigen::Vector4d
CoSectionRun::towards (const Object& object, const Eigen::Vector4d& plane) const
{
  const Eigen::Vector4d local = transformPlane (plane, firstPose (object));
  std::size_t above = 0;
  for (const OrientedPoint& p : object.points ())
    above += local.head<3> ().dot (p.position.cast<double> ()) + local[3] > 0.0;
  return 2 * above < object.points ().size () ? Eigen::Vector4d (-plane) : plane;
}

template <typename IsCut>
void
CoSectionRun::warnIfCut (const Object& object, IsCut&& isCut, const std::string& where)
{
  const std::vector<OrientedPoint>& points = object.points ();
  const std::size_t stride = (points.size () + most_samples - 1) / most_samples;
  std::size_t cut = 0, all = 0;
  for (std::size_t p = 0; p < points.size (); p += stride, ++all)
    cut += isCut (points[p].position.cast<double> ());
  const double share = static_cast<double> (cut) / static_cast<double> (all);
  if (share > max_share_behind)
    result_.warnings.push_back ("object " + std::to_string (object.input->id) + ": " +
                                std::to_string (std::lround (100.0 * share)) + " % of its points lie " + where);
}

void
CoSectionRun::warnIfCutByPlanes (const Object& object)
{
  for (std::size_t n = 0; n < scene_.planes.size (); ++n)
  {
    const Eigen::Vector4d local = transformPlane (object.planes[n], firstPose (object));
    warnIfCut (
        object,
        [&] (const Eigen::Vector3d& p) {
          return local.head<3> ().dot (p) + local[3] < -cut_voxels * object.voxel_size_m;
        },
        "behind a plane that was given");
  }
}

void
CoSectionRun::warnIfCutByBodies ()
{
  for (const Object& object : objects_)
  {
    if (!object.alive ())
      continue;
    const std::vector<Eigen::Isometry3d> poses = relativePoses (object, nullptr);
    const auto is_inside = [&] (const Eigen::Vector3d& p) {
      for (const Obstacle& body : bodies_)
        for (const Eigen::Isometry3d& T_field_world : body.T_field_world)
          for (const Eigen::Isometry3d& T_world_object : poses)
            if (const auto u = body.field->sampleSupported (T_field_world * (T_world_object * p));
                u && *u < -cut_voxels * object.voxel_size_m)
              return true;
      return false;
    };
    if (!bodies_.empty ())
      warnIfCut (object, is_inside, "inside a body that was given (an open mesh is solid behind its triangles)");
  }
}

std::vector<Eigen::Vector4d>
CoSectionRun::planesOf (const Object& object) const
{
  std::vector<Eigen::Vector4d> planes;
  for (const Eigen::Vector4d& plane : scene_.planes)
    planes.push_back (towards (object, plane));
  if (!scene_.options.use_planes || scene_.background.empty ())
    return planes;
  std::vector<OrientedPoint> points = object.points ();
  for (OrientedPoint& p : points)
    p.position = (firstPose (object) * p.position.cast<double> ()).cast<float> ();
  SupportPlaneOptions options;
  options.inlier_distance_m = std::max (min_plane_inlier_m, plane_inlier_voxels * object.voxel_size_m);
  std::vector<Eigen::Vector4d> found = findSupportPlanes (scene_.background, points, options);
  if (found.empty ()) // something hides the background around it
  {
    options.reach = hidden_plane_reach;
    found = findSupportPlanes (scene_.background, points, options);
  }
  planes.insert (planes.end (), found.begin (), found.end ());
  return planes;
}

std::vector<Eigen::Vector4d>
CoSectionRun::planesAt (const Object& object, const std::vector<Eigen::Vector4d>& planes,
                        const std::vector<Eigen::Isometry3d>& T_world_object) const
{
  const Eigen::Isometry3d first = firstPose (object);
  const Eigen::Vector3d center = object.observed.center ();
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

void
CoSectionRun::findPlanes ()
{
  if (!scene_.options.use_intersection)
    return;
  for (Object& object : objects_)
  {
    if (!object.alive ())
      continue;
    object.planes = planesOf (object);
    warnIfCutByPlanes (object);
    const Eigen::Vector3d center = firstPose (object) * object.observed.center ();
    for (const Eigen::Vector4d& plane : object.planes)
    {
      const bool known = std::any_of (
          result_.planes.begin (), result_.planes.end (), [&] (const Eigen::Vector4d& other) {
            return plane.head<3> ().dot (other.head<3> ()) > same_plane_cosine &&
                   std::abs ((plane - other).head<3> ().dot (center) + plane[3] - other[3]) < same_plane_m;
          });
      if (!known)
        result_.planes.push_back (plane);
    }
    if (object.planes.empty () && nothingIsKnownAround ())
      guessPlane (object);
  }
}

void
CoSectionRun::sampleMesh (const MeshObstacle& obstacle, double voxel_size_m, double band_m)
{
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant (2.0 * voxel_size_m);
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Object& object : objects_)
  {
    if (!object.alive ())
      continue;
    for (const Eigen::Isometry3d& T_world_object : relativePoses (object, nullptr))
      for (const Eigen::Isometry3d& T_mesh_world : obstacle.T_mesh_world)
      {
        Eigen::AlignedBox3d box;
        for (const Eigen::Vector3d& corner : corners (boxOf (object.volume ().grid ())))
          box.extend (T_mesh_world * T_world_object * corner);
        boxes.emplace_back (box.min () - margin, box.max () + margin);
      }
  }
  std::vector<Obstacle> sampled; // all or nothing
  for (const Eigen::AlignedBox3d& box : uniteOverlapping (std::move (boxes)))
  {
    const VoxelGrid grid = layoutBox (box, voxel_size_m);
    checkMemory (grid, scene_.options.max_memory_bytes, bytesInUse ());
    sampled.push_back ({std::make_shared<SignedDistanceField> (
                            sampleSignedDistance (obstacle.mesh, grid, band_m, scene_.options.threads)),
                        obstacle.T_mesh_world});
  }
  std::move (sampled.begin (), sampled.end (), std::back_inserter (bodies_));
}

void
CoSectionRun::sampleMeshes ()
{
  if (!scene_.options.use_intersection)
    return;
  double smallest = std::numeric_limits<double>::infinity ();
  double largest = 0.0;
  for (const Object& object : objects_)
    if (object.alive ())
    {
      smallest = std::min (smallest, object.voxel_size_m);
      largest = std::max (largest, object.voxel_size_m);
    }
  if (!(largest > 0.0))
    return;
  for (const MeshObstacle& obstacle : scene_.meshes)
  {
    try
    {
      sampleMesh (obstacle, smallest, scene_.options.max_bound_vox * largest + 2.0 * smallest);
    }
    catch (const Error& e)
    {
      result_.warnings.push_back (std::string ("a body given as a mesh was left out: ") + e.what ());
    }
    catch (const std::bad_alloc&)
    {
      result_.warnings.push_back ("a body given as a mesh was left out: not enough memory");
    }
  }
  warnIfCutByBodies ();
}

} // namespace pcl::cosection
