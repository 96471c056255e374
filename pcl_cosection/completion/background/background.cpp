// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "background.h"

#include "background_blocks.h"
#include "pcl_cosection/common/boxes.h"
#include "pcl_cosection/completion/place_bodies.h"
#include "pcl_cosection/energy/body_mesh.h"
#include "pcl_cosection/energy/expected_error.h"
#include "pcl_cosection/mesh/mesh_attributes.h"
#include "solve_blocks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>

namespace pcl::cosection {
namespace {

constexpr double background_voxels_per_object_voxel = 2.0; // size ratio of background and smallest object voxels
constexpr double background_only_resolution = 128.0;       // voxels along the longest side, if there is no object
constexpr double whole_background_voxel_m = 0.02;          // smaller for small backgrounds, which get at least
constexpr double whole_background_resolution = 128.0;      // voxels along the longest side
constexpr double whole_margin_vox = 4.0;
constexpr const char* background_name = "the background"; // in warnings
constexpr double progress_begin = 0.05, progress_coarse = 0.1, progress_end = 0.3;
constexpr std::size_t solved_bytes_per_voxel = 2 * sizeof (float) + 1; // the solution and the field of a coarse volume

/** \brief The voxels that one volume of a whole background may have. */
double
mostVoxels (const CoSectionOptions& options)
{
  return std::pow (blockEdge (options), 3);
}

/** \brief The box with a margin for further growth on those sides where it exceeds the grid, if one volume may be so
 * large. */
Eigen::AlignedBox3d
withRoomToGrow (const Eigen::AlignedBox3d& box, const VoxelGrid& grid, const CoSectionOptions& options)
{
  const Eigen::AlignedBox3d before = boxOf (grid);
  const double room = growth_vox * grid.voxel_size_m;
  Eigen::AlignedBox3d larger = box;
  for (int a = 0; a < 3; ++a)
  {
    if (box.min ()[a] < before.min ()[a])
      larger.min ()[a] -= room;
    if (box.max ()[a] > before.max ()[a])
      larger.max ()[a] += room;
  }
  const bool fits = (larger.sizes ().array () / grid.voxel_size_m + 1.0).prod () <= mostVoxels (options);
  return fits ? larger : box;
}

/** \brief Box of an object's grid at all of its poses, world frame. */
Eigen::AlignedBox3d
boxInWorld (const SceneObject& object)
{
  Eigen::AlignedBox3d box;
  for (const Eigen::Isometry3d& T : object.T_world_object)
    for (const Eigen::Vector3d& corner : corners (object.grid ()))
      box.extend (T * corner);
  return box;
}

/** \brief The boxes in which the background is solved. */
std::vector<Eigen::AlignedBox3d>
backgroundBoxes (const Scene& scene, const std::vector<SceneObject>& objects)
{
  std::vector<Eigen::AlignedBox3d> boxes;
  if (!scene.options.whole_background)
    for (const SceneObject& object : objects)
      boxes.push_back (boxInWorld (object));
  if (boxes.empty ())
  {
    Eigen::AlignedBox3d box;
    for (const OrientedPoint& p : scene.background)
      if (p.position.allFinite ())
        box.extend (p.position.cast<double> ());
    boxes.push_back (box);
  }
  return uniteOverlapping (std::move (boxes));
}

/** \brief Voxel sizes of the background. */
struct BackgroundVoxels
{
  double wanted_m;
  double single_m; // of one volume: the wanted size, or larger if that would need too many
};

BackgroundVoxels
backgroundVoxels (const Scene& scene, const std::vector<SceneObject>& objects, const SceneState& state,
                  const std::vector<Eigen::AlignedBox3d>& boxes)
{
  const CoSectionOptions& options = scene.options;
  double smallest = std::numeric_limits<double>::infinity ();
  for (const SceneObject& object : objects)
    smallest = std::min (smallest,
                         scene.fixedVoxelSize () ? object.observation->voxel_size_m : object.observation->spacing_m);
  const double side = boxes.front ().sizes ().maxCoeff ();
  double wanted = options.background_voxel_size_m;
  if (!options.whole_background)
  {
    if (wanted == 0.0)
      wanted = std::isfinite (smallest) ? background_voxels_per_object_voxel * smallest
                                        : side / background_only_resolution;
    return {wanted, wanted};
  }
  const double earlier = state.background.grid ? state.background.grid->voxel_size_m : 0.0;
  if (wanted == 0.0) // an earlier size is kept
    wanted = state.blocks.voxel_size_m > 0.0 ? state.blocks.voxel_size_m
             : earlier > 0.0                 ? earlier
                                             : std::min (whole_background_voxel_m, side / whole_background_resolution);
  double single = std::max (wanted, earlier);
  const auto voxelsOf = [&] (double voxel_size_m) {
    return ((boxes.front ().sizes ().array () + 2.0 * whole_margin_vox * voxel_size_m) / voxel_size_m + 1.0).prod ();
  };
  while (voxelsOf (single) > mostVoxels (options))
    single *= 2.0;
  return {wanted, single};
}

/** \brief The box with a margin of some voxels on all sides. */
Eigen::AlignedBox3d
withMargin (const Eigen::AlignedBox3d& box, double voxel_size_m)
{
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant (whole_margin_vox * voxel_size_m);
  return {box.min () - margin, box.max () + margin};
}

/** \brief The support planes of all objects, each in the region where its object may be. The last plane counts where
 * planes of several objects overlap, so they are sorted: the result must not depend on the order of objects. */
std::vector<PlaneContinuation>
continuedPlanes (const std::vector<SceneObject>& objects)
{
  std::vector<PlaneContinuation> planes;
  for (const SceneObject& object : objects)
    for (const Eigen::Vector4d& plane : object.support->planes)
      planes.push_back ({plane, boxInWorld (object)});
  const auto key = [] (const PlaneContinuation& p) {
    const Eigen::Vector3d& first = p.region.min ();
    return std::array<double, 7>{p.plane[0], p.plane[1], p.plane[2], p.plane[3], first.x (), first.y (), first.z ()};
  };
  std::sort (planes.begin (), planes.end (),
             [&] (const PlaneContinuation& a, const PlaneContinuation& b) { return key (a) < key (b); });
  return planes;
}

/** \brief Give all of the background a grid, and blocks if its voxels are to be smaller; larger ones if the memory
 * allows no more. */
void
placeWhole (const Scene& scene, const std::vector<SceneObject>& objects, CompletionMode mode, std::size_t used_bytes,
            const Eigen::AlignedBox3d& box, const BackgroundVoxels& voxels, SceneState& state, CompletionLog& log)
{
  const CoSectionOptions& options = scene.options;
  BodyState& whole = state.background;
  std::size_t others = used_bytes - (whole.grid ? estimateBytes (*whole.grid) : 0) - bytesOf (state.blocks);
  Eigen::AlignedBox3d single_box = withMargin (box, voxels.single_m);
  if (whole.grid && whole.grid->voxel_size_m == voxels.single_m && options.max_memory_bytes == 0)
    single_box = withRoomToGrow (single_box, *whole.grid, options);
  log.guardPart (background_name,
                 [&] { placeBody (single_box, voxels.single_m, 1.0, false, others, options, mode, whole); });
  if (!whole.grid || !(voxels.wanted_m < voxels.single_m))
  {
    state.blocks = {};
    return;
  }
  others += whole.grid->size () * solved_bytes_per_voxel * (mode == CompletionMode::Incremental ? 4 : 1);
  const std::vector<PlaneContinuation> planes = continuedPlanes (objects);
  for (double voxel = voxels.wanted_m; voxel < voxels.single_m; voxel *= 2.0)
  {
    const std::string reason = CompletionLog::reasonOfFailure ([&] {
      placeBlocks (scene, withMargin (box, voxel), voxel, planes, whole.options, mode, others, state.blocks);
    });
    if (reason.empty ())
      return;
    std::ostringstream warning;
    warning << background_name << " gets voxels larger than " << voxel << " m: " << reason;
    log.warn (warning.str ());
    state.blocks = {};
  }
}

/** \brief Minimise the energy of a body of the background.
 * \return nothing if it has no data
 * \param[in] progress_end when it is solved */
std::optional<BackgroundResult>
solveBody (const BodyEnergy& energy, CompletionMode mode, double progress_end, BodyState& body, CompletionLog& log)
{
  if (!energy.hasData ())
    return std::nullopt;
  BackgroundResult piece;
  log.timed ("solve", [&] {
    const ProgressCallback progress = [&] (const std::string&, double f) {
      log.report ("background", progress_begin + (progress_end - progress_begin) * f);
      return true;
    };
    if (mode == CompletionMode::Once)
      piece.solver = solve (energy, Resolution::Full, body.solution, progress);
    else
      piece.solver = followSolution (energy, body.solution, progress, piece.solved_share);
  });
  piece.signed_distance = std::make_shared<SignedDistanceField> (solvedField (energy, body.solution));
  return piece;
}

} // namespace

std::vector<SignedDistanceField::ConstPtr>
Background::fields () const
{
  std::vector<SignedDistanceField::ConstPtr> fields;
  for (const BackgroundResult& piece : pieces)
    fields.push_back (piece.signed_distance);
  return fields;
}

SensorViews
sensorViews (const Scene& scene)
{
  SensorViews views;
  for (const UsedView& view : scene.views)
    if (view.use == ViewUse::Full)
      views.emplace_back (&view.depth, view.depth.T_world_sensor);
  return views;
}

BackgroundBodies
placeBackground (const Scene& scene, const std::vector<SceneObject>& objects, CompletionMode mode,
                 std::size_t used_bytes, SceneState& state, CompletionLog& log)
{
  const CoSectionOptions& options = scene.options;
  BackgroundBodies background;
  BodyState& whole = state.background;
  if (!scene.background.empty ())
  {
    const std::vector<Eigen::AlignedBox3d> boxes = backgroundBoxes (scene, objects);
    const BackgroundVoxels voxels = backgroundVoxels (scene, objects, state, boxes);
    if (options.whole_background)
      placeWhole (scene, objects, mode, used_bytes, boxes.front (), voxels, state, log);
    else
      for (const Eigen::AlignedBox3d& box : boxes)
        log.guardPart (background_name, [&] {
          auto piece = std::make_unique<BodyState> ();
          placeBody (box, voxels.wanted_m, 1.0, false, used_bytes, options, mode, *piece);
          background.pieces.push_back (std::move (piece));
        });
  }
  if (whole.grid)
    background.bodies.push_back (&whole);
  if (!state.blocks.blocks.empty ())
    background.blocks = &state.blocks;
  for (const std::unique_ptr<BodyState>& piece : background.pieces)
    background.bodies.push_back (piece.get ());
  return background;
}

Background
solveBackground (const Scene& scene, const std::vector<SceneObject>& objects, CompletionMode mode, UpdateOutput output,
                 const BackgroundBodies& bodies, CompletionLog& log)
{
  Background background;
  if (bodies.bodies.empty ())
    return background;
  const std::vector<PlaneContinuation> planes = continuedPlanes (objects);
  const auto energyOf = [&] (BodyState& body) {
    BodyEnergy energy = log.timed ("constraints", [&] { return makeBodyEnergy (*body.evidence, planes); });
    if (mode == CompletionMode::Once)
      body.evidence.reset ();
    return energy;
  };
  if (bodies.blocks)
  {
    log.guardPart (background_name, [&] {
      BodyState& whole = *bodies.bodies.front ();
      const auto coarse = solveBody (energyOf (whole), mode, progress_coarse, whole, log);
      if (coarse)
        background = solveBlocks (scene, mode, output, bodies.points (scene), *coarse->signed_distance, *bodies.blocks,
                                  log);
    });
    return background;
  }
  for (BodyState* body : bodies.bodies)
    log.guardPart (background_name, [&] {
      const BodyEnergy energy = energyOf (*body);
      std::optional<BackgroundResult> piece = solveBody (energy, mode, progress_end, *body, log);
      if (!piece)
        return;
      if (output == UpdateOutput::Meshes)
        log.timed ("mesh", [&] {
          TriangleMesh mesh = trimmedMesh (energy, body->solution, scene.background);
          transferAttributes (scene.background, energy.grid, mesh);
          const double size_m = boxOf (energy.grid).sizes ().maxCoeff ();
          attachExpectedErrors (errorSources (energy, scene.background, sensorViews (scene), size_m, mesh), mesh);
          appendMesh (background.mesh, mesh);
        });
      background.pieces.push_back (std::move (*piece));
    });
  return background;
}

} // namespace pcl::cosection
