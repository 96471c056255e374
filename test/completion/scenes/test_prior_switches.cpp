// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion_scene.h"
#include "surrounding_views.h"

#include <gtest/gtest.h>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief Mean distance from the true surface, metres. */
double
errorOf (Shape shape, const Priors& priors)
{
  const AnalyticScene scene = tableScene (shape);
  CoSectionOptions options = optionsFor (voxel_m);
  options.priors = priors;
  const TriangleMesh mesh = complete (scene.render (tableCamera (), fromAbove ()), options).objects.at (0).mesh;
  EXPECT_TRUE (computeTopology (mesh).closed_manifold);
  return meanError (mesh, scene.shape (1));
}

Priors
allBut (bool Priors::*first, bool Priors::*second = nullptr)
{
  Priors priors;
  priors.*first = false;
  if (second)
    priors.*second = false;
  return priors;
}

} // namespace

/** \brief What one prior makes right is wrong without it. */
TEST (PriorSwitches, TakeAwayWhatThePriorExpects)
{
  const double ball_m = errorOf (Shape::Sphere, {}), cup_m = errorOf (Shape::Cup, {}), box_m = errorOf (Shape::Box, {});
  EXPECT_GT (errorOf (Shape::Sphere, allBut (&Priors::revolution, &Priors::symmetry)), 4.0 * ball_m);
  EXPECT_GT (errorOf (Shape::Cup, allBut (&Priors::vessels)), 4.0 * cup_m);
  EXPECT_GT (errorOf (Shape::Box, allBut (&Priors::extrusion, &Priors::symmetry)), 4.0 * box_m);
  EXPECT_GT (errorOf (Shape::Box, Priors::named ("none")), 6.0 * box_m);
}
