// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Objects whose table was cropped away, with the plane of the table given or not.

#include "completion/lowest_vertex.h"
#include "surrounding_views.h"

#include "pcl_cosection/view/range_image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <utility>
#include <vector>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief A view with all readings removed except those of the object. */
DepthView
cropped (const RenderedView& seen)
{
  DepthView view = seen.view;
  for (std::size_t i = 0; i < view.depth.size (); ++i)
    if (seen.labels[i] != 1)
      view.depth[i] = std::numeric_limits<float>::quiet_NaN ();
  return view;
}

/** \brief The view of the points alone, as of an unorganised cloud with a viewpoint. */
DepthView
redrawn (const RenderedView& seen)
{
  std::vector<Eigen::Vector3f> points;
  for (const OrientedPoint& p : seen.points.at (1))
    points.push_back (p.position);
  return drawRangeImage (points, seen.view.T_world_sensor.translation ())->view;
}

ObjectResult
completeCropped (const RenderedView& seen, const DepthView* view, const Eigen::Vector4d* plane)
{
  CoSection task (optionsFor (voxel_m));
  if (view)
    task.addView (*view);
  if (plane)
    task.addSupportPlane (*plane);
  task.addObject ({1, seen.points.at (1), {}});
  return task.reconstruct ().objects.at (0);
}

double
meanDifference (const TriangleMesh& a, const TriangleMesh& b)
{
  constexpr double reach_m = 0.04;
  return std::max (meanDistance (a, b, reach_m), meanDistance (b, a, reach_m));
}

/** \brief Largest distance of a mesh's vertices outside the true shape, metres. */
double
farthestOutside (const TriangleMesh& mesh, const Distance& truth)
{
  double outside = 0.0;
  for (const Eigen::Vector3f& v : mesh.vertices)
    outside = std::max (outside, truth (v.cast<double> ()));
  return outside;
}

class CroppedObject : public testing::TestWithParam<Shape>
{
protected:
  const AnalyticScene scene_ = tableScene (GetParam ());
  const RenderedView seen_ = scene_.render (tableCamera (), fromAbove ());
  const TriangleMesh with_table_ = complete (seen_, optionsFor (voxel_m)).objects.at (0).mesh;
  const double truth_m3_ = computeMassProperties (extractIsoSurface (sampleField (scene_.shape (1), 0.15, 0.003)))
                               .volume_m3;
};

} // namespace

TEST_P (CroppedObject, WithAPlaneIsAsWithTheTable)
{
  const DepthView organized = cropped (seen_);
  const DepthView unorganized = redrawn (seen_);
  for (const DepthView* view : {&organized, &unorganized})
  {
    const ObjectResult object = completeCropped (seen_, view, &table_plane);
    ASSERT_EQ (object.error, "");
    EXPECT_TRUE (computeTopology (object.mesh).closed_manifold);
    const double difference_m = meanDifference (object.mesh, with_table_);
    std::printf ("%s, %s: %.2f mm on average from the mesh with the table's points\n", nameOf (GetParam ()).c_str (),
                 view == &organized ? "organised" : "unorganised", 1e3 * difference_m);
    EXPECT_LE (difference_m, voxel_m);
    EXPECT_GE (lowest (object.mesh), -0.7 * voxel_m); // half a voxel where the surface crosses the grid's edges
    EXPECT_LE (object.penetration_m, 0.6 * voxel_m);
  }
}

// The hidden side is unknown with and without a table; the difference shows the effect of the missing table.
TEST_P (CroppedObject, AloneClosesWithoutSwelling)
{
  const double volume_with_table_m3 = computeMassProperties (with_table_).volume_m3;
  const double outside_with_table_m = farthestOutside (with_table_, scene_.shape (1));
  const double error_with_table_m = meanError (with_table_, scene_.shape (1));
  std::printf ("%s, with the table: at most %.1f mm outside, %.2f of the true volume, mean error %.2f mm\n",
               nameOf (GetParam ()).c_str (), 1e3 * outside_with_table_m, volume_with_table_m3 / truth_m3_,
               1e3 * error_with_table_m);
  // With a table their hidden sides are expected; alone they come out small.
  const bool ball = GetParam () == Shape::Sphere;
  const bool torus = GetParam () == Shape::Torus;
  const bool box = GetParam () == Shape::Box; // with a table, its walls continue straight down
  const DepthView unorganized = redrawn (seen_);
  const DepthView* const views[] = {&unorganized, nullptr};
  for (const DepthView* view : views)
  {
    const ObjectResult object = completeCropped (seen_, view, nullptr);
    ASSERT_EQ (object.error, "");
    EXPECT_TRUE (computeTopology (object.mesh).closed_manifold);
    const double volume_m3 = computeMassProperties (object.mesh).volume_m3;
    const double outside_m = farthestOutside (object.mesh, scene_.shape (1));
    const double error_m = meanError (object.mesh, scene_.shape (1));
    std::printf ("%s, %s: at most %.1f mm outside, %.2f of the true volume, mean error %.2f mm\n",
                 nameOf (GetParam ()).c_str (), view ? "with its viewpoint" : "points alone", 1e3 * outside_m,
                 volume_m3 / truth_m3_, 1e3 * error_m);
    EXPECT_LE (volume_m3, box ? 1.05 * 1.05 * truth_m3_ : 1.05 * volume_with_table_m3);
    EXPECT_GE (volume_m3, ball ? 0.67 * truth_m3_ : torus ? 0.75 * truth_m3_ : 0.8 * volume_with_table_m3);
    EXPECT_LE (outside_m, outside_with_table_m + voxel_m);
    EXPECT_LE (error_m, ball ? 1.8 * voxel_m : error_with_table_m + voxel_m);
  }
}

