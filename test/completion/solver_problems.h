// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/surface/solver.h>

#include <string>

namespace pcl::cosection::test {

/** \brief Problems like those of a reconstruction, and a random one. */
enum class ProblemKind
{
  HalfSphere, ///< data on one side of a sphere, nothing else
  Hull,       ///< the same with free space on that side
  All,        ///< the same with free space and a half space that the sphere touches
  Random,     ///< data, targets and bounds at random
};

/** \brief A problem on a grid of any size; lengths follow its longest side. */
EnergyProblem makeProblem (ProblemKind kind, const Eigen::Vector3i& dims);

std::string nameOf (ProblemKind kind);

} // namespace pcl::cosection::test
