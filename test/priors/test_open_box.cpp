// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Open boxes: trays, bins, and similar things that are not open boxes.

#include "completion/scenes/surrounding_views.h"
#include "moved_points.h"
#include "round_things.h"

#include "pcl_cosection/priors/shape/profiled_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief A box without a lid that stands on z = 0. */
struct Tray
{
  Eigen::Vector3d size;
  double wall;
  double corner = 0.0; // radius
};

std::ostream&
operator<< (std::ostream& out, const Tray& tray)
{
  return out << tray.size.transpose () << ", wall " << tray.wall << ", corners " << tray.corner;
}

/** \brief A prism with a rounded rectangle as its outline, from one height to another. */
Distance
block (const Eigen::Vector2d& size, double corner, double bottom, double top)
{
  return [=] (const Eigen::Vector3d& p) {
    const Eigen::Vector2d q = p.head<2> ().cwiseAbs () - 0.5 * size + Eigen::Vector2d::Constant (corner);
    const double across = q.cwiseMax (0.0).norm () + std::min (q.maxCoeff (), 0.0) - corner;
    const Eigen::Vector2d d (across, std::abs (p.z () - 0.5 * (bottom + top)) - 0.5 * (top - bottom));
    return d.cwiseMax (0.0).norm () + std::min (d.maxCoeff (), 0.0);
  };
}

Distance
united (const std::vector<Distance>& parts)
{
  return [=] (const Eigen::Vector3d& p) {
    double least = std::numeric_limits<double>::infinity ();
    for (const Distance& part : parts)
      least = std::min (least, part (p));
    return least;
  };
}

Distance
without (const Distance& body, const Distance& hole)
{
  return [=] (const Eigen::Vector3d& p) { return std::max (body (p), -hole (p)); };
}

Distance
shapeOf (const Tray& tray)
{
  const Eigen::Vector2d size = tray.size.head<2> ();
  const Distance cavity = block (size - Eigen::Vector2d::Constant (2.0 * tray.wall),
                                 std::max (0.0, tray.corner - tray.wall), tray.wall, 2.0 * tray.size.z ());
  const Distance shape = without (block (size, tray.corner, 0.0, tray.size.z ()), cavity);
  return placed (shape, Eigen::Isometry3d (Eigen::AngleAxisd (0.4, Eigen::Vector3d::UnitZ ())));
}

Distance
plate (const Eigen::Vector3d& low, const Eigen::Vector3d& high)
{
  return placed (box (0.5 * (high - low)), 0.5 * (low + high));
}

AnalyticScene
sceneOf (const Distance& shape, bool with_table)
{
  AnalyticScene scene;
  scene.add (1, shape);
  if (with_table)
    scene.add (0, halfSpace (table_plane));
  return scene;
}

std::vector<OrientedPoint>
pointsOf (const Distance& shape, int views)
{
  std::vector<OrientedPoint> points;
  for (int n = 0; n < views; ++n)
  {
    const RenderedView seen = sceneOf (shape, true).render (tableCamera (), around (n));
    const std::vector<OrientedPoint>& some = seen.points.at (1);
    points.insert (points.end (), some.begin (), some.end ());
  }
  return points;
}

CoSectionOptions
options ()
{
  CoSectionOptions options;
  options.threads = 1;
  return options;
}

} // namespace

class OpenBox : public testing::TestWithParam<Tray>
{
protected:
  const Tray tray_ = GetParam ();
  const Distance shape_ = shapeOf (tray_);
};

TEST_P (OpenBox, HasWallsAndAFloorInAnyPose)
{
  const Eigen::Isometry3d T = anyPose ();
  const Eigen::Vector3d up = T.linear () * Eigen::Vector3d::UnitZ ();
  const Eigen::Vector4d plane (up.x (), up.y (), up.z (), -up.dot (T.translation ()));
  for (const bool is_noisy : {false, true})
  {
    std::vector<OrientedPoint> points = moved (pointsOf (shape_, 1), T);
    if (is_noisy)
      points = noisy (points);
    for (const ProfiledShape& extent : {ProfiledShape (points), ProfiledShape (points, plane)})
    {
      EXPECT_NEAR (extent.wallThickness (), tray_.wall, 0.0025) << is_noisy;
      std::vector<OrientedPoint> hidden = extent.hiddenSide (points, 0.002);
      double off = 0.0;
      int outside = 0, below = 0;
      for (const OrientedPoint& point : hidden)
      {
        const Eigen::Vector3d p = T.inverse () * point.position.cast<double> ();
        off += std::abs (shape_ (p)) / static_cast<double> (hidden.size ());
        const Eigen::Vector3d n = T.linear ().transpose () * point.normal.cast<double> ();
        below += n.z () < -0.95 && std::abs (p.z ()) < 0.003;
        outside += std::abs (n.z ()) < 0.3 && std::abs (shape_ (p)) < 0.003 && p.y () > 0.02 && n.y () > 0.3;
      }
      EXPECT_LT (off, 0.0025) << is_noisy;
      EXPECT_GT (below, 500);
      EXPECT_GT (outside, 100); // of the side that faces away
      const Eigen::Vector3d inside (0.0, 0.0, 0.75 * tray_.size.z ());
      EXPECT_GT (extent.depthInCavity (T * inside), 0.5 * (inside.z () - tray_.wall));
      EXPECT_EQ (extent.depthInCavity (T * Eigen::Vector3d (0.0, 0.0, -0.01)), 0.0);
      EXPECT_EQ (extent.depthInCavity (T * Eigen::Vector3d (0.3, 0.0, inside.z ())), 0.0);
    }
  }
}