// An open thing shows little more than its inside. Without a table, its thickness below the floor is unknown.
TEST (OpenObject, AloneClosesWithoutSwelling)
{
  using Corner = Eigen::Vector2d;
  const auto round = [] (double wall,
                         std::vector<Corner> inside) { // a wall of even thickness below a profile of radii and heights
    return [=] (const Eigen::Vector3d& p) {
      const Corner q (p.head<2> ().norm (), p.z ());
      double least = std::numeric_limits<double>::infinity ();
      for (std::size_t n = 0; n + 1 < inside.size (); ++n)
      {
        const Corner along = inside[n + 1] - inside[n];
        const double t = std::clamp (along.dot (q - inside[n]) / along.squaredNorm (), 0.0, 1.0);
        least = std::min (least, (inside[n] + t * along - q).norm ());
      }
      return least - 0.5 * wall;
    };
  };
  const auto box = [] (const Eigen::Vector3d& p, const Eigen::Vector3d& half) {
    const Eigen::Array3d out = p.cwiseAbs () - half;
    return out.max (0.0).matrix ().norm () + std::min (0.0, out.maxCoeff ());
  };
  const std::pair<const char*, Distance> things[] = {
      {"plate", round (0.005, {{0.0, 0.004}, {0.07, 0.004}, {0.08, 0.016}, {0.115, 0.018}})},
      {"bowl", round (0.005, {{0.0, 0.003}, {0.03, 0.003}, {0.05, 0.012}, {0.065, 0.025}, {0.075, 0.045}})},
      {"tray", [box] (const Eigen::Vector3d& p) {
         return std::max (box (p - Eigen::Vector3d (0.0, 0.0, 0.015), {0.1, 0.07, 0.015}),
                          -box (p - Eigen::Vector3d (0.0, 0.0, 0.055), {0.095, 0.065, 0.05}));
       }}};
  for (const auto& [name, shape] : things)
  {
    AnalyticScene scene;
    scene.add (0, halfSpace ({0.0, 0.0, 1.0, 0.0}));
    scene.add (1, shape);
    CoSection task (optionsFor (0.0));
    std::vector<OrientedPoint> points;
    for (int n = 0; n < 3; ++n)
    {
      const RenderedView seen = scene.render (tableCamera (), around (n));
      task.addView (cropped (seen));
      points.insert (points.end (), seen.points.at (1).begin (), seen.points.at (1).end ());
    }
    task.addObject ({1, points, {}});
    const ObjectResult alone = task.reconstruct ().objects.at (0);
    const ObjectResult with_table = completeFrom (scene, {0, 1, 2}, optionsFor (0.0));
    ASSERT_EQ (alone.error + with_table.error, "") << name;
    EXPECT_TRUE (computeTopology (alone.mesh).closed_manifold) << name;
    const double truth_m3 = computeMassProperties (extractIsoSurface (sampleField (scene.shape (1), 0.15, 0.002)))
                                .volume_m3;
    const double volume_m3 = computeMassProperties (alone.mesh).volume_m3;
    const double outside_m = farthestOutside (alone.mesh, scene.shape (1));
    const double outside_with_table_m = farthestOutside (with_table.mesh, scene.shape (1));
    std::printf ("%s: at most %.1f mm outside, %.2f of the true volume; with the table %.1f mm, %.2f\n", name,
                 1e3 * outside_m, volume_m3 / truth_m3, 1e3 * outside_with_table_m,
                 computeMassProperties (with_table.mesh).volume_m3 / truth_m3);
    EXPECT_GE (volume_m3, 0.7 * truth_m3) << name;
    EXPECT_LE (volume_m3, 1.3 * truth_m3) << name;
    EXPECT_LE (outside_m, outside_with_table_m + voxel_m) << name;
  }
}

INSTANTIATE_TEST_SUITE_P (Shapes, CroppedObject, testing::Values (Shape::Sphere, Shape::Box, Shape::Torus, Shape::Cup),
                          [] (const auto& info) { return nameOf (info.param); });
