// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "local_solver.h"

#include "energy.h"
#include "hessian_rows.h"
#include "solver_detail.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <numeric>

namespace pcl::cosection {
namespace {

constexpr int brick_edge = 16;             // voxels
constexpr int margin = 8;                  // voxels of a box beyond its bricks, including the fixed layers
constexpr double fixed_weight = 50.0;      // of a fixed voxel, in diagonal elements of the regulariser
constexpr double interior_diagonal = 42.0; // of H^T H
// Steps of Jacobi's method that count, in tolerances of the solver:
constexpr double changed_step = 1.0;              // where the energy has changed
constexpr double disagreeing_step = 4.0;          // after boxes were solved
constexpr std::size_t largest_box = 72 * 72 * 72; // voxels; several threads need several boxes
constexpr double worthwhile_share = 0.7;          // of the whole grid's voxels
constexpr int max_sweeps = 4;

using Box = Eigen::AlignedBox3i; // both ends belong to it

std::size_t
volume (const Box& box)
{
  const Eigen::Vector3i dims = box.sizes ().array () + 1;
  return static_cast<std::size_t> (dims.x ()) * dims.y () * dims.z ();
}

/** \brief Improves a field box by box. */
class LocalSolver
{
public:
  LocalSolver (const EnergyProblem& problem, const SolverOptions& options, const NearData& near, std::vector<float>& u)
      : problem_ (problem)
      , options_ (options)
      , near_ (near)
      , u_ (u)
      , hessian_ (problem.dims, threadsForVoxels (options.threads, problem.size ()))
      , bricks_ ((problem.dims.array () + brick_edge - 1) / brick_edge)
      , tolerance_ (options, 1)
  {}

  /** \brief Boxes of bricks in which a step of Jacobi's method is longer than \a smallest_step. */
  std::vector<Box> findBoxes (double smallest_step)
  {
    std::vector<Box> boxes;
    const std::vector<float> steps = largestSteps ();
    for (int z = 0, n = 0; z < bricks_.z (); ++z)
      for (int y = 0; y < bricks_.y (); ++y)
        for (int x = 0; x < bricks_.x (); ++x, ++n)
          if (steps[n] > smallest_step)
          {
            const Eigen::Vector3i first = brick_edge * Eigen::Vector3i (x, y, z);
            boxes.emplace_back (first,
                                Eigen::Vector3i ((first.array () + brick_edge - 1).min (problem_.dims.array () - 1)));
          }
    unite (boxes);
    return boxes;
  }

  /** \brief Energy of the field when findBoxes () was last called. */
  double energy () const { return energy_; }

  std::size_t voxelsToSolve (const std::vector<Box>& boxes) const
  {
    return std::accumulate (boxes.begin (), boxes.end (), std::size_t (0),
                            [this] (std::size_t sum, const Box& box) { return sum + volume (grown (box)); });
  }

  /** \brief Solve all boxes; the summary gets the largest number of iterations. */
  void solve (const std::vector<Box>& boxes, SolverSummary& summary)
  {
    std::vector<SolverSummary> parts (boxes.size ());
    std::vector<std::vector<float>> solved (boxes.size ());
    std::atomic<std::size_t> next{0};
    const int threads = resolveThreads (options_.threads);
    parallelFor (0, threads, threads, [&] (int) {
      for (std::size_t b = next++; b < boxes.size (); b = next++)
        solved[b] = solve (boxes[b], parts[b]);
    });
    int iterations = 0;
    summary.change_vox = 0.0;
    for (std::size_t b = 0; b < boxes.size (); ++b)
    {
      const float* from = solved[b].data ();
      forEachRow (boxes[b], [&] (std::size_t at, int n) {
        std::copy_n (from, n, u_.data () + at);
        from += n;
      });
      iterations = std::max (iterations, parts[b].iterations);
      summary.change_vox = std::max (summary.change_vox, parts[b].change_vox);
    }
    summary.iterations += iterations;
  }

private:
  Box grown (const Box& box) const
  {
    return {Eigen::Vector3i ((box.min ().array () - margin).max (0)),
            Eigen::Vector3i ((box.max ().array () + margin).min (problem_.dims.array () - 1))};
  }

