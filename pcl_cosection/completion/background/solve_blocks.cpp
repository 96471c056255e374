// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "solve_blocks.h"

#include "background_blocks.h"
#include "pcl_cosection/common/boxes.h"
#include "pcl_cosection/energy/body_mesh.h"
#include "pcl_cosection/energy/data/imls_data_term.h"
#include "pcl_cosection/energy/expected_error.h"
#include "pcl_cosection/mesh/mesh_attributes.h"
#include "pcl_cosection/volume/lattice_weld.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

namespace pcl::cosection {
namespace {

using Box = Eigen::AlignedBox3i;

constexpr int max_sweeps = 4;
constexpr int seam_layers = 2;                // beside a block, in which its field is compared with its neighbours'
constexpr float seam_tolerance_vox = 0.03f;   // largest difference of the fields of neighbours near the surface
constexpr float near_surface_vox = 2.0f;      // where it counts
constexpr float warned_difference_vox = 0.1f; // what remains of such a difference is a warning from here on
constexpr double begin = 0.1, swept = 0.25, end = 0.3; // progress: at the first block, after one sweep, after all

/** \brief Points in a volume, or so near that they count there. */
std::vector<OrientedPoint>
pointsNear (const std::vector<OrientedPoint>& points, std::size_t first, const VoxelGrid& grid, double margin_vox)
{
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant (margin_vox * grid.voxel_size_m);
  const Eigen::AlignedBox3d box (boxOf (grid).min () - margin, boxOf (grid).max () + margin);
  std::vector<OrientedPoint> near;
  std::copy_if (points.begin () + static_cast<std::ptrdiff_t> (std::min (first, points.size ())), points.end (),
                std::back_inserter (near),
                [&] (const OrientedPoint& point) { return box.contains (point.position.cast<double> ()); });
  return near;
}

/** \brief A field at a place, voxels of \a voxel_size_m; beyond the field's grid that of the nearest place in it, and
 * the distance from there. */
float
valueNear (const SignedDistanceField& field, const Eigen::Vector3d& place, double voxel_size_m)
{
  const Eigen::AlignedBox3d box = boxOf (field.grid);
  const Eigen::Vector3d inside = place.cwiseMax (box.min ()).cwiseMin (box.max ());
  const Eigen::Vector3d last = field.grid.dims.cast<double> ().array () - 1.0;
  const auto value = field.sampleVoxel (field.grid.toVoxel (inside).cwiseMax (0.0).cwiseMin (last));
  return static_cast<float> ((value.value_or (0.0f) + (place - inside).norm ()) / voxel_size_m);
}

class BlockSolver
{
public:
  BlockSolver (const Scene& scene, const std::vector<OrientedPoint>& points, const SignedDistanceField& coarse,
               BackgroundBlocks& blocks, CompletionLog& log)
      : scene_ (scene)
      , points_ (points)
      , coarse_ (coarse)
      , blocks_ (blocks)
      , log_ (log)
  {}

  /** \brief Find the blocks with new evidence, and give each block a field. */
  void prepare ()
  {
    for (auto& [place, block] : blocks_.blocks)
    {
      BodyState& body = block.body;
      const std::vector<std::uint8_t> free_space = body.evidence->freeSpace ();
      if (!std::equal (free_space.begin (), free_space.end (), block.free_space.begin (), block.free_space.end ()))
        block.is_current = false;
      block.free_space.assign (free_space.begin (), free_space.end ());
      const double reach_vox = cutoff_sigmas * body.options.sigma_vox;
      if (block.is_current && !pointsNear (points_, body.points_read, *body.grid, reach_vox).empty ())
        block.is_current = false;
      body.points_read = points_.size ();
      if (!body.solution.has (Resolution::Full))
        startFromCoarse (body);
    }
  }

  /** \brief Solve blocks one after the other, until all agree. */
  void sweep ()
  {
    float difference_vox = 0.0f;
    for (int sweep = 0; sweep < max_sweeps; ++sweep)
    {
      const auto count = static_cast<double> (std::count_if (
          blocks_.blocks.begin (), blocks_.blocks.end (), [] (const auto& entry) { return !entry.second.is_current; }));
      double done = 0.0;
      for (auto& [place, block] : blocks_.blocks)
        if (!block.is_current)
        {
          solveBlock (block, [&] (const std::string&, double f) {
            report (sweep, (done + f) / count);
            return true;
          });
          block.is_current = true;
          ++done;
        }
      if (count == 0.0)
        return;
      difference_vox = findDisagreement ();
      if (difference_vox == 0.0f)
        return;
    }
    for (auto& [place, block] : blocks_.blocks)
      block.is_current = true; // as near as it gets
    if (difference_vox > warned_difference_vox)
    {
      std::ostringstream text;
      text.precision (2);
      text << "the background: where its blocks meet, their surfaces differ by up to " << difference_vox << " voxels";
      log_.warn (text.str ());
    }
  }

