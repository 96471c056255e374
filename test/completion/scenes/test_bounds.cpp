// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Hull, inner and outer bound of a completed object.

#include "surrounding_views.h"

#include <pcl/cosection/volume/mesh_distance.h>

#include <gtest/gtest.h>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief Largest distance of vertices of \a inner outside \a outer, voxels. */
double
protrusion (const TriangleMesh& inner, const TriangleMesh& outer, const VoxelGrid& grid)
{
  const SignedDistanceField field = sampleSignedDistance (outer, grid, 0.1);
  double most = 0.0;
  for (const Eigen::Vector3f& v : inner.vertices)
    most = std::max (most, static_cast<double> (field.sample (v.cast<double> ()).value_or (0.0f)));
  return most / grid.voxel_size_m;
}

class Bounds : public testing::TestWithParam<Shape>
{};

} // namespace

TEST_P (Bounds, EncloseTheEstimate)
{
  CoSectionOptions options = optionsFor (voxel_m);
  options.compute_hull = true;
  options.compute_bounds = true;
  const AnalyticScene scene = tableScene (GetParam ());
  const RenderedView seen = scene.render (tableCamera (), fromAbove ());
  const ObjectResult object = complete (seen, options).objects.at (0);
  ASSERT_EQ (object.error, "");
  const VoxelGrid& grid = object.signed_distance->grid;
  for (const TriangleMesh* mesh : {&object.hull, &object.inner_bound, &object.outer_bound})
    EXPECT_TRUE (computeTopology (*mesh).closed_manifold);
  EXPECT_LE (protrusion (object.inner_bound, object.mesh, grid), 0.25);
  EXPECT_LE (protrusion (object.mesh, object.outer_bound, grid), 0.25);
  EXPECT_LE (protrusion (object.hull, object.outer_bound, grid), 0.25);
  double outside = 0.0; // the inner bound is inside the true shape
  for (const Eigen::Vector3f& v : object.inner_bound.vertices)
    outside = std::max (outside, scene.shape (1) (v.cast<double> ()));
  EXPECT_LE (outside, 1.5 * voxel_m);
  // The outer bound holds all of the object within the object's volume.
  const TriangleMesh truth = extractIsoSurface (sampleField (scene.shape (1), 0.15, 0.004));
  EXPECT_LE (protrusion (truth, object.outer_bound, grid), 1.5);
}

TEST_P (Bounds, AreNotComputedUnasked)
{
  const RenderedView seen = tableScene (GetParam ()).render (tableCamera (), fromAbove ());
  const ObjectResult object = complete (seen, optionsFor (voxel_m)).objects.at (0);
  EXPECT_TRUE (object.hull.empty () && object.inner_bound.empty () && object.outer_bound.empty ());
}

INSTANTIATE_TEST_SUITE_P (Shapes, Bounds, testing::Values (Shape::Sphere, Shape::Box, Shape::Torus, Shape::Cup),
                          [] (const auto& info) { return nameOf (info.param); });
