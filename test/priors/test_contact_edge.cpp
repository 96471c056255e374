// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Cropped objects end at their inferred support plane, and rays without return bound them.

#include "completion/lowest_vertex.h"
#include "completion/scenes/surrounding_views.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr double radius_m = 0.06;

/** \brief A ball cut off \a cut radii above its centre, with the cut on the table. */
Distance
ballAbove (double cut)
{
  return [cut] (const Eigen::Vector3d& p) {
    return std::max (-p.z (), (p + Eigen::Vector3d (0.0, 0.0, cut * radius_m)).norm () - radius_m);
  };
}

double
cone (const Eigen::Vector3d& p)
{
  const double side = 0.8 * p.head<2> ().norm () + 0.6 * (p.z () - 0.08); // 3:4:5
  return std::max (-p.z (), side);
}

double
boxDistance (const Eigen::Vector3d& p, const Eigen::Vector3d& middle, const Eigen::Vector3d& half)
{
  const Eigen::Array3d out = (p - middle).cwiseAbs () - half;
  return out.max (0.0).matrix ().norm () + std::min (0.0, out.maxCoeff ());
}

/** \brief A T that lies on the table. */
double
brick (const Eigen::Vector3d& p)
{
  return std::min (boxDistance (p, {0.0, 0.045, 0.025}, {0.075, 0.02, 0.025}),
                   boxDistance (p, {0.0, -0.02, 0.025}, {0.02, 0.045, 0.025}));
}

AnalyticScene
onTable (const Distance& shape)
{
  AnalyticScene scene;
  scene.add (0, halfSpace ({0.0, 0.0, 1.0, 0.0}));
  scene.add (1, shape);
  return scene;
}

/** \brief Complete object 1 from nothing but its own points. */
TriangleMesh
completeAlone (const AnalyticScene& scene, const std::vector<int>& sensors, const Eigen::Vector4d* plane = nullptr,
               const Priors& priors = {})
{
  CoSectionOptions options = optionsFor (0.0);
  options.priors = priors;
  CoSection task (options);
  if (plane)
    task.addSupportPlane (*plane);
  std::vector<OrientedPoint> points;
  for (const int n : sensors)
  {
    const RenderedView seen = scene.render (tableCamera (), around (n));
    DepthView view = seen.view;
    for (std::size_t i = 0; i < view.depth.size (); ++i)
      if (seen.labels[i] != 1)
        view.depth[i] = std::numeric_limits<float>::quiet_NaN ();
    task.addView (view);
    if (seen.points.count (1) > 0)
      points.insert (points.end (), seen.points.at (1).begin (), seen.points.at (1).end ());
  }
  task.addObject ({1, points, {}});
  const ObjectResult object = task.reconstruct ().objects.at (0);
  EXPECT_EQ (object.error, "");
  return object.mesh;
}

double
volumeOf (const Distance& shape)
{
  return computeMassProperties (extractIsoSurface (sampleField (shape, 0.15, 0.002))).volume_m3;
}

struct Thing
{
  std::string name;
  Distance shape;
};

} // namespace

TEST (ContactEdge, WhatStoodEndsThere)
{
  const Thing things[] = {{"half ball", ballAbove (0.0)}, {"lens", ballAbove (0.4)}, {"cone", cone}};
  for (const Thing& thing : things)
    for (const std::vector<int>& sensors : {std::vector<int>{0}, std::vector<int>{0, 1, 2}})
    {
      const AnalyticScene scene = onTable (thing.shape);
      const TriangleMesh alone = completeAlone (scene, sensors);
      const std::string what = thing.name + ", views: " + std::to_string (sensors.size ());
      EXPECT_TRUE (computeTopology (alone).closed_manifold) << what;
      const double share = computeMassProperties (alone).volume_m3 / volumeOf (thing.shape);
      const double error_m = meanError (alone, thing.shape);
      std::printf ("%s: %.2f of the true volume, to %.1f mm below, mean error %.2f mm\n", what.c_str (), share,
                   -1e3 * lowest (alone), 1e3 * error_m);
      EXPECT_GE (share, 0.9) << what;
      EXPECT_LE (share, 1.1) << what;
      EXPECT_GE (lowest (alone), -0.004) << what;
      EXPECT_LE (error_m, 0.002) << what;
    }
}