  /** \brief The fields, and a mesh if asked for. */
  Background result (CompletionMode mode, UpdateOutput output)
  {
    Background background;
    for (auto& [place, block] : blocks_.blocks)
      takeFromNeighbours (blocks_, block);
    for (auto& entry : blocks_.blocks)
    {
      BackgroundBlock& block = entry.second;
      log_.report ("background", end);
      if (!block.has_data)
        continue;
      const BodyEnergy energy = log_.timed ("constraints", [&] { return energyOf (block); });
      BackgroundResult piece;
      piece.solver = block.solver;
      piece.solved_share = block.solved_share;
      const SignedDistanceField field = solvedField (energy, block.body.solution);
      if (output == UpdateOutput::Meshes)
        log_.timed ("mesh", [&] { appendMesh (block, energy, background.mesh); });
      if (mode == CompletionMode::Once)
        block.body.solution = {};
      piece.signed_distance = std::make_shared<SignedDistanceField> (ownPart (block, field));
      background.pieces.push_back (std::move (piece));
    }
    log_.timed ("mesh", [&] {
      const VoxelGrid whole = gridOf (blocks_, blocks_.whole);
      const Eigen::Vector3i seams = blocks_.whole.min ();
      background.mesh = weldVertices (background.mesh, whole, blocks_.core_edge, seams);
      transferAttributes (scene_.background, whole, background.mesh);
    });
    return background;
  }

private:
  void report (int sweep, double share) const
  {
    const double first = sweep == 0 ? begin : swept + (end - swept) * (sweep - 1) / (max_sweeps - 1);
    const double next = swept + (end - swept) * sweep / (max_sweeps - 1);
    log_.report ("background", first + (next - first) * share);
  }

  void startFromCoarse (BodyState& body) const
  {
    const VoxelGrid& grid = *body.grid;
    std::vector<float>& u = body.solution.u;
    u.resize (grid.size ());
    parallelFor (0, grid.dims.z (), scene_.options.threads, [&] (int k) {
      for (int j = 0; j < grid.dims.y (); ++j)
        for (int i = 0; i < grid.dims.x (); ++i)
          u[grid.index (i, j, k)] = valueNear (coarse_, grid.center (i, j, k), grid.voxel_size_m);
    });
    body.solution.solved_fully = true;
  }

  /** \brief The energy of a block on its domain. */
  BodyEnergy energyOf (BackgroundBlock& block) const
  {
    BodyState& body = block.body;
    body.evidence->addPoints (pointsNear (points_, 0, *body.grid, cutoff_sigmas * body.options.sigma_vox));
    std::vector<PlaneContinuation> planes;
    const Eigen::AlignedBox3d box = boxOf (*body.grid);
    std::copy_if (blocks_.planes.begin (), blocks_.planes.end (), std::back_inserter (planes),
                  [&] (const PlaneContinuation& plane) { return plane.region.intersects (box); });
    BodyEnergy energy = makeBodyEnergy (*body.evidence, planes);
    body.evidence->forgetPoints ();
    return energy;
  }

  /** \brief Solve a block from its present field, with the fields around it as its boundary. */
  void solveBlock (BackgroundBlock& block, const ProgressCallback& progress)
  {
    BodyEnergy energy = log_.timed ("constraints", [&] { return energyOf (block); });
    block.has_data = energy.hasData ();
    block.seam.clear ();
    block.solved_share = 1.0;
    const int before = block.solver.iterations;
    block.solver = {};
    block.solver.termination = Termination::Converged;
    if (!block.has_data)
      return;
    findSeam (block, energy);
    takeFromNeighbours (blocks_, block);
    BodySolution& solution = block.body.solution;
    holdBorder (freeVoxels (blocks_, block), solution.u, energy.problem);
    log_.timed ("solve", [&] { block.solver = solve (energy, Resolution::Full, solution, progress); });
    block.solver.iterations += before;
  }

  /** \brief The voxels beside a block at which its field should be that of its neighbours. */
  void findSeam (BackgroundBlock& block, const BodyEnergy& energy) const
  {
    const Box beside = Box (Eigen::Vector3i (block.core.min ().array () - seam_layers),
                            Eigen::Vector3i (block.core.max ().array () + seam_layers))
                           .intersection (block.domain);
    forEachVoxelOf (block, beside, [&] (const Eigen::Vector3i& voxel, std::size_t n) {
      if (!block.core.contains (voxel) && !energy.free_space[n] &&
          energy.data_distance_vox[n] <= energy.options.max_bound_vox)
        block.seam.push_back (n);
    });
  }

