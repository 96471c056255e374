// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "hulls.h"

#include "pcl_cosection/completion/grid/volume_layout.h"
#include "pcl_cosection/energy/constraints/object_hull.h"
#include "pcl_cosection/view/visibility/visibility.h"

#include <algorithm>
#include <limits>
#include <memory>

namespace pcl::cosection {
namespace {

constexpr double hull_reach = 1.0; // limit around the observed box, of its longest side, as unseen space is unbounded
constexpr double layer_more_vox = 1.0; // of the layer on planes, in addition to the margin of free space
constexpr double around_vox = 3.0;     // margin around hull and mesh
constexpr std::size_t max_voxels = std::size_t (1) << 25; // of a hull that is larger than the object's volume

/** \brief Thickness of the layer on a surface at a place within which the views do not see free space. */
double
unseenLayer (const OcclusionMap::Views& views, const Eigen::Vector3d& place, double voxel_size_m)
{
  double margin_m = std::numeric_limits<double>::infinity ();
  for (const auto& [view, T_object_sensor] : views)
  {
    const Eigen::Vector3d p = T_object_sensor.inverse () * place;
    if (pixelOf (view->camera, p))
      margin_m = std::min (margin_m, freeSpaceMargin (p.z (), voxel_size_m));
  }
  return (margin_m < std::numeric_limits<double>::infinity () ? margin_m : freeSpaceMargin (0.0, voxel_size_m)) +
         layer_more_vox * voxel_size_m;
}

/** \brief A grid for an object's hull and mesh, on the lattice of its volume; \a lattice itself if a larger grid
 * exceeds the memory limit. \param[in] unseen box of the hull */
VoxelGrid
hullGrid (const VoxelGrid& lattice, const TriangleMesh& mesh, const Eigen::AlignedBox3d& unseen, std::size_t used_bytes,
          std::size_t limit_bytes)
{
  Eigen::AlignedBox3d box = unseen;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    box.extend (vertex.cast<double> ());
  VoxelGrid grid = lattice;
  const Eigen::Vector3d first = lattice.toVoxel (box.min ()).array ().floor () - around_vox;
  grid.origin_m = lattice.origin_m + lattice.voxel_size_m * first;
  grid.dims = (lattice.toVoxel (box.max ()).array ().ceil () + around_vox - first.array ()).cast<int> () + 1;
  const bool too_large = grid.size () > max_voxels ||
                         (limit_bytes != 0 && used_bytes + estimateBytes (grid) > limit_bytes);
  return too_large ? lattice : grid;
}

/** \brief The hull of one object while views are added. */
struct HullSearch
{
  std::vector<Eigen::Vector4d> planes; // object frame
  double layer_m = 0.0;
  std::unique_ptr<ObjectHull> hull;
};

Eigen::Isometry3d
sensorPose (const Scene& scene, const SceneObject& object, std::size_t view)
{
  return poseAt (*object.input, view).inverse () * scene.views[view].depth.T_world_sensor;
}

HullSearch
beginHull (const Scene& scene, const SceneObject& object, const TriangleMesh& mesh, std::size_t& used_bytes)
{
  const CoSectionOptions& options = scene.options;
  const Observation& observation = *object.observation;
  HullSearch search;
  if (!object.support->inferred)
    search.planes = options.use_intersection
                        ? object.planes ()
                        : planesAtPoses (*object.input, observation.box.center (),
                                         boundingPlanes (scene, *object.input, observation), object.T_world_object);
  OcclusionMap::Views views;
  for (std::size_t v = 0; v < scene.views.size (); ++v)
    if (const Eigen::Isometry3d T = sensorPose (scene, object, v); T.matrix ().allFinite ())
      views.emplace_back (&scene.views[v].depth, T);
  search.layer_m = unseenLayer (views, observation.box.center (), observation.voxel_size_m);
  VoxelGrid grid = object.grid ();
  // Around an object that was cut out, space is not unseen: its readings were removed.
  if (!views.empty () && !scene.background.empty () && options.padding <= 0.0)
  {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant (hull_reach * observation.box.sizes ().maxCoeff ());
    const Eigen::AlignedBox3d within (observation.box.min () - reach, observation.box.max () + reach);
    const Eigen::AlignedBox3d unseen = unseenBox (observation.points (), observation.box, within,
                                                  observation.voxel_size_m, views, search.planes, search.layer_m);
    grid = hullGrid (object.grid (), mesh, unseen, used_bytes, options.max_memory_bytes);
  }
  used_bytes += estimateBytes (grid);
  search.hull = std::make_unique<ObjectHull> (grid, options);
  return search;
}

} // namespace

std::vector<HullMeshes>
findHulls (const Scene& scene, const std::vector<SceneObject>& objects, const std::vector<const TriangleMesh*>& meshes,
           const std::vector<const SignedDistanceField*>& fields, std::size_t used_bytes, CompletionLog& log)
{
  const CoSectionOptions& options = scene.options;
  std::vector<HullMeshes> result (objects.size ());
  if (!options.compute_hull && !options.compute_bounds)
    return result;
  std::vector<HullSearch> searches (objects.size ());
  for (std::size_t o = 0; o < objects.size (); ++o)
    if (!log.failed (objects[o].index))
      log.guard (objects[o].index, [&] { searches[o] = beginHull (scene, objects[o], *meshes[o], used_bytes); });
  for (std::size_t v = 0; v < scene.views.size (); ++v)
  {
    const FreeSpaceView view (scene.views[v].depth);
    for (std::size_t o = 0; o < objects.size (); ++o)
      if (searches[o].hull)
        if (const Eigen::Isometry3d T = sensorPose (scene, objects[o], v); T.matrix ().allFinite ())
          searches[o].hull->add (view, T);
  }
  for (std::size_t o = 0; o < objects.size (); ++o)
    if (searches[o].hull)
      log.guard (objects[o].index, [&] {
        const HullSearch search = std::move (searches[o]);
        search.hull->finish (objects[o].points (), search.planes, search.layer_m);
        if (options.compute_hull)
          result[o].hull = search.hull->mesh ();
        if (options.compute_bounds)
          result[o].outer_bound = search.hull->meshWith (*fields[o]);
      });
  return result;
}

} // namespace pcl::cosection