TEST (ContactEdge, SilhouettesAreNone)
{
  const Thing things[] = {
      {"ball", [] (const Eigen::Vector3d& p) { return (p - Eigen::Vector3d (0.0, 0.0, radius_m)).norm () - radius_m; }},
      {"can", [] (const Eigen::Vector3d& p) {
         return std::max (p.head<2> ().norm () - 0.04, std::abs (p.z () - 0.06) - 0.06);
       }}};
  for (const Thing& thing : things)
    for (const std::vector<int>& sensors : {std::vector<int>{0}, std::vector<int>{0, 1, 2}})
    {
      const TriangleMesh alone = completeAlone (onTable (thing.shape), sensors);
      const double share = computeMassProperties (alone).volume_m3 / volumeOf (thing.shape);
      const double error_m = meanError (alone, thing.shape);
      std::printf ("%s, views: %zu: %.2f of the true volume, mean error %.2f mm\n", thing.name.c_str (),
                   sensors.size (), share, 1e3 * error_m);
      EXPECT_GE (share, 0.95) << thing.name;
      EXPECT_LE (share, 1.05) << thing.name;
      EXPECT_LE (error_m, 0.0015) << thing.name;
    }
}

TEST (ContactEdge, APlaneThatIsGuessedIsNoBody)
{
  const TriangleMesh alone = completeAlone (onTable (ballAbove (0.0)), {0, 1, 2});
  EXPECT_EQ (std::count (alone.provenance.begin (), alone.provenance.end (),
                         static_cast<std::uint8_t> (Provenance::Intersection)),
             0);
}

TEST (RaysWithoutReturn, NothingIsExpectedWhereViewsLookedPast)
{
  const AnalyticScene scene = onTable (brick);
  for (const std::vector<int>& sensors : {std::vector<int>{0, 1}, std::vector<int>{0, 1, 2}})
  {
    const double with_table_m = meanError (completeFrom (scene, sensors, optionsFor (0.0)).mesh, brick);
    const double alone_m = meanError (completeAlone (scene, sensors), brick);
    const double with_plane_m = meanError (completeAlone (scene, sensors, &table_plane), brick);
    std::printf ("T, views: %zu: mean error %.2f mm with the table, %.2f with its plane, %.2f alone\n", sensors.size (),
                 1e3 * with_table_m, 1e3 * with_plane_m, 1e3 * alone_m);
    EXPECT_LE (with_plane_m, with_table_m + 0.001);
    EXPECT_LE (alone_m, sensors.size () == 2 ? 0.0025 : 0.0014); // its support is unknown
  }
}

/** \brief Without the prior, a ball on a table goes on below it. */
TEST (ContactEdge, IsFoundOnlyWithItsPrior)
{
  Priors others;
  others.plane = false;
  const AnalyticScene scene = onTable (ballAbove (0.0));
  EXPECT_GT (lowest (completeAlone (scene, {0})), -0.004);
  EXPECT_LT (lowest (completeAlone (scene, {0}, nullptr, others)), -0.03);
}

/** \brief Without the prior, an L and a small table on a given plane go on where views looked past. */
TEST (RaysWithoutReturn, BoundOnlyWithTheirPrior)
{
  const Distance l = [] (const Eigen::Vector3d& p) {
    return std::min (boxDistance (p, {0.0, 0.0, 0.015}, {0.08, 0.02, 0.015}),
                     boxDistance (p, {-0.06, 0.0, 0.06}, {0.02, 0.02, 0.06}));
  };
  const Distance table = [] (const Eigen::Vector3d& p) {
    return std::min ({boxDistance (p, {0.0, 0.0, 0.09}, {0.09, 0.06, 0.01}),
                      boxDistance (p, {-0.08, 0.0, 0.045}, {0.01, 0.06, 0.045}),
                      boxDistance (p, {0.08, 0.0, 0.045}, {0.01, 0.06, 0.045})});
  };
  Priors others;
  others.rays = false;
  for (const Distance& shape : {l, table})
  {
    const AnalyticScene scene = onTable (shape);
    EXPECT_GT (meanError (completeAlone (scene, {0, 1}, &table_plane, others), shape),
               2.0 * meanError (completeAlone (scene, {0, 1}, &table_plane), shape));
  }
}