TEST_P (OpenBox, IsCompletedWithThinWallsAlsoAlone)
{
  for (const bool with_table : {true, false})
  {
    const ObjectResult result = completeFrom (sceneOf (shape_, with_table), {0}, options ());
    EXPECT_TRUE (computeTopology (result.mesh).closed_manifold);
    EXPECT_LT (meanError (result.mesh, shape_), 0.0025) << with_table;
  }
}

TEST_P (OpenBox, HasNotObservedWhatFacesAway)
{
  const ObjectResult result = completeFrom (sceneOf (shape_, true), {0}, options ());
  const Eigen::Vector3f sensor = around (0).translation ().cast<float> ();
  int away = 0, seen_away = 0, towards = 0, seen_towards = 0;
  for (std::size_t v = 0; v < result.mesh.vertices.size (); ++v)
  {
    const float cosine = result.mesh.normals[v].dot ((sensor - result.mesh.vertices[v]).normalized ());
    const bool is_observed = result.mesh.provenance[v] == static_cast<std::uint8_t> (Provenance::Observed);
    (cosine > 0.0f ? towards : away) += std::abs (cosine) > 0.5f;
    (cosine > 0.0f ? seen_towards : seen_away) += std::abs (cosine) > 0.5f && is_observed;
  }
  ASSERT_GT (away, 500);
  EXPECT_LT (seen_away, 0.05 * away);
  EXPECT_GT (seen_towards, 0.5 * towards); // the other half may be behind the wall in front
}

INSTANTIATE_TEST_SUITE_P (Trays, OpenBox,
                          testing::Values (Tray{{0.13, 0.1, 0.03}, 0.004}, Tray{{0.14, 0.1, 0.04}, 0.006, 0.03},
                                           Tray{{0.12, 0.12, 0.06}, 0.005}));

TEST (OpenBoxes, ADeepOneShowsNoFloor)
{
  const Tray bin{{0.13, 0.11, 0.08}, 0.006};
  std::vector<OrientedPoint> points = pointsOf (shapeOf (bin), 1);
  points.erase (
      std::remove_if (points.begin (), points.end (),
                      [] (const OrientedPoint& p) { return p.normal.z () > 0.5f && p.position.z () < 0.05f; }),
      points.end ());
  EXPECT_NEAR (ProfiledShape (points, table_plane).wallThickness (), bin.wall, 0.003);
  EXPECT_NEAR (ProfiledShape (points).wallThickness (), bin.wall, 0.003);
}

TEST (OpenBoxes, WhatIsOpenToASideIsNone)
{
  const double wall = 0.006;
  const Eigen::Vector3d half (0.06, 0.045, 0.0);
  const double height = 0.05;
  const Distance floor = plate ({-half.x (), -half.y (), 0.0}, {half.x (), half.y (), wall});
  const Distance left = plate ({-half.x (), -half.y (), 0.0}, {-half.x () + wall, half.y (), height});
  const Distance right = plate ({half.x () - wall, -half.y (), 0.0}, {half.x (), half.y (), height});
  const Distance back = plate ({-half.x (), half.y () - wall, 0.0}, {half.x (), half.y (), height});
  const Distance solid = plate ({-half.x (), -half.y (), 0.0}, {half.x (), half.y (), height});
  const Distance notch = plate ({-0.02, -0.02, 0.02}, {0.02, 0.1, 0.1});
  const std::vector<std::pair<std::string, Distance>> others = {{"bracket", united ({floor, back})},
                                                                {"channel", united ({floor, left, right})},
                                                                {"three walls", united ({floor, left, right, back})},
                                                                {"solid", solid},
                                                                {"notched", without (solid, notch)}};
  for (const auto& [name, shape] : others)
    for (const double turn : {0.0, 0.7, 2.4})
      for (const int views : {1, 3})
      {
        const Distance turned = placed (shape, Eigen::Isometry3d (Eigen::AngleAxisd (turn, Eigen::Vector3d::UnitZ ())));
        const std::vector<OrientedPoint> points = pointsOf (turned, views);
        EXPECT_EQ (ProfiledShape (points, table_plane).wallThickness (), 0.0) << name << ", " << turn << ", " << views;
        EXPECT_EQ (ProfiledShape (points).wallThickness (), 0.0) << name << ", " << turn << ", " << views;
      }
}
