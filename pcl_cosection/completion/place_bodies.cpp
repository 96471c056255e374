// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "place_bodies.h"

#include "background/background_blocks.h"
#include "pcl_cosection/common/boxes.h"
#include "pcl_cosection/common/byte_text.h"
#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/priors/extent_prior.h"
#include "pcl_cosection/view/visibility/free_space_view.h"
#include "pcl_cosection/view/visibility/visibility.h"
#include "pcl_cosection/volume/distance_transform.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <sstream>

namespace pcl::cosection {
namespace {

constexpr int min_axis = 8;       // voxels
constexpr double max_axis = 8192; // voxels
// Cells along the longest side in the search for the region where an object may be. It is no whole number, so that
// sides do not run along the borders of cells.
constexpr double possible_cells = 20.6;
constexpr double possible_margin_vox = 6.0; // around that region
constexpr double default_padding = 0.3;     // of the longest side, where views and prior do not bound the shape
// Factor of the solver's tolerance in incremental mode: each update starts from the errors of the last one.
constexpr double follow_tolerance = 0.5;
// An updated body keeps its voxels and Gaussians while the wanted sizes differ by less than this factor.
constexpr double max_change = 1.2;
constexpr int forgotten_after = 2;      // updates without a wall, until an object is no vessel any more
constexpr double most_of_memory = 0.67; // share for objects of the memory beside points and views; the rest: background
constexpr double max_sigma_vox = 10.0;  // largest value of the option
constexpr double max_empty_share = 0.5; // of an earlier volume: with more beyond the present box, it is replaced
constexpr std::size_t bytes_per_field_voxel = sizeof (float) + sizeof (std::uint8_t);
constexpr double voxels_per_wall = 2.0;
constexpr double finest_vessel = 0.5; // of the voxels that the points' spacing supports

/** \brief A query whether any view sees a place free. */
auto
freeSpaceQuery (const OcclusionMap::Views& views, double margin_m)
{
  std::vector<Eigen::Isometry3d> T_sensor_points;
  for (const auto& [view, T_points_sensor] : views)
    T_sensor_points.push_back (T_points_sensor.inverse ());
  return [&views, margin_m, T_sensor_points] (const Eigen::Vector3d& p) {
    for (std::size_t v = 0; v < views.size (); ++v)
      if (visibilityOf (T_sensor_points[v] * p, *views[v].first, margin_m) == PointVisibility::Free)
        return true;
    return false;
  };
}

/** \brief Whether a place is lower than \a height_m above any of the planes. */
bool
isBelow (const std::vector<Eigen::Vector4d>& planes, const Eigen::Vector3d& p, double height_m)
{
  return std::any_of (planes.begin (), planes.end (),
                      [&] (const Eigen::Vector4d& plane) { return plane.head<3> ().dot (p) + plane[3] < height_m; });
}

/** \brief Box of the region where an object may be, with a margin: where ExtentPrior gives no bound, above all
 * \a planes, united with \a known. */
Eigen::AlignedBox3d
possibleBox (const Observation& object, const Eigen::AlignedBox3d& known, const std::vector<Eigen::Vector4d>& planes,
             int threads)
{
  const ExtentPrior prior;
  const Eigen::AlignedBox3d& observed = object.box;
  VoxelGrid cells;
  cells.voxel_size_m = observed.sizes ().maxCoeff () / possible_cells;
  const double farthest = prior.farthest (object.extents_m);
  cells.dims = ((observed.sizes ().array () + 2.0 * farthest) / cells.voxel_size_m).ceil ().cast<int> () + 1;
  cells.origin_m = observed.center () -
                   0.5 * cells.voxel_size_m * (cells.dims.cast<double> () - Eigen::Vector3d::Ones ());
  std::vector<std::uint8_t> data (cells.size (), 0);
  const double cells_per_m = 1.0 / cells.voxel_size_m;
  for (const OrientedPoint& point : object.points ())
  {
    const Eigen::Vector3d p = point.position.cast<double> ();
    if (!observed.contains (p))
      continue;
    const Eigen::Array3i at = (cells_per_m * (p - cells.origin_m).array () + 0.5).cast<int> (); // the nearest: positive
    data[cells.index (at.x (), at.y (), at.z ())] = 1;
  }
  const std::vector<float> distance = distanceTransform (cells.dims, data, threads);
  const auto allowed = [&] (Hidden by) { return prior.allowed (object.extents_m / cells.voxel_size_m, by); };
  const float most = std::max ({allowed (Hidden::ByObject), allowed (Hidden::ByOther), allowed (Hidden::Nothing)});
  const double margin = 0.5 * cells.voxel_size_m + possible_margin_vox * object.voxel_size_m;
  const auto free = freeSpaceQuery (object.views, cells.voxel_size_m);
  Eigen::AlignedBox3d box = observed.merged (known);
  for (int k = 0; k < cells.dims.z (); ++k)
    for (int j = 0; j < cells.dims.y (); ++j)
      for (int i = 0; i < cells.dims.x (); ++i)
      {
        const Eigen::Vector3d p = cells.center (i, j, k);
        const float away = distance[cells.index (i, j, k)];
        if (away > most || box.contains (p) || isBelow (planes, p, 0.5 * cells.voxel_size_m) || free (p))
          continue;
        if (away <= allowed (object.hidden.at (p)))
          box.extend (p);
      }
  // Whole voxels from the observed box, so that the lattice depends on that box alone.
  const auto whole = [&] (const Eigen::Vector3d& beyond) {
    return Eigen::Vector3d (object.voxel_size_m * ((beyond.array () + margin) / object.voxel_size_m).ceil ());
  };
  return {observed.min () - whole (observed.min () - box.min ()),
          observed.max () + whole (box.max () - observed.max ())};
}

/** \brief Whether an earlier size is near enough to the wanted one to be kept. */
bool
isSimilar (double earlier, double wanted)
{
  return earlier > wanted / max_change && earlier < wanted * max_change;
}

/** \brief Box of the places where an object may be. */
Eigen::AlignedBox3d
volumeBox (const Scene& scene, const ObjectInput& input, const Observation& object, const SupportPlanes& support)
{
  const CoSectionOptions& options = scene.options;
  if (options.padding > 0.0 || !options.activePriors ().extent || !options.use_hull || object.views.empty ())
  {
    const double fraction = options.padding > 0.0 ? options.padding : default_padding;
    const Eigen::Vector3d pad = Eigen::Vector3d::Constant (fraction * object.box.sizes ().maxCoeff () +
                                                           2.0 * object.voxel_size_m);
    return {object.box.min () - pad, object.box.max () + pad};
  }
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t v = 0; v < std::max<std::size_t> (1, input.T_world_object.size ()); ++v)
    if (poseAt (input, v).matrix ().allFinite ())
      poses.push_back (poseAt (input, v));
  const std::vector<Eigen::Vector4d> planes = planesAtPoses (input, object.box.center (), support.all (), poses);
  const Eigen::AlignedBox3d known = boxDownToPlanes (object, settingOf (scene, input), planes);
  return possibleBox (object, known, planes, options.threads);
}

/** \brief Voxel size of a vessel (ProfiledShape::wallThickness ()): half of its wall thickness, if that is smaller
 * than \a supported_m, but no less than half of \a supported_m and a 96th of the longest side. Voxels finer than the
 * points' spacing supports are possible, as points have copies on all sides. */
double
vesselVoxelSize (double supported_m, double wall_m, const Eigen::AlignedBox3d& box)
{
  const double least_m = std::max (finest_vessel * supported_m, box.sizes ().maxCoeff () / thin_resolution);
  return std::min (supported_m, std::max (least_m, wall_m / voxels_per_wall));
}

/** \brief The voxel size that the points support; finer for the walls of vessels. A wall that is not found in an update
 * is remembered for a while. */
double
finestVoxelSize (const Scene& scene, const ObjectInput& input, const Observation& object, const SupportPlanes& support,
                 BodyState& body)
{
  const CoSectionOptions& options = scene.options;
  if (scene.fixedVoxelSize () || !options.use_extent_prior || !options.use_symmetric_extent)
    return object.voxel_size_m;
  const double earlier_m = body.grid ? body.wall_m : 0.0;
  const std::vector<Eigen::Vector4d> planes = planesAtPoses (input, object.box.center (), support.all (),
                                                             {firstPose (input)});
  body.wall_m = wallThickness (object, settingOf (scene, input), planes);
  body.updates_without_wall = body.wall_m > 0.0 ? 0 : body.updates_without_wall + 1;
  if (!(body.wall_m > 0.0) && body.updates_without_wall < forgotten_after)
    body.wall_m = earlier_m;
  return body.wall_m > 0.0 ? std::min (object.voxel_size_m, vesselVoxelSize (object.spacing_m, body.wall_m, object.box))
                           : object.voxel_size_m;
}

/** \brief The box of an object's volume, and voxel sizes for it, from the best one to one that takes little memory. */
struct Placement
{
  Eigen::AlignedBox3d box;
  std::array<double, 3> sizes_m{};
};

Placement
placementOf (const Scene& scene, const ObjectInput& input, const Observation& object, const SupportPlanes& support,
             BodyState& body)
{
  Placement placement;
  placement.box = volumeBox (scene, input, object, support);
  const double fine_m = finestVoxelSize (scene, input, object, support, body);
  if (scene.fixedVoxelSize ())
    placement.sizes_m = {fine_m, fine_m, fine_m};
  else
    placement.sizes_m = {fine_m, std::max (fine_m, object.voxel_size_m), std::max (fine_m, object.spacing_m)};
  return placement;
}

} // namespace

