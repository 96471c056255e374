// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion/mesh_distance.h"
#include "completion_scene.h"

#include "pcl_cosection/energy/constraints/hull_constraint.h"

#include <gtest/gtest.h>

#include <tuple>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief Shares of an object's surface at impossible places. */
struct Violations
{
  double in_free_space = 0.0;
  double below_table = 0.0; ///< by more than a voxel
};

/** \brief The effects of each constraint, as in the figures of the paper. As there, the extent bound is off. */
class Constraints : public testing::TestWithParam<std::tuple<Shape, bool>> // shape, from above
{
protected:
  Violations violations (bool hull, bool intersection) const
  {
    CoSectionOptions options = optionsFor (voxel_m);
    options.use_hull = hull;
    options.use_intersection = intersection;
    options.use_extent_prior = false;
    const ObjectResult object = complete (seen_, options).objects.at (0);
    EXPECT_EQ (object.error, "");
    EXPECT_TRUE (computeTopology (object.mesh).closed_manifold);
    const VoxelGrid& grid = object.signed_distance->grid;
    HullConstraint votes (grid);
    votes.add (FreeSpaceView (seen_.view), seen_.view.T_world_sensor);
    const std::vector<std::uint8_t> free_space = votes.freeSpace (true);
    return {areaShare (object.mesh,
                       [&] (const Eigen::Vector3d& p) {
                         const Eigen::Vector3i at = grid.toVoxel (p).array ().round ().cast<int> ();
                         return grid.contains (at.x (), at.y (), at.z ()) &&
                                free_space[grid.index (at.x (), at.y (), at.z ())];
                       }),
            areaShare (object.mesh, [&] (const Eigen::Vector3d& p) { return p.z () < -voxel_m; })};
  }

  const RenderedView seen_ = tableScene (std::get<0> (GetParam ()))
                                 .render (tableCamera (), std::get<1> (GetParam ()) ? fromAbove () : fromTheFront ());
};

} // namespace

TEST_P (Constraints, KeepOutOfFreeSpaceAndOutOfTheTable)
{
  const Violations none = violations (false, false);
  const Violations hull = violations (true, false);
  const Violations intersection = violations (false, true);
  const Violations all = violations (true, true);

  // Without constraints the surface enters free space.
  EXPECT_GT (none.in_free_space, 0.02);
  EXPECT_GT (none.below_table, 0.02);

  EXPECT_LT (hull.in_free_space, 0.01);
  EXPECT_LT (hull.in_free_space, 0.1 * none.in_free_space);
  EXPECT_GT (hull.below_table, 0.02);

  EXPECT_LT (intersection.below_table, 0.005);

  EXPECT_LT (all.in_free_space, 0.01);
  EXPECT_LT (all.below_table, 0.005);
}

INSTANTIATE_TEST_SUITE_P (Table, Constraints,
                          testing::Combine (testing::Values (Shape::Sphere, Shape::Box, Shape::Torus, Shape::Cup),
                                            testing::Bool ()),
                          [] (const auto& info) {
                            return nameOf (std::get<0> (info.param)) +
                                   (std::get<1> (info.param) ? "FromAbove" : "FromTheFront");
                          });

/** \brief The intersection constraint alone does not keep a surface out of free space: it swells beside the table. */
TEST (ConstraintsAlone, AreNotEnough)
{
  const RenderedView seen = tableScene (Shape::Box).render (tableCamera (), fromAbove ());
  const auto accuracy = [&] (bool hull, bool intersection) {
    CoSectionOptions options = optionsFor (voxel_m);
    options.use_hull = hull;
    options.use_intersection = intersection;
    options.use_extent_prior = false;
    const TriangleMesh mesh = complete (seen, options).objects.at (0).mesh;
    double sum = 0.0;
    for (const Eigen::Vector3f& v : mesh.vertices)
      sum += std::abs (onTable (Shape::Box) (v.cast<double> ()));
    return sum / static_cast<double> (mesh.vertices.size ());
  };
  const double none = accuracy (false, false);
  const double hull = accuracy (true, false);
  const double intersection = accuracy (false, true);
  const double all = accuracy (true, true);
  EXPECT_LT (hull, none);
  EXPECT_LT (intersection, none);
  EXPECT_LT (all, hull);
  EXPECT_LT (all, intersection);
}

/** \brief A plane given by the user has the effect of a found one. */
TEST (ConstraintsGiven, PlanesAndBodiesBound)
{
  const RenderedView seen = tableScene (Shape::Box).render (tableCamera (), fromAbove ());
  CoSectionOptions options = optionsFor (voxel_m);
  const auto below = [&] (auto&& constrain) {
    CoSection scene (options);
    scene.addView (seen.view);
    scene.addObject ({1, seen.points.at (1), {}});
    constrain (scene);
    const TriangleMesh mesh = scene.reconstruct ().objects.at (0).mesh;
    return areaShare (mesh, [] (const Eigen::Vector3d& p) { return p.z () < -voxel_m; });
  };
  options.priors = Priors::named ("extent"); // others tell where it ends
  EXPECT_GT (below ([] (CoSection&) {}), 0.05);
  options.priors = {};
  EXPECT_LT (below ([] (CoSection& scene) { scene.addSupportPlane ({0.0, 0.0, 2.0, 0.0}); }), 0.005);
  const auto table = std::make_shared<SignedDistanceField> (
      sampleField ([] (const Eigen::Vector3d& p) { return p.z (); }, 0.2, 0.01));
  EXPECT_LT (below ([&] (CoSection& scene) { scene.addObstacle (table); }), 0.005);
}
