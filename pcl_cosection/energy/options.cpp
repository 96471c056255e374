// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/surface/options.h>

#include "pcl_cosection/common/require.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

namespace pcl::cosection {
namespace {

struct NamedPrior
{
  const char* name;
  bool Priors::*is_on;
};

constexpr NamedPrior all_priors[] = {
    {"extent", &Priors::extent},   {"symmetry", &Priors::symmetry},   {"revolution", &Priors::revolution},
    {"vessels", &Priors::vessels}, {"extrusion", &Priors::extrusion}, {"plane", &Priors::plane},
    {"rays", &Priors::rays},       {"learned", &Priors::learned},     {"proposals", &Priors::proposals}};

} // namespace

std::string
Priors::names () const
{
  std::string names;
  std::size_t count = 0;
  for (const NamedPrior& prior : all_priors)
    if (this->*prior.is_on)
      names += (count++ > 0 ? "," : "") + std::string (prior.name);
  return count == std::size (all_priors) ? "all" : count == 0 ? "none" : names;
}

Priors
Priors::named (const std::string& names)
{
  if (names == "all")
    return {};
  Priors priors;
  std::string known;
  for (const NamedPrior& prior : all_priors)
  {
    priors.*prior.is_on = false;
    known += std::string (prior.name) + ", ";
  }
  if (names == "none")
    return priors;
  std::istringstream list (names + ",");
  for (std::string name; std::getline (list, name, ',');)
  {
    const auto* const found = std::find_if (std::begin (all_priors), std::end (all_priors),
                                            [&] (const NamedPrior& prior) { return name == prior.name; });
    if (found == std::end (all_priors))
      throw InvalidArgument ("unknown prior \"" + name + "\"; there are " + known + "and all or none alone");
    priors.*found->is_on = true;
  }
  return priors;
}

CoSectionOptions
CoSectionOptions::paper ()
{
  CoSectionOptions o;
  o.resolution = 64;
  o.background_voxel_size_m = 0.02;
  o.use_planes = false;
  o.use_extent_prior = false;
  o.carve_free_space = false;
  o.revise_votes = false;
  o.intersect_solved = false;
  o.alpha = 0.005;
  o.beta_hull = 0.001;
  o.beta_inter = 0.001;
  o.weighting = Weighting::Sum;
  o.hull_distance = HullDistance::OneVoxel;
  o.max_passes = 1;
  o.solver.type = SolverType::FastJacobi;
  o.solver.cycle_length = 20;
  return o;
}

Priors
CoSectionOptions::activePriors () const
{
  Priors active = priors;
  for (const auto part : {&Priors::symmetry, &Priors::revolution, &Priors::vessels, &Priors::extrusion, &Priors::plane})
    active.*part = priors.*part && use_extent_prior && use_symmetric_extent;
  active.plane = active.plane && use_planes;
  active.extent = priors.extent && use_extent_prior;
  active.rays = priors.rays && use_extent_prior;
  active.learned = priors.learned && use_extent_prior;
  active.proposals = priors.proposals && use_extent_prior;
  return active;
}

void
CoSectionOptions::validate () const
{
  const auto finite = [] (double v) { return std::isfinite (v); };
  require (finite (voxel_size_m) && voxel_size_m >= 0.0, "voxel size", voxel_size_m, "positive, in metres");
  require (resolution == 0 || (resolution >= 4 && resolution <= 2048), "resolution", resolution,
           "between 4 and 2048 voxels");
  require (padding >= 0.0 && padding <= 10.0, "padding", padding, "between 0 and 10");
  require (finite (background_voxel_size_m) && background_voxel_size_m >= 0.0, "background voxel size",
           background_voxel_size_m, "positive, in metres");
  require (background_block_vox == 0 || (background_block_vox >= 32 && background_block_vox <= 1024),
           "background block", background_block_vox, "between 32 and 1024 voxels, or 0");
  require (alpha > 0.0 && alpha <= 1e6, "alpha", alpha, "positive and at most 1e6");
  require (beta_hull >= 0.0 && beta_hull <= 1e6, "beta-hull", beta_hull, "between 0 and 1e6");
  require (beta_inter >= 0.0 && beta_inter <= 1e6, "beta-inter", beta_inter, "between 0 and 1e6");
  require (beta_extent >= 0.0 && beta_extent <= 1e6, "beta-extent", beta_extent, "between 0 and 1e6");
  require (sigma_vox > 0.0 && sigma_vox <= 10.0, "sigma", sigma_vox, "positive and at most 10 voxels");
  require (max_bound_vox > 0.0 && max_bound_vox <= 100.0, "largest intersection distance", max_bound_vox,
           "positive and at most 100 voxels");
  require (max_passes >= 1 && max_passes <= 100, "number of passes", max_passes, "between 1 and 100");
  require (threads >= 0 && threads <= 1024, "number of threads", threads, "between 0 (all) and 1024");
  require (solver.max_iterations >= 1, "number of iterations", solver.max_iterations, "at least 1");
  require (finite (solver.tolerance_vox) && solver.tolerance_vox > 0.0, "tolerance", solver.tolerance_vox,
           "positive, in voxels");
  require (finite (solver.peak_tolerance_vox) && solver.peak_tolerance_vox >= 0.0, "peak tolerance",
           solver.peak_tolerance_vox, "positive, in voxels, or 0");
  require (solver.cycle_length >= 1 && solver.cycle_length <= 1000, "cycle length", solver.cycle_length,
           "between 1 and 1000");
  require (solver.smoothing_degree >= 1 && solver.smoothing_degree <= 20, "smoothing degree", solver.smoothing_degree,
           "between 1 and 20");
}

} // namespace pcl::cosection
