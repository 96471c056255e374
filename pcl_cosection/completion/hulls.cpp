// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "hulls.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/energy/constraints/hull_constraint.h"
#include "pcl_cosection/view/visibility/visibility.h"
#include "pcl_cosection/volume/distance_transform.h"
#include "place_bodies.h"
#include "shown_bodies.h"
#include <pcl/cosection/volume/iso_surface.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr double hull_reach = 1.0; // limit around the observed box, of its longest side, as unseen space is unbounded
constexpr double layer_more_vox = 1.0; // of the layer on planes, in addition to the margin of free space
constexpr double around_vox = 3.0;     // margin around hull and mesh
constexpr std::size_t max_voxels = std::size_t (1) << 25; // of a hull that is larger than the object's volume
constexpr float least_free_vox = 0.25f;    // least distance of a voxel seen free from the surface of the hull
constexpr float below_plane_vox = 1.0f;    // the uncertainty of a plane
constexpr float seed_reach_vox = 3.0f;     // voxels so near to points are seeds of the hull ...
constexpr float low_seed_reach_vox = 1.0f; // ... in the layer on a plane, voxels so near
// Connected components pass only through voxels so deep: the thin rays of single pixels without a reading do not count.
constexpr float core_depth_vox = 2.0f;
constexpr float around_core_vox = 4.0f; // voxels so near to the core belong to the hull: the corners of its cubes do
constexpr float layer_reach = 1.25f;    // of its thickness: how far the layer on a plane belongs to the hull above it
constexpr float far_vox = 3.0f;         // distances are clamped to this
constexpr float border_vox = 2.0f;      // distance of a closed surface from the border of its volume
constexpr float beside_vox = 1.5f;      // distance within which free space or a plane counts as bounding the surface
constexpr double confidence_scale_vox = 5.0;
constexpr float sigmas = 2.0f; // of the expected error, by which the outer bound is outside of the mesh

/** \brief Height above the lowest of the planes, voxels. */
float
heightAbove (const std::vector<Eigen::Vector4d>& planes, const VoxelGrid& grid, const Eigen::Vector3d& p)
{
  double lowest_m = std::numeric_limits<double>::infinity ();
  for (const Eigen::Vector4d& plane : planes)
    lowest_m = std::min (lowest_m, plane.head<3> ().dot (p) + plane[3]);
  return static_cast<float> (lowest_m / grid.voxel_size_m);
}

/** \brief Call f (n, i, j, k) for every voxel; threads divide the planes of the grid. */
template <typename Function>
void
forEachVoxel (const VoxelGrid& grid, int threads, Function&& f)
{
  parallelFor (0, grid.dims.z (), threads, [&] (int k) {
    std::size_t n = grid.index (0, 0, k);
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i, ++n)
        f (n, i, j, k);
  });
}

/** \brief The wanted voxels (not 0) that are connected with a seed by faces; all seeds are among them. */
std::vector<std::uint8_t>
connectedWith (const std::vector<std::uint8_t>& seeds, const std::vector<std::uint8_t>& wanted,
               const Eigen::Vector3i& dims)
{
  std::vector<std::uint8_t> reached = seeds;
  std::vector<std::size_t> open;
  for (std::size_t n = 0; n < seeds.size (); ++n)
    if (seeds[n])
      open.push_back (n);
  const std::array<std::size_t, 3> steps = {1, static_cast<std::size_t> (dims.x ()),
                                            static_cast<std::size_t> (dims.x ()) * dims.y ()};
  while (!open.empty ())
  {
    const std::size_t n = open.back ();
    open.pop_back ();
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto at = static_cast<int> (n / steps[axis] % dims[axis]);
      const auto visit = [&] (std::size_t next) {
        if (!wanted[next] || reached[next])
          return;
        reached[next] = 1;
        open.push_back (next);
      };
      if (at > 0)
        visit (n - steps[axis]);
      if (at + 1 < dims[axis])
        visit (n + steps[axis]);
    }
  }
  return reached;
}