  /** \brief Find the blocks that have to be solved again. \return the largest difference; 0 if there are none */
  float findDisagreement ()
  {
    float largest_vox = 0.0f;
    for (auto& [place, block] : blocks_.blocks)
      for (const std::size_t n : block.seam)
      {
        const float u = block.body.solution.u[n];
        const Eigen::Vector3i& dims = block.body.grid->dims;
        const auto at = static_cast<std::ptrdiff_t> (n);
        const Eigen::Vector3i voxel = block.domain.min () +
                                      Eigen::Vector3i (static_cast<int> (at % dims.x ()),
                                                       static_cast<int> (at / dims.x () % dims.y ()),
                                                       static_cast<int> (at / dims.x () / dims.y ()));
        BackgroundBlock* const owner = ownerOf (blocks_, voxel);
        if (!owner || std::abs (u) > near_surface_vox)
          continue;
        const Eigen::Vector3i there = voxel - owner->domain.min ();
        const std::size_t m = owner->body.grid->index (there.x (), there.y (), there.z ());
        const float difference_vox = std::abs (u - owner->body.solution.u[m]);
        if (difference_vox <= seam_tolerance_vox)
          continue;
        block.is_current = owner->is_current = false;
        largest_vox = std::max (largest_vox, difference_vox);
      }
    return largest_vox;
  }

  /** \brief The voxels from the first of a block to the first of the next ones: cells between them are the block's. */
  Box ownVoxels (const BackgroundBlock& block) const
  {
    return Box (block.core.min (), Eigen::Vector3i (block.core.max ().array () + 1)).intersection (blocks_.whole);
  }

  /** \brief Append the mesh of the surface in the cells of a block. */
  void appendMesh (const BackgroundBlock& block, const BodyEnergy& energy, TriangleMesh& all) const
  {
    const Box own = ownVoxels (block);
    const Box cells (Eigen::Vector3i (own.min () - block.domain.min ()),
                     Eigen::Vector3i (own.max () - block.domain.min ()));
    const std::vector<OrientedPoint> near = pointsNear (scene_.background, 0, energy.grid, 0.5);
    TriangleMesh mesh = trimmedMesh (energy, block.body.solution, near, cells);
    if (mesh.empty ())
      return;
    const double size_m = boxOf (gridOf (blocks_, blocks_.whole)).sizes ().maxCoeff ();
    attachExpectedErrors (errorSources (energy, near, sensorViews (scene_), size_m, mesh), mesh);
    if (all.empty ())
      all = std::move (mesh);
    else
      cosection::appendMesh (all, mesh);
  }

  /** \brief The part of a field that is a block's, as far as it is supported: the smallest box with all supported
   * voxels and those around them. */
  SignedDistanceField ownPart (const BackgroundBlock& block, const SignedDistanceField& field) const
  {
    const Box own = ownVoxels (block);
    Box supported;
    forEachVoxelOf (block, own, [&] (const Eigen::Vector3i& voxel, std::size_t n) {
      if (field.supported[n])
        supported.extend (voxel);
    });
    if (supported.isEmpty ())
      supported.extend (own.min ());
    const Box part = Box (Eigen::Vector3i (supported.min ().array () - 1),
                          Eigen::Vector3i (supported.max ().array () + 1))
                         .intersection (own);
    SignedDistanceField result;
    result.grid = gridOf (blocks_, part);
    result.values.reserve (result.grid.size ());
    result.supported.reserve (result.grid.size ());
    forEachVoxelOf (block, part, [&] (const Eigen::Vector3i&, std::size_t n) {
      result.values.push_back (field.values[n]);
      result.supported.push_back (field.supported[n]);
    });
    return result;
  }

  const Scene& scene_;
  const std::vector<OrientedPoint>& points_;
  const SignedDistanceField& coarse_;
  BackgroundBlocks& blocks_;
  CompletionLog& log_;
};

} // namespace

Background
solveBlocks (const Scene& scene, CompletionMode mode, UpdateOutput output, const std::vector<OrientedPoint>& points,
             const SignedDistanceField& coarse, BackgroundBlocks& blocks, CompletionLog& log)
{
  BlockSolver solver (scene, points, coarse, blocks, log);
  solver.prepare ();
  solver.sweep ();
  return solver.result (mode, output);
}

} // namespace pcl::cosection
