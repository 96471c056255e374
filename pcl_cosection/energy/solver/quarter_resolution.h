// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/surface/solver.h>

#include <vector>

namespace pcl::cosection
{

/** \brief A field on voxels of four times the size that goes with one at full resolution while the problem changes:
 * what the change makes of it is added to the other, which keeps its detail. As differences add up to one, errors of
 * many changes do not. */
class QuarterResolution
{
public:
  /** \param[in,out] u the minimiser before the change, then near the one after it, but for detail; if its size is
   * wrong, a start for solve ()
   * \return whether this followed a change; false the first time, and always if the solver has no such level
   * \throws Cancelled; then nothing was done, but for a start */
  bool update (const EnergyProblem& problem, const SolverOptions& options, std::vector<float>& u,
               const ProgressCallback& progress);

private:
  std::vector<float> u_; // in voxels of full resolution
};

} // namespace pcl::cosection
