// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "co_section_run.h"

#include "pcl_cosection/energy/constraints/object_hull.h"
#include "pcl_cosection/view/visibility.h"
#include "volume_layout.h"

#include <algorithm>
#include <limits>

// The part of a run that bounds its objects by what no view saw free.

namespace pcl::cosection
{

namespace
{

constexpr double
    hull_reach = 1.0; // beyond what was observed, of its longest side: of space that nobody saw there is no end
constexpr double layer_more_vox = 1.0;                    // the layer on planes, beyond the margin of free space
constexpr double around_vox = 3.0;                        // what is left around hull and mesh
constexpr std::size_t max_voxels = std::size_t (1) << 25; // of a hull that is larger than the object's volume

/** \brief The thickness of the layer on a surface at a place that the views do not see free. */
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

} // namespace

VoxelGrid
CoSectionRun::hullGrid (const Object& object, const Eigen::AlignedBox3d& unseen, std::size_t used_bytes) const
{
  const VoxelGrid& lattice = object.volume ().grid ();
  Eigen::AlignedBox3d box = unseen;
  for (const Eigen::Vector3f& vertex : object.result->mesh.vertices)
    box.extend (vertex.cast<double> ());
  VoxelGrid grid = lattice;
  const Eigen::Vector3d first = lattice.toVoxel (box.min ()).array ().floor () - around_vox;
  grid.origin_m = lattice.origin_m + lattice.voxel_size_m * first;
  grid.dims = (lattice.toVoxel (box.max ()).array ().ceil () + around_vox - first.array ()).cast<int> () + 1;
  const std::size_t limit = scene_.options.max_memory_bytes;
  const bool too_large = grid.size () > max_voxels ||
                         (limit != 0 && used_bytes + ShapeVolume::estimateBytes (grid) > limit);
  return too_large ? lattice : grid;
}

void
CoSectionRun::findHulls ()
{
  struct Sought
  {
    Object* object;
    std::vector<Eigen::Vector4d> planes; // object frame
    double layer_m;
    std::unique_ptr<ObjectHull> hull;
  };
  const CoSectionOptions& options = scene_.options;
  const auto sensorIn = [&] (const Object& object, std::size_t v) -> Eigen::Isometry3d {
    return pose (object, v).inverse () * scene_.views[v].depth.T_world_sensor;
  };
  std::vector<Sought> all;
  std::size_t used_bytes = bytesInUse ();
  const auto begin = [&] (Object& object) {
    Sought sought{&object, {}, 0.0, nullptr};
    if (!object.plane_is_guessed)
      sought.planes = planesAt (object, options.use_intersection ? object.planes : planesOf (object),
                                relativePoses (object, nullptr));
    OcclusionMap::Views views;
    for (std::size_t v = 0; v < scene_.views.size (); ++v)
      if (const Eigen::Isometry3d T = sensorIn (object, v); T.matrix ().allFinite ())
        views.emplace_back (&scene_.views[v].depth, T);
    const Eigen::AlignedBox3d& observed = object.observed;
    sought.layer_m = unseenLayer (views, observed.center (), object.voxel_size_m);
    VoxelGrid grid = object.volume ().grid ();
    // What surrounded a thing that was cut out is not unseen but gone.
    if (!views.empty () && !scene_.background.empty () && options.padding <= 0.0)
    {
      const Eigen::Vector3d reach = Eigen::Vector3d::Constant (hull_reach * observed.sizes ().maxCoeff ());
      grid = hullGrid (object,
                       unseenBox (object.points (), observed, {observed.min () - reach, observed.max () + reach},
                                  object.voxel_size_m, views, sought.planes, sought.layer_m),
                       used_bytes);
    }
    used_bytes += ShapeVolume::estimateBytes (grid);
    sought.hull = std::make_unique<ObjectHull> (grid, options);
    all.push_back (std::move (sought));
  };
  for (Object& object : objects_)
    if (object.alive ())
      guarded (object, [&] { begin (object); });
  for (std::size_t v = 0; v < scene_.views.size (); ++v)
  {
    const FreeSpaceView view (scene_.views[v].depth);
    for (Sought& sought : all)
      if (const Eigen::Isometry3d T = sensorIn (*sought.object, v); T.matrix ().allFinite ())
        sought.hull->add (view, T);
  }
  for (Sought& sought : all)
    guarded (*sought.object, [&] {
      sought.hull->finish (sought.object->points (), sought.planes, sought.layer_m);
      if (options.compute_hull)
        sought.object->result->hull = sought.hull->mesh ();
      if (options.compute_bounds)
        sought.object->result->outer_bound = sought.hull->meshWith (sought.object->field);
      sought.hull.reset ();
    });
}

} // namespace pcl::cosection
