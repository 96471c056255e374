// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion/scenes/completion_scene.h"

#include "pcl_cosection/completion/shown_bodies.h"
#include "pcl_cosection/view/visibility/free_space_view.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

class ShownBodies : public testing::Test
{
protected:
  ShownBodies ()
  {
    scene_.views.push_back ({seen_.view, ViewUse::Full});
    scene_.background = seen_.points.at (0);
    scene_.batches[0] = {{-1, scene_.background.size ()}};
    scene_.objects.push_back ({5, seen_.points.at (1), {}});
    scene_.batches[5] = {{-1, scene_.objects.front ().points.size ()}};
  }

  /** \brief Pixels of a label that show a body. */
  std::ptrdiff_t count (int label, int body) const
  {
    const std::vector<int> bodies = bodiesShown (scene_, 0);
    std::ptrdiff_t number = 0;
    for (std::size_t n = 0; n < bodies.size (); ++n)
      number += seen_.labels[n] == label && bodies[n] == body;
    return number;
  }

  std::ptrdiff_t pixels (int label) const { return std::count (seen_.labels.begin (), seen_.labels.end (), label); }

  const RenderedView seen_ = tableScene (Shape::Box).render (tableCamera (), fromAbove ());
  Scene scene_;
};

} // namespace

TEST_F (ShownBodies, AreThoseOfThePoints)
{
  EXPECT_EQ (count (0, 0), pixels (0));
  EXPECT_EQ (count (1, 5), pixels (1));
}

TEST_F (ShownBodies, AreUnknownBetweenThePointsOfAThinnedCloud)
{
  std::vector<OrientedPoint>& points = scene_.objects.front ().points;
  std::vector<OrientedPoint> some;
  for (std::size_t n = 0; n < points.size (); n += 4)
    some.push_back (points[n]);
  points = some;
  scene_.batches[5] = {{-1, points.size ()}};
  EXPECT_EQ (count (1, 5), static_cast<std::ptrdiff_t> (some.size ()));
  EXPECT_EQ (count (1, 0), 0);
  EXPECT_GT (count (1, FreeSpaceView::unknown_body), 0);
}

TEST_F (ShownBodies, AreNotThoseOfAnotherViewsPoints)
{
  scene_.batches[5].front ().view = 1;
  EXPECT_EQ (count (1, 5), 0);
  scene_.batches[5].front ().view = 0;
  EXPECT_EQ (count (1, 5), pixels (1));
}

TEST_F (ShownBodies, FollowThePoseOfTheObject)
{
  ObjectInput& object = scene_.objects.front ();
  const Eigen::Isometry3d T_world_object = motion (0.7, {1.0, 2.0, 3.0}, {0.1, -0.2, 0.3});
  for (OrientedPoint& point : object.points)
    point.position = (T_world_object.inverse () * point.position.cast<double> ()).cast<float> ();
  object.T_world_object = {T_world_object};
  EXPECT_EQ (count (1, 5), pixels (1));
}