  /** \brief Call f (index of the first voxel, number of voxels) for every row of a box. */
  template <typename Function> void forEachRow (const Box& box, Function&& f) const
  {
    for (int k = box.min ().z (); k <= box.max ().z (); ++k)
      for (int j = box.min ().y (); j <= box.max ().y (); ++j)
        f ((static_cast<std::size_t> (k) * problem_.dims.y () + j) * problem_.dims.x () + box.min ().x (),
           box.max ().x () - box.min ().x () + 1);
  }

  /** \brief Per brick, the longest step of Jacobi's method at a voxel near data. Also updates the energy. */
  std::vector<float> largestSteps ()
  {
    const Eigen::Vector3i& dims = problem_.dims;
    const int nx = dims.x ();
    std::vector<double> energies (dims.z (), 0.0);
    const std::size_t per_plane = static_cast<std::size_t> (bricks_.x ()) * bricks_.y ();
    std::vector<float> by_plane (per_plane * dims.z (), 0.0f); // each plane is written by one thread
    hessian_.forEachRow (u_.data (), [&] (int j, int k, const float* product) {
      const std::size_t at = (static_cast<std::size_t> (k) * dims.y () + j) * nx;
      std::vector<float> residual (nx);
      std::vector<std::uint16_t> weights (nx);
      energies[k] += kernels::evaluateRow (energyRow (problem_, at), product, u_.data () + at,
                                           static_cast<float> (problem_.alpha), nx, residual.data (), weights.data ());
      float* steps = by_plane.data () + k * per_plane + static_cast<std::size_t> (j / brick_edge) * bricks_.x ();
      const auto diagonal = static_cast<float> (interior_diagonal * problem_.alpha);
      for (int i = 0; i < nx; ++i)
        if (near_.distance_vox[at + i] <= near_.reach_vox)
          steps[i / brick_edge] = std::max (steps[i / brick_edge],
                                            std::abs (residual[i]) / (diagonal + kernels::unpackWeight (weights[i])));
    });
    energy_ = std::accumulate (energies.begin (), energies.end (), 0.0);
    std::vector<float> steps (per_plane * bricks_.z (), 0.0f);
    for (int k = 0; k < dims.z (); ++k)
      for (std::size_t n = 0; n < per_plane; ++n)
        steps[k / brick_edge * per_plane + n] = std::max (steps[k / brick_edge * per_plane + n],
                                                          by_plane[k * per_plane + n]);
    return steps;
  }

  /** \brief Unite two boxes where that gives fewer voxels, margins included. */
  void unite (std::vector<Box>& boxes) const
  {
    for (std::size_t i = 0; i < boxes.size (); ++i)
      for (std::size_t j = 0; j < boxes.size (); ++j)
      {
        if (i == j)
          continue;
        const Box both = boxes[i].merged (boxes[j]);
        const std::size_t size = volume (grown (both));
        if (size > largest_box || size > volume (grown (boxes[i])) + volume (grown (boxes[j])))
          continue;
        boxes[i] = both;
        boxes.erase (boxes.begin () + static_cast<std::ptrdiff_t> (j));
        if (j < i)
          --i;
        j = static_cast<std::size_t> (-1); // all others again
      }
    std::stable_sort (boxes.begin (), boxes.end (),
                      [] (const Box& a, const Box& b) { return volume (a) > volume (b); });
  }