VoxelGrid
layoutBox (const Eigen::AlignedBox3d& box, double voxel_size_m)
{
  VoxelGrid grid;
  grid.voxel_size_m = voxel_size_m;
  const Eigen::Vector3d cells = box.sizes () / voxel_size_m;
  if (!(cells.maxCoeff () < max_axis))
  {
    std::ostringstream message;
    message << "voxel size " << voxel_size_m << " m gives " << cells.maxCoeff () << " voxels along one side; at most "
            << max_axis << " are possible";
    throw InvalidArgument (message.str ());
  }
  for (int a = 0; a < 3; ++a)
    grid.dims[a] = std::max (min_axis, static_cast<int> (std::ceil (cells[a])) + 1);
  grid.origin_m = box.center () - 0.5 * voxel_size_m * (grid.dims.cast<double> () - Eigen::Vector3d::Ones ());
  return grid;
}

void
checkMemory (const VoxelGrid& grid, std::size_t limit_bytes, std::size_t used_bytes)
{
  const std::size_t bytes = estimateBytes (grid);
  if (limit_bytes == 0 || (used_bytes < limit_bytes && bytes <= limit_bytes - used_bytes))
    return;
  std::ostringstream message;
  message << "a volume of " << grid.dims.x () << " x " << grid.dims.y () << " x " << grid.dims.z () << " voxels needs "
          << byteText (bytes) << "; " << byteText (limit_bytes) << " are allowed";
  if (used_bytes > 0)
    message << ", of which points, views and other volumes take " << byteText (used_bytes);
  message << ": use larger voxels or allow more memory";
  throw MemoryLimitExceeded (message.str ());
}

