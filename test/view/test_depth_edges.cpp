// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/view/visibility/depth_edges.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pcl::cosection;

TEST (DepthEdges, WhatIsSurelyAnEdgeIsNotTakenForOneSurface)
{
  constexpr double vga_focal_px = 525.0;
  for (const double depth_m : {0.3, 0.5, 1.0, 2.0, 4.0})
    EXPECT_LT (largestSurfaceStep (depth_m, depth_m / vga_focal_px), smallestEdgeStep (depth_m));
}

TEST (DepthEdges, NoiseAndTiltAreExplained)
{
  const double depth_m = 1.0, across_m = 0.002;
  EXPECT_GT (largestSurfaceStep (depth_m, across_m), 3.0 * depthNoiseSigma (depth_m));
  const double tan_75_degrees = std::tan (75.0 / 180.0 * M_PI);
  EXPECT_NEAR (tan_75_degrees * across_m, largestSurfaceStep (depth_m, across_m) - largestSurfaceStep (depth_m, 0.0),
               0.01 * across_m * tan_75_degrees);
}
