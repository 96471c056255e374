// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "background.h"

#include "pcl_cosection/common/boxes.h"
#include "pcl_cosection/energy/body_mesh.h"
#include "pcl_cosection/energy/expected_error.h"
#include "pcl_cosection/mesh/mesh_attributes.h"
#include "place_bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr double background_voxels_per_object_voxel = 2.0; // size ratio of background and smallest object voxels
constexpr double background_only_resolution = 128.0;       // voxels along the longest side, if there is no object
constexpr double whole_background_voxel_m = 0.02;          // smaller for small backgrounds, which get at least
constexpr double whole_background_resolution = 128.0;      // voxels along the longest side
constexpr double most_whole_voxels = 256.0 * 256.0 * 256.0;
constexpr double whole_margin_vox = 4.0;
constexpr const char* background_name = "the background"; // in warnings
constexpr double growth_vox = 12.0; // margin of an incremental background where it grows, as it will grow again

/** \brief The box with a margin for further growth on those sides where it exceeds the grid, if memory allows. */
Eigen::AlignedBox3d
withRoomToGrow (const Eigen::AlignedBox3d& box, const VoxelGrid& grid)
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
  const bool fits = (larger.sizes ().array () / grid.voxel_size_m + 1.0).prod () <= most_whole_voxels;
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

double
backgroundVoxelSize (const Scene& scene, const std::vector<SceneObject>& objects, const BodyState& whole,
                     const std::vector<Eigen::AlignedBox3d>& boxes)
{
  const CoSectionOptions& options = scene.options;
  if (options.background_voxel_size_m > 0.0)
    return options.background_voxel_size_m;
  double smallest = std::numeric_limits<double>::infinity ();
  for (const SceneObject& object : objects)
    smallest = std::min (smallest,
                         scene.fixedVoxelSize () ? object.observation->voxel_size_m : object.observation->spacing_m);
  const double side = boxes.front ().sizes ().maxCoeff ();
  if (!options.whole_background)
    return std::isfinite (smallest) ? background_voxels_per_object_voxel * smallest : side / background_only_resolution;
  double voxel = std::min (whole_background_voxel_m, side / whole_background_resolution);
  if (whole.grid) // kept unless it is too small
    voxel = whole.grid->voxel_size_m;
  const auto voxelsOf = [&] (double voxel_size_m) {
    return ((boxes.front ().sizes ().array () + 2.0 * whole_margin_vox * voxel_size_m) / voxel_size_m + 1.0).prod ();
  };
  while (voxelsOf (voxel) > most_whole_voxels)
    voxel *= 2.0;
  return voxel;
}

/** \brief The views from which the background has points. */
SensorViews
sensorViews (const Scene& scene)
{
  SensorViews views;
  for (const UsedView& view : scene.views)
    if (view.use == ViewUse::Full)
      views.emplace_back (&view.depth, view.depth.T_world_sensor);
  return views;
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

} // namespace

std::vector<SignedDistanceField::ConstPtr>
Background::fields () const
{
  std::vector<SignedDistanceField::ConstPtr> fields;
  for (const BackgroundResult& piece : pieces)
    fields.push_back (piece.signed_distance);
  return fields;
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
    const double voxel = backgroundVoxelSize (scene, objects, whole, boxes);
    if (options.whole_background)
    {
      const Eigen::Vector3d margin = Eigen::Vector3d::Constant (whole_margin_vox * voxel);
      Eigen::AlignedBox3d box (boxes.front ().min () - margin, boxes.front ().max () + margin);
      if (whole.grid && whole.grid->voxel_size_m == voxel && options.max_memory_bytes == 0)
        box = withRoomToGrow (box, *whole.grid);
      const std::size_t others = used_bytes - (whole.grid ? estimateBytes (*whole.grid) : 0);
      log.guardPart (background_name, [&] { placeBody (box, voxel, 1.0, false, others, options, mode, whole); });
    }
    else
      for (const Eigen::AlignedBox3d& box : boxes)
        log.guardPart (background_name, [&] {
          auto piece = std::make_unique<BodyState> ();
          placeBody (box, voxel, 1.0, false, used_bytes, options, mode, *piece);
          background.pieces.push_back (std::move (piece));
        });
  }
  if (whole.grid)
    background.bodies.push_back (&whole);
  for (const std::unique_ptr<BodyState>& piece : background.pieces)
    background.bodies.push_back (piece.get ());
  return background;
}

Background
solveBackground (const Scene& scene, const std::vector<SceneObject>& objects, CompletionMode mode, UpdateOutput output,
                 const std::vector<BodyState*>& bodies, CompletionLog& log)
{
  Background background;
  if (bodies.empty ())
    return background;
  const std::vector<PlaneContinuation> planes = continuedPlanes (objects);
  const auto solveBody = [&] (BodyState& body) {
    const BodyEnergy energy = log.timed ("constraints", [&] { return makeBodyEnergy (*body.evidence, planes); });
    if (mode == CompletionMode::Once)
      body.evidence.reset ();
    if (!energy.hasData ())
      return;
    BackgroundResult piece;
    log.timed ("solve", [&] {
      const ProgressCallback progress = [&] (const std::string&, double f) {
        log.report ("background", 0.05 + 0.25 * f);
        return true;
      };
      if (mode == CompletionMode::Once)
        piece.solver = solve (energy, Resolution::Full, body.solution, progress);
      else
        piece.solver = followSolution (energy, body.solution, progress, piece.solved_share);
    });
    if (output == UpdateOutput::Meshes)
      log.timed ("mesh", [&] {
        TriangleMesh mesh = trimmedMesh (energy, body.solution, scene.background);
        transferAttributes (scene.background, energy.grid, mesh);
        const double size_m = boxOf (energy.grid).sizes ().maxCoeff ();
        attachExpectedErrors (errorSources (energy, scene.background, sensorViews (scene), size_m, mesh), mesh);
        appendMesh (background.mesh, mesh);
      });
    piece.signed_distance = std::make_shared<SignedDistanceField> (solvedField (energy, body.solution));
    background.pieces.push_back (std::move (piece));
  };
  for (BodyState* body : bodies)
    log.guardPart (background_name, [&] { solveBody (*body); });
  return background;
}

} // namespace pcl::cosection
