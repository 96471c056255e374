// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// What a plane that is given says of points whose labels, or sides, are not known.

#include "io/pcd_view_fixture.h"

#include "pcl_cosection/view/given_ground.h"

#include <random>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief A cone of a metre on ground about it with some noise; every third point is of the cone. */
SensorCloud
coneOnGround (float noise_m)
{
  std::mt19937 random (8);
  std::uniform_real_distribution<float> along (-3.0f, 3.0f);
  std::normal_distribution<float> noise (0.0f, noise_m);
  SensorCloud cloud;
  while (cloud.positions.size () < 9000)
  {
    const Eigen::Vector2f at (along (random), along (random));
    if ((at.norm () < 1.5f) == (cloud.positions.size () % 3 == 0))
      cloud.positions.emplace_back (at.x (), at.y (), std::max (0.0f, 1.0f - at.norm () / 1.5f) + noise (random));
  }
  cloud.labels.assign (cloud.positions.size (), 1);
  return cloud;
}

PcdViewOptions
groundPlane (double height = 0.0)
{
  PcdViewOptions options;
  options.planes = {{0.0, 0.0, 2.0, -2.0 * height}};
  return options;
}

/** \brief How many points of the cone above \a height, and of the ground, became background. */
std::pair<std::size_t, std::size_t>
background (const SensorCloud& cloud, float height)
{
  std::pair<std::size_t, std::size_t> counts;
  for (std::size_t i = 0; i < cloud.positions.size (); ++i)
    if (cloud.labels[i] == 0)
      (i % 3 == 0 && cloud.positions[i].z () > height ? counts.first : counts.second) += 1;
  return counts;
}

} // namespace

TEST (GivenGround, WithinItsNoiseIsNoObject)
{
  for (const float noise_m : {0.001f, 0.01f, 0.03f})
  {
    SensorCloud cloud = coneOnGround (noise_m);
    labelGround (groundPlane (), cloud);
    const auto [cone, ground] = background (cloud, 4.0f * noise_m);
    EXPECT_EQ (cone, 0u) << noise_m;
    EXPECT_GT (ground, 5900u) << noise_m; // of 6000
  }
}

TEST (GivenGround, IsOnlyWhereThePointsHaveAPeak)
{
  SensorCloud none = coneOnGround (0.01f);
  for (std::size_t i = 0; i < none.positions.size (); ++i)
    if (i % 3 != 0)
      none.positions[i].setConstant (std::numeric_limits<float>::quiet_NaN ()); // the cone was cut out
  labelGround (groundPlane (), none);
  EXPECT_LT (background (none, 0.0f).first + background (none, 0.0f).second, 200u);

  SensorCloud elsewhere = coneOnGround (0.01f);
  labelGround (groundPlane (-0.5), elsewhere);
  EXPECT_EQ (background (elsewhere, -10.0f), std::make_pair (std::size_t (0), std::size_t (0)));
}

TEST (GivenGround, LeavesLabelsAsTheyAre)
{
  SensorCloud cloud = coneOnGround (0.01f);
  cloud.has_labels = true;
  labelGround (groundPlane (), cloud);
  EXPECT_EQ (background (cloud, -10.0f).second + background (cloud, -10.0f).first, 0u);
}

using GivenPlane = PcdView;

TEST_F (GivenPlane, SaysOnWhichSideMatterIs)
{
  // A wavy square above the plane z = 0, or below it, faces away from it; the shape does not tell.
  for (const float side : {1.0f, -1.0f})
  {
    std::ostringstream rows;
    for (int i = 0; i < 60; ++i)
      for (int j = 0; j < 60; ++j)
        rows << 0.01 * i << ' ' << 0.01 * j << ' ' << side * (0.3 + 0.01 * std::sin (0.2 * i) * std::cos (0.2 * j))
             << '\n';
    const LabelledView view = readPcdView (write (header (3600, 1) + rows.str ()), groundPlane ());
    ASSERT_FALSE (view.view);
    for (const OrientedPoint& point : view.objects.at (1).points)
      EXPECT_GT (side * point.normal.z (), 0.5f);
  }
}
