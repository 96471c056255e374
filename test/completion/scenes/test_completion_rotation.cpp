// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion_scene.h"

#include <gtest/gtest.h>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

class Rotation : public testing::TestWithParam<Shape>
{};

} // namespace

/** \brief A rotation with respect to the grid changes results only by discretisation errors. */
TEST_P (Rotation, ChangesNoMoreThanDiscretisation)
{
  EXPECT_LE (effectOfMotion (GetParam (), 0.005, motion (1.1, {1.0, 2.0, -1.0}, {-0.3, 0.5, 1.1})), 0.3);
}

INSTANTIATE_TEST_SUITE_P (Table, Rotation, testing::Values (Shape::Sphere, Shape::Box, Shape::Torus, Shape::Cup),
                          [] (const auto& info) { return nameOf (info.param); });
