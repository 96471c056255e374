// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "solver_problems.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace pcl::cosection::test {
namespace {

constexpr float bound_weight = 0.01f;

EnergyProblem
randomProblem (const Eigen::Vector3i& dims)
{
  std::mt19937 generator (17);
  std::uniform_real_distribution<float> uniform (0.0f, 1.0f);
  EnergyProblem problem;
  problem.dims = dims;
  problem.exterior.resize (problem.size ());
  problem.intersection.resize (problem.size ());
  for (std::size_t n = 0; n < problem.size (); ++n)
  {
    const float weight = uniform (generator) < 0.1f ? uniform (generator) : 0.0f;
    problem.weight.push_back (weight);
    problem.weighted_target.push_back (weight * (6.0f * uniform (generator) - 3.0f));
    for (auto* bounds : {&problem.exterior, &problem.intersection})
      if (uniform (generator) < 0.3f)
        (*bounds)[n] = LowerBound (3.0f * uniform (generator), 0.1f * uniform (generator));
  }
  return problem;
}

} // namespace

EnergyProblem
makeProblem (ProblemKind kind, const Eigen::Vector3i& dims)
{
  if (kind == ProblemKind::Random)
    return randomProblem (dims);
  EnergyProblem problem;
  problem.dims = dims;
  problem.weight.resize (problem.size (), 0.0f);
  problem.weighted_target.resize (problem.size (), 0.0f);
  const bool hull = kind != ProblemKind::HalfSphere;
  const bool bodies = kind == ProblemKind::All;
  if (hull)
    problem.exterior.resize (problem.size ());
  if (bodies)
    problem.intersection.resize (problem.size ());
  const Eigen::Vector3d centre = 0.5 * (dims.cast<double> () - Eigen::Vector3d::Ones ());
  const double radius = 0.3 * dims.maxCoeff ();
  std::size_t n = 0;
  for (int k = 0; k < dims.z (); ++k)
    for (int j = 0; j < dims.y (); ++j)
      for (int i = 0; i < dims.x (); ++i, ++n)
      {
        const Eigen::Vector3d p = Eigen::Vector3d (i, j, k) - centre;
        const double s = p.norm () - radius;
        const bool seen = p.sum () < 0.0;
        if (seen && std::abs (s) < 2.0)
        {
          problem.weight[n] = static_cast<float> (std::exp (-s * s));
          problem.weighted_target[n] = static_cast<float> (problem.weight[n] * s);
        }
        else if (hull && seen && s >= 3.0)
          problem.exterior[n] = LowerBound (static_cast<float> (s - 2.0), bound_weight);
        if (bodies && p.z () < -radius)
          problem.intersection[n] = LowerBound (static_cast<float> (std::min (5.0, -radius - p.z ())), bound_weight);
      }
  return problem;
}

std::string
nameOf (ProblemKind kind)
{
  const char* names[] = {"HalfSphere", "Hull", "All", "Random"};
  return names[static_cast<int> (kind)];
}

} // namespace pcl::cosection::test