Eigen::AlignedBox3d
unseenBox (const Observation& object, const Eigen::AlignedBox3d& within, const OcclusionMap::Views& views,
           const std::vector<Eigen::Vector4d>& planes, double layer_m)
{
  VoxelGrid cells;
  cells.voxel_size_m = object.box.sizes ().maxCoeff () / possible_cells;
  cells.dims = (within.sizes () / cells.voxel_size_m).array ().ceil ().cast<int> () + 1;
  cells.origin_m = within.min ();
  const auto free = freeSpaceQuery (views, cells.voxel_size_m);
  const auto isUnseen = [&] (const Eigen::Vector3d& p) { // and not only behind single pixels without a reading
    bool unseen = !free (p);
    for (int side = 0; side < 6 && unseen; ++side)
      unseen = !free (p + (side % 2 == 0 ? 0.5 : -0.5) * cells.voxel_size_m * Eigen::Vector3d::Unit (side / 2));
    return unseen;
  };
  std::vector<bool> reached (cells.size (), false);
  std::vector<Eigen::Vector3i> open;
  Eigen::AlignedBox3d box = object.box;
  const auto reach = [&] (const Eigen::Vector3i& cell) {
    reached[cells.index (cell.x (), cell.y (), cell.z ())] = true;
    box.extend (cells.center (cell.x (), cell.y (), cell.z ()));
    open.push_back (cell);
  };
  for (const OrientedPoint& point : object.points ())
    if (const auto cell = cells.nearest (point.position.cast<double> ()))
      if (!reached[cells.index (cell->x (), cell->y (), cell->z ())])
        reach (*cell);
  while (!open.empty ())
  {
    const Eigen::Vector3i cell = open.back ();
    open.pop_back ();
    for (int side = 0; side < 6; ++side)
    {
      Eigen::Vector3i next = cell;
      next[side / 2] += side % 2 == 0 ? -1 : 1;
      if (!cells.contains (next.x (), next.y (), next.z ()) || reached[cells.index (next.x (), next.y (), next.z ())])
        continue;
      const Eigen::Vector3d p = cells.center (next.x (), next.y (), next.z ());
      if (!isBelow (planes, p, layer_m) && isUnseen (p))
        reach (next);
    }
  }
  const double margin = cells.voxel_size_m + possible_margin_vox * object.voxel_size_m;
  return {box.min ().array () - margin, box.max ().array () + margin};
}