/** \brief The hull of one object: all space that may belong to it. No view saw it free, it is above the support planes,
 * and it is connected with the object's points.
 *
 * Points only select the component of unseen space, so the hull shrinks as views are added, up to the margin around
 * surfaces within which space is not seen free. On a table a layer of that thickness remains unseen; the hull does not
 * extend along it away from the object.
 *
 * Use: add () every view; then finish (); then mesh () or meshAround (). Everything is in the object's frame. */
class ObjectHull
{
public:
  /** \param[in] planes unit normals to the object's side
   * \param[in] layer_m thickness of the layer on planes along which the hull does not extend */
  ObjectHull (const VoxelGrid& grid, const CoSectionOptions& options, std::vector<Eigen::Vector4d> planes,
              double layer_m)
      : grid_ (grid)
      , options_ (options)
      , planes_ (std::move (planes))
      , layer_vox_ (static_cast<float> (layer_m / grid.voxel_size_m))
      , votes_ (grid, options.threads)
  {
    if (options.carve_free_space)
      carving_.emplace (grid, options.revise_votes, options.threads);
  }

  void add (const FreeSpaceView& view, const Eigen::Isometry3d& T_object_sensor, int id)
  {
    votes_.add (view, T_object_sensor, id);
    if (carving_)
      carving_->add (view, T_object_sensor, id);
  }

  void finish (const std::vector<OrientedPoint>& points)
  {
    const int threads = options_.threads;
    free_space_ = votes_.freeSpace (options_.revise_votes);
    // Signed distance to the space that was seen free, positive in it, clamped; voxels.
    std::vector<float> value = carving_ ? carving_->lowerBounds (true) : std::vector<float> (grid_.size (), -0.5f);

    std::vector<std::uint8_t> data (grid_.size (), 0);
    for (const OrientedPoint& point : points)
      if (const auto at = grid_.nearest (point.position.cast<double> ()))
        data[grid_.index (at->x (), at->y (), at->z ())] = 1;
    data_distance_vox_ = distanceTransform (grid_.dims, data, threads);

    std::vector<std::uint8_t> outside (grid_.size ()), seeds (grid_.size ()), low (grid_.size ());
    forEachVoxel (grid_, threads, [&] (std::size_t n, int i, int j, int k) {
      if (free_space_[n])
        value[n] = std::max (value[n], carving_ ? least_free_vox : 0.5f);
      const float height_vox = heightAbove (planes_, grid_, grid_.center (i, j, k));
      value[n] = std::max (value[n], -below_plane_vox - height_vox);
      outside[n] = value[n] >= 0.0f;
      low[n] = height_vox < layer_vox_;
      seeds[n] = !outside[n] && data_distance_vox_[n] <= (low[n] ? low_seed_reach_vox : seed_reach_vox);
    });
    std::vector<std::uint8_t> core (grid_.size ());
    {
      const std::vector<float> depth_vox = distanceTransform (grid_.dims, outside, threads);
      forEachVoxel (grid_, threads,
                    [&] (std::size_t n, int, int, int) { core[n] = depth_vox[n] > core_depth_vox && !low[n]; });
    }
    const std::vector<std::uint8_t> kept = connectedWith (seeds, core, grid_.dims);
    const std::vector<float> away_vox = distanceTransform (grid_.dims, kept, threads);

    hull_.grid = grid_;
    hull_.values.resize (grid_.size ());
    forEachVoxel (grid_, threads, [&] (std::size_t n, int i, int j, int k) {
      const float reach_vox = low[n] ? std::max (around_core_vox, layer_reach * layer_vox_) : around_core_vox;
      const float outside_vox = std::max ({value[n], away_vox[n] - reach_vox, offBorder (i, j, k)});
      hull_.values[n] = static_cast<float> (std::min (outside_vox, far_vox) * grid_.voxel_size_m);
    });
  }

  /** \brief The hull as a closed mesh with provenance and confidence. */
  TriangleMesh mesh () const { return meshOf (hull_); }

