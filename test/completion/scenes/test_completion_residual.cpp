// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "neighbour_scene.h"

#include <gtest/gtest.h>

#include <tuple>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

class NeighbourResidual : public testing::TestWithParam<std::tuple<int, bool>> // overlap of the data, extent prior
{};

class BackgroundResidual : public testing::TestWithParam<Shape>
{};

} // namespace

/** \brief The passes over all objects end without penetration whatever the data and the other terms. */
TEST_P (NeighbourResidual, IsResolvedByGrowingWeights)
{
  CoSectionOptions options = optionsFor (neighbour_voxel_m);
  options.use_extent_prior = std::get<1> (GetParam ());
  const SceneResult result = complete (touchingBoxes (std::get<0> (GetParam ())), options);
  EXPECT_LE (deepestPenetration (result), about_a_voxel);
}

INSTANTIATE_TEST_SUITE_P (DataOverlap, NeighbourResidual,
                          testing::Values (std::make_tuple (2, true), std::make_tuple (3, true),
                                           std::make_tuple (0, false)));

/** \brief Penetration of the background by more than half the coarser voxel, its own, is resolved as well. */
TEST_P (BackgroundResidual, IsResolvedByGrowingWeights)
{
  for (const double voxel_m : {0.005, 0.007})
  {
    const RenderedView seen = tableScene (GetParam ()).render (tableCamera (), fromAbove ());
    const ObjectResult object = complete (seen, optionsFor (voxel_m)).objects.at (0);
    EXPECT_LE (object.penetration_m, 0.5 * 2.0 * voxel_m) << "voxel " << voxel_m;
  }
}

INSTANTIATE_TEST_SUITE_P (Table, BackgroundResidual,
                          testing::Values (Shape::Sphere, Shape::Box, Shape::Torus, Shape::Cup),
                          [] (const auto& info) { return nameOf (info.param); });