std::size_t
bytesOf (const SignedDistanceField& field)
{
  return field.grid.size () * bytes_per_field_voxel;
}

std::size_t
bytesOf (const std::vector<Obstacle>& obstacles)
{
  std::size_t bytes = 0;
  for (const Obstacle& obstacle : obstacles)
    bytes += bytesOf (*obstacle.field);
  return bytes;
}

std::size_t
bytesInUse (const Scene& scene, const SceneState& state, const std::vector<Observation>& observations)
{
  std::size_t points = scene.background.size ();
  std::size_t bytes = 0;
  for (const ObjectInput& object : scene.objects)
    points += object.points.size ();
  for (const Observation& object : observations)
  {
    points += object.inliers.size ();
    bytes += object.hidden.bytes ();
  }
  for (const auto& [id, body] : state.objects)
    bytes += body.grid ? estimateBytes (*body.grid) : 0;
  std::size_t largest_view = 0;
  for (const UsedView& view : scene.views)
  {
    bytes += view.depth.depth.size () * sizeof (float);
    largest_view = std::max (largest_view, view.depth.depth.size ());
  }
  bytes += largest_view * FreeSpaceView::bytes_per_pixel;
  if (state.background.grid)
    bytes += estimateBytes (*state.background.grid);
  bytes += bytesOf (state.blocks);
  return bytes + points * sizeof (OrientedPoint);
}