  /** \brief The union of the hull, a body, and its mesh moved outward by two sigma, as a closed mesh with provenance
   * and confidence. Beyond the hull the mesh moves no farther than twice its least sigma, which is that of the noise:
   * an error is not expected where views looked through. */
  TriangleMesh meshAround (const SignedDistanceField& body, const TriangleMesh& mesh) const
  {
    const std::vector<float> moved_m = distanceToMoved (mesh);
    const float noise_m = mesh.sigma_m.empty () ? 0.0f : *std::min_element (mesh.sigma_m.begin (), mesh.sigma_m.end ());
    SignedDistanceField both = hull_;
    forEachVoxel (grid_, options_.threads, [&] (std::size_t n, int i, int j, int k) {
      float& value = both.values[n];
      value = std::min (value, std::max (moved_m[n], value - sigmas * noise_m));
      if (const auto of_body = body.sample (grid_.center (i, j, k)))
        value = std::min (value, *of_body);
      value = std::max (value, offBorder (i, j, k) * static_cast<float> (grid_.voxel_size_m));
    });
    return meshOf (both);
  }

private:
  /** \brief Voxels by which a closed surface would be too near to the border of the volume. */
  float offBorder (int i, int j, int k) const
  {
    return border_vox - static_cast<float> (std::min (
                            {i, j, k, grid_.dims.x () - 1 - i, grid_.dims.y () - 1 - j, grid_.dims.z () - 1 - k}));
  }

  /** \brief Signed distance to the union of balls of two sigma around the vertices, metres; where it is larger than a
   * voxel, any larger value. */
  std::vector<float> distanceToMoved (const TriangleMesh& mesh) const
  {
    const auto voxel_m = static_cast<float> (grid_.voxel_size_m);
    std::vector<float> distance_m (grid_.size (), far_vox * voxel_m);
    for (std::size_t v = 0; v < mesh.sigma_m.size (); ++v)
    {
      const float radius_m = sigmas * mesh.sigma_m[v];
      const Eigen::Vector3d at = grid_.toVoxel (mesh.vertices[v].cast<double> ());
      const double reach_vox = radius_m / voxel_m + 1.0;
      const Eigen::Vector3i first = (at.array () - reach_vox).ceil ().cast<int> ().max (0);
      const Eigen::Vector3i last = (at.array () + reach_vox).floor ().cast<int> ().min (grid_.dims.array () - 1);
      for (int k = first.z (); k <= last.z (); ++k)
        for (int j = first.y (); j <= last.y (); ++j)
          for (int i = first.x (); i <= last.x (); ++i)
          {
            float& least_m = distance_m[grid_.index (i, j, k)];
            least_m = std::min (least_m,
                                voxel_m * static_cast<float> ((Eigen::Vector3d (i, j, k) - at).norm ()) - radius_m);
          }
    }
    return distance_m;
  }

  TriangleMesh meshOf (const SignedDistanceField& field) const
  {
    const IsoSurfaceOptions closed{true, options_.threads};
    TriangleMesh mesh = extractIsoSurface (field, closed);
    const std::vector<float> free_distance_vox = distanceTransform (grid_.dims, free_space_, options_.threads);
    mesh.confidence.resize (mesh.vertices.size ());
    mesh.provenance.resize (mesh.vertices.size ());
    parallelFor (0, static_cast<int> (mesh.vertices.size ()), options_.threads, [&] (int v) {
      const Eigen::Vector3d p = mesh.vertices[v].cast<double> ();
      const Eigen::Vector3i at = *grid_.nearest (p);
      const std::size_t n = grid_.index (at.x (), at.y (), at.z ());
      Provenance provenance = Provenance::Inferred;
      if (data_distance_vox_[n] <= beside_vox)
        provenance = Provenance::Observed;
      else if (std::abs (heightAbove (planes_, grid_, p)) <= beside_vox)
        provenance = Provenance::Intersection;
      else if (free_distance_vox[n] <= beside_vox)
        provenance = Provenance::Hull;
      mesh.provenance[v] = static_cast<std::uint8_t> (provenance);
      mesh.confidence[v] = static_cast<float> (std::exp (-data_distance_vox_[n] / confidence_scale_vox));
    });
    return mesh;
  }