  /** \brief The field in a box, solved with its margin. */
  std::vector<float> solve (const Box& box, SolverSummary& summary) const
  {
    const Box domain = grown (box);
    EnergyProblem part;
    part.dims = domain.sizes ().array () + 1;
    part.alpha = problem_.alpha;
    std::vector<float> u;
    const auto extract = [&] (const auto& from, auto& to) {
      if (from.empty ())
        return;
      to.reserve (part.size ());
      forEachRow (domain,
                  [&] (std::size_t at, int n) { to.insert (to.end (), from.begin () + at, from.begin () + at + n); });
    };
    extract (problem_.weight, part.weight);
    extract (problem_.weighted_target, part.weighted_target);
    extract (problem_.exterior, part.exterior);
    extract (problem_.intersection, part.intersection);
    extract (u_, u);
    holdBorder (freeVoxels (domain), u, part);

    SolverOptions options = options_;
    options.threads = 1;
    summary = solveLevelMultigrid (part, options, tolerance_, u, {});

    std::vector<float> inner;
    inner.reserve (volume (box));
    const Eigen::Vector3i shift = box.min () - domain.min ();
    const Eigen::Vector3i dims = box.sizes ().array () + 1;
    for (int k = 0; k < dims.z (); ++k)
      for (int j = 0; j < dims.y (); ++j)
      {
        const auto row = u.begin () +
                         (static_cast<std::ptrdiff_t> (k + shift.z ()) * part.dims.y () + j + shift.y ()) *
                             part.dims.x () +
                         shift.x ();
        inner.insert (inner.end (), row, row + dims.x ());
      }
    return inner;
  }

  /** \brief The voxels of a domain that are not fixed: all but the outermost layers, except at the border of the whole
   * grid. */
  Box freeVoxels (const Box& domain) const
  {
    Eigen::Vector3i first, last;
    for (int a = 0; a < 3; ++a)
    {
      first[a] = domain.min ()[a] == 0 ? 0 : fixed_layers;
      last[a] = domain.sizes ()[a] - (domain.max ()[a] == problem_.dims[a] - 1 ? 0 : fixed_layers);
    }
    return {first, last};
  }

  const EnergyProblem& problem_;
  const SolverOptions& options_;
  const NearData& near_;
  std::vector<float>& u_;
  HessianOperator<float> hessian_;
  Eigen::Vector3i bricks_;
  LevelTolerance tolerance_;
  double energy_ = 0.0;
};

} // namespace

void
holdBorder (const Eigen::AlignedBox3i& free, const std::vector<float>& u, EnergyProblem& part)
{
  const auto weight = static_cast<float> (fixed_weight * interior_diagonal * part.alpha);
  std::size_t n = 0;
  for (int k = 0; k < part.dims.z (); ++k)
    for (int j = 0; j < part.dims.y (); ++j)
      for (int i = 0; i < part.dims.x (); ++i, ++n)
      {
        if (free.contains (Eigen::Vector3i (i, j, k)))
          continue;
        part.weight[n] = weight;
        part.weighted_target[n] = weight * u[n];
        for (std::vector<LowerBound>* bounds : {&part.exterior, &part.intersection})
          if (!bounds->empty ())
            (*bounds)[n] = LowerBound ();
      }
}

std::optional<LocalSolution>
solveNearData (const EnergyProblem& problem, const SolverOptions& options, const NearData& near, std::vector<float>& u,
               const ProgressCallback& progress)
{
  const auto start = std::chrono::steady_clock::now ();
  LocalSolver solver (problem, options, near, u);
  std::vector<Box> boxes = solver.findBoxes (changed_step * options.tolerance_vox);
  LocalSolution solution;
  SolverSummary& summary = solution.summary;
  solution.voxels = solver.voxelsToSolve (boxes);
  if (static_cast<double> (solution.voxels) > worthwhile_share * static_cast<double> (problem.size ()))
    return std::nullopt;
  for (int sweep = 0; sweep < max_sweeps && !boxes.empty (); ++sweep)
  {
    report (progress, static_cast<double> (sweep) / max_sweeps);
    solver.solve (boxes, summary);
    boxes = solver.findBoxes (disagreeing_step * options.tolerance_vox);
  }
  summary.termination = boxes.empty () ? Termination::Converged : Termination::MaxIterations;
  summary.energy = solver.energy ();
  summary.seconds = std::chrono::duration<double> (std::chrono::steady_clock::now () - start).count ();
  return solution;
}

} // namespace pcl::cosection