void
placeBody (const Eigen::AlignedBox3d& box, double voxel_size_m, double blur, bool carve, std::size_t used_bytes,
           const CoSectionOptions& options, CompletionMode mode, BodyState& body)
{
  VoxelGrid grid = layoutBox (box, voxel_size_m);
  CoSectionOptions of_body = options;
  if (mode == CompletionMode::Incremental)
    of_body.solver.tolerance_vox *= follow_tolerance;
  of_body.sigma_vox = std::min (max_sigma_vox, blur * of_body.sigma_vox);
  if (body.grid && body.grid->voxel_size_m == voxel_size_m)
  {
    const bool same_blur = isSimilar (body.options.sigma_vox, of_body.sigma_vox);
    if (same_blur)
      of_body.sigma_vox = body.options.sigma_vox;
    // On the lattice of its grid; the same grid while it is large enough and not much too large.
    const Eigen::Vector3d first = body.grid->toVoxel (box.min ()).array ().floor ();
    const Eigen::Vector3d last = body.grid->toVoxel (box.max ()).array ().ceil ();
    if (same_blur && (first.array () >= 0.0).all () &&
        (last.array () <= body.grid->dims.cast<double> ().array () - 1.0).all () &&
        (last - first + Eigen::Vector3d::Ones ()).prod () > max_empty_share * static_cast<double> (body.grid->size ()))
      return;
    grid.origin_m = body.grid->origin_m + voxel_size_m * first;
    grid.dims = (last - first).cast<int> ().array () + 1;
  }
  checkMemory (grid, options.max_memory_bytes, used_bytes);
  body.restart (grid, of_body, carve);
}

std::vector<SceneObject>
placeObjects (const Scene& scene, const std::vector<Observation>& observations,
              const std::vector<SupportPlanes>& support, CompletionMode mode, SceneState& state, CompletionLog& log)
{
  const CoSectionOptions& options = scene.options;
  const bool carve = options.use_hull && options.carve_free_space && !scene.views.empty ();
  const auto bodyOf = [&] (std::size_t o) -> BodyState& { return state.objects.at (scene.objects[o].id); };
  const auto bytesOfGrid = [] (const BodyState& body) { return body.grid ? estimateBytes (*body.grid) : 0; };
  const auto usedBytes = [&] { return bytesInUse (scene, state, observations) + bytesOf (scene.obstacles); };
  std::size_t volumes = 0;
  std::array<std::size_t, 3> bytes{};
  const std::vector<Placement> placements = log.forEachObject ([&] (std::size_t o) {
    const Placement placement = placementOf (scene, scene.objects[o], observations[o], support[o], bodyOf (o));
    for (std::size_t n = 0; n < bytes.size (); ++n)
      bytes[n] += estimateBytes (layoutBox (placement.box, placement.sizes_m[n]));
    volumes += bytesOfGrid (bodyOf (o));
    return placement;
  });
  // The finest sizes that leave room for all objects and the background: coarse meshes of all rather than of a few.
  const std::size_t limit = options.max_memory_bytes, used = usedBytes () - volumes;
  std::size_t placed_bytes = volumes; // of the grids of all objects
  std::size_t level = 0;
  while (limit > 0 && level + 1 < bytes.size () &&
         static_cast<double> (used) + static_cast<double> (bytes[level]) / most_of_memory > static_cast<double> (limit))
    ++level;

  std::vector<SceneObject> objects;
  for (std::size_t o = 0; o < scene.objects.size (); ++o)
  {
    const std::size_t bytes_before = bytesOfGrid (bodyOf (o));
    const bool placed = !log.failed (o) && log.guard (o, [&] {
      BodyState& body = bodyOf (o);
      double voxel_size_m = placements[o].sizes_m[level];
      if (body.grid && isSimilar (body.grid->voxel_size_m, voxel_size_m)) // an updated body keeps its voxels
        voxel_size_m = body.grid->voxel_size_m;
      const bool is_vessel = body.wall_m > 0.0 && !scene.fixedVoxelSize ();
      const double smooth_m = is_vessel ? observations[o].spacing_m : observations[o].voxel_size_m;
      placeBody (placements[o].box, voxel_size_m, std::max (1.0, smooth_m / voxel_size_m), carve,
                 used + placed_bytes - bytes_before, options, mode, body);
    });
    placed_bytes += bytesOfGrid (bodyOf (o)) - bytes_before;
    if (!placed)
      continue;
    const ObjectInput& input = scene.objects[o];
    BodyState& body = bodyOf (o);
    objects.push_back ({o, &input, &observations[o], &support[o], &body, relativePoses (input, *body.grid, nullptr)});
  }
  return objects;
}

} // namespace pcl::cosection