  VoxelGrid grid_;
  const CoSectionOptions& options_;
  std::vector<Eigen::Vector4d> planes_;
  float layer_vox_;
  HullConstraint votes_;
  std::optional<FreeSpaceCarving> carving_;
  SignedDistanceField hull_;
  std::vector<std::uint8_t> free_space_;
  std::vector<float> data_distance_vox_;
};

/** \brief Thickness of the layer on a surface at a place within which the views do not see free space. */
double
unseenLayer (const OcclusionMap::Views& views, const Eigen::Vector3d& place, double voxel_size_m)
{
  double margin_m = std::numeric_limits<double>::infinity ();
  for (const auto& [view, T_object_sensor] : views)
  {
    const Eigen::Vector3d p = T_object_sensor.inverse () * place;
    if (pixelOf (view->camera, p))
      margin_m = std::min (margin_m, freeSpaceMargin (*view, p.z (), voxel_size_m));
  }
  return (margin_m < std::numeric_limits<double>::infinity () ? margin_m : leastFreeSpaceMargin (voxel_size_m)) +
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

Eigen::Isometry3d
sensorPose (const Scene& scene, const SceneObject& object, std::size_t view)
{
  return poseAt (*object.input, view).inverse () * scene.views[view].depth.T_world_sensor;
}

/** \brief The hull of an object before views are added. */
ObjectHull
beginHull (const Scene& scene, const SceneObject& object, const TriangleMesh& mesh, std::size_t& used_bytes)
{
  const CoSectionOptions& options = scene.options;
  const Observation& observation = *object.observation;
  std::vector<Eigen::Vector4d> planes;
  if (!object.support->inferred)
    planes = options.use_intersection
                 ? object.planes ()
                 : planesAtPoses (*object.input, observation.box.center (),
                                  boundingPlanes (scene, *object.input, observation), object.T_world_object);
  OcclusionMap::Views views;
  for (std::size_t v = 0; v < scene.views.size (); ++v)
    if (const Eigen::Isometry3d T = sensorPose (scene, object, v); T.matrix ().allFinite ())
      views.emplace_back (&scene.views[v].depth, T);
  const double layer_m = unseenLayer (views, observation.box.center (), observation.voxel_size_m);
  VoxelGrid grid = object.grid ();
  // Around an object that was cut out, space is not unseen: its readings were removed.
  if (!views.empty () && !scene.background.empty () && options.padding <= 0.0)
  {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant (hull_reach * observation.box.sizes ().maxCoeff ());
    const Eigen::AlignedBox3d within (observation.box.min () - reach, observation.box.max () + reach);
    grid = hullGrid (object.grid (), mesh, unseenBox (observation, within, views, planes, layer_m), used_bytes,
                     options.max_memory_bytes);
  }
  used_bytes += estimateBytes (grid);
  return {grid, options, std::move (planes), layer_m};
}

} // namespace

void
addHulls (const Scene& scene, const std::vector<SceneObject>& objects, std::size_t used_bytes,
          std::vector<ObjectResult>& results, CompletionLog& log)
{
  const CoSectionOptions& options = scene.options;
  if (!options.compute_hull && !options.compute_bounds)
    return;
  std::vector<std::optional<ObjectHull>> hulls (objects.size ());
  forEachObject (objects, log, [&] (std::size_t o) {
    hulls[o].emplace (beginHull (scene, objects[o], results[o].mesh, used_bytes));
  });
  for (std::size_t v = 0; v < scene.views.size (); ++v)
  {
    const FreeSpaceView view (scene.views[v].depth, bodiesShown (scene, v));
    for (std::size_t o = 0; o < objects.size (); ++o)
      if (hulls[o])
        if (const Eigen::Isometry3d T = sensorPose (scene, objects[o], v); T.matrix ().allFinite ())
          hulls[o]->add (view, T, objects[o].input->id);
  }
  forEachObject (objects, log, [&] (std::size_t o) {
    ObjectHull hull = *std::exchange (hulls[o], std::nullopt);
    hull.finish (objects[o].points ());
    if (options.compute_hull)
      results[o].hull = hull.mesh ();
    if (options.compute_bounds)
      results[o].outer_bound = hull.meshAround (*results[o].signed_distance, results[o].mesh);
  });
}

} // namespace pcl::cosection
