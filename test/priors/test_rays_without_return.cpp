// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/priors/rays_without_return.h"
#include "pcl_cosection/view/range_image.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pcl::cosection;

namespace {

constexpr double radius_m = 0.05;
const Eigen::Vector3d middle (0.0, 0.0, 0.5); // of a ball before a sensor at the origin

/** \brief What the sensor sees of it, a millimetre apart, without an order. */
std::vector<Eigen::Vector3f>
frontOfBall ()
{
  std::vector<Eigen::Vector3f> points;
  for (double x = -radius_m; x <= radius_m; x += 0.001)
    for (double y = -radius_m; y <= radius_m; y += 0.001)
      if (const double square = radius_m * radius_m - x * x - y * y; square > 0.0)
        points.push_back ((middle + Eigen::Vector3d (x, y, -std::sqrt (square))).cast<float> ());
  return points;
}

} // namespace

TEST (RaysWithoutReturn, GoPastPointsWithoutAnOrder)
{
  const std::vector<Eigen::Vector3f> positions = frontOfBall ();
  std::vector<OrientedPoint> points;
  for (const Eigen::Vector3f& position : positions)
    points.push_back ({position, (position - middle.cast<float> ()).normalized ()});
  const auto image = drawRangeImage (positions, Eigen::Vector3d::Zero ());
  ASSERT_TRUE (image);
  const DepthView view = withSurroundings (image->view);
  VoxelGrid grid;
  grid.voxel_size_m = 0.005;
  grid.dims.setConstant (29);
  grid.origin_m = middle - Eigen::Vector3d::Constant (0.07);
  const std::vector<std::uint8_t> open = findRaysWithoutReturn (grid, {{&view, view.T_world_sensor}}, points, 1);
  std::size_t inside = 0, beside = 0, open_beside = 0;
  for (int k = 0; k < grid.dims.z (); ++k)
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        const Eigen::Vector3d p = grid.center (i, j, k);
        const double from_axis_m = p.head<2> ().norm () * middle.z () / p.z (); // along the ray, at the ball
        const bool is_open = open[grid.index (i, j, k)] != 0;
        inside += from_axis_m < radius_m && is_open;
        beside += from_axis_m > radius_m + 0.012;
        open_beside += from_axis_m > radius_m + 0.012 && is_open;
      }
  EXPECT_EQ (inside, 0u);
  EXPECT_GT (beside, 3000u);
  EXPECT_EQ (open_beside, beside);
}
