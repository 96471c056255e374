// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion/analytic_scene.h"

#include "pcl_cosection/energy/constraints/intersection_constraint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr double cap_vox = 5.0;
constexpr double quantum_vox = 1.0 / 512.0 + 1e-4; // of LowerBound, and rounding
constexpr double beta = 0.01;
constexpr double body_radius_m = 0.05;

VoxelGrid
testGrid (double voxel_size_m)
{
  VoxelGrid grid;
  grid.dims = {23, 18, 27};
  grid.voxel_size_m = voxel_size_m;
  grid.origin_m = Eigen::Vector3d (-0.05, -0.06, -0.04);
  return grid;
}

Eigen::Isometry3d
testPose ()
{
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity ();
  T.linear () = Eigen::AngleAxisd (0.7, Eigen::Vector3d (1.0, 2.0, -1.0).normalized ()).toRotationMatrix ();
  T.translation () = Eigen::Vector3d (0.013, -0.021, 0.008);
  return T;
}

class IntersectionConstraintTest : public testing::TestWithParam<double> // voxel size
{
protected:
  const VoxelGrid grid_ = testGrid (GetParam ());
  const SignedDistanceField body_ = sampleField (sphere (body_radius_m), 0.06, 0.0025);
};

} // namespace

TEST_P (IntersectionConstraintTest, IsTheDepthInsideTheBody)
{
  const Eigen::Isometry3d T_body_grid = testPose ();
  IntersectionConstraint constraint (grid_, cap_vox);
  constraint.addBody (body_, {T_body_grid}, beta);
  const std::vector<LowerBound> bounds = constraint.bounds ();
  ASSERT_EQ (bounds.size (), grid_.size ());
  // Linear interpolation of the sphere's distance; kinked only at its centre, far beyond the cap or not.
  const double interpolation_vox = 0.001 / grid_.voxel_size_m;
  double deepest = 0.0;
  forEachVoxel (grid_, [&] (std::size_t n, const Eigen::Vector3d& p) {
    const double depth = (body_radius_m - (T_body_grid * p).norm ()) / grid_.voxel_size_m;
    const double expected = std::clamp (depth, 0.0, cap_vox);
    EXPECT_NEAR (bounds[n].distance (), expected, quantum_vox + interpolation_vox) << p.transpose ();
    if (std::abs (depth) > interpolation_vox)
    {
      EXPECT_NEAR (bounds[n].weight (), depth > 0.0 ? beta : 0.0, beta / 256.0) << p.transpose ();
    }
    deepest = std::max (deepest, expected);
  });
  EXPECT_GT (deepest, 3.0);
}

TEST_P (IntersectionConstraintTest, IsThatOfEachVoxelByItself)
{
  // Two small bodies in a large volume, one corner of which is not supported.
  SignedDistanceField bodies = sampleField (sphere (0.02), 0.12, 0.0025);
  for (std::size_t n = 0; n < bodies.values.size (); ++n)
    bodies.values[n] = std::min (bodies.values[n],
                                 bodies.values[(n + bodies.values.size () / 3) % bodies.values.size ()]);
  bodies.supported.assign (bodies.values.size (), 1);
  std::fill (bodies.supported.begin (),
             bodies.supported.begin () + static_cast<std::ptrdiff_t> (bodies.supported.size () / 4), 0);
  std::vector<Eigen::Isometry3d> poses;
  for (int n = 0; n < 12; ++n)
  {
    poses.push_back (testPose () * Eigen::AngleAxisd (0.5 * n, Eigen::Vector3d (1.0, n, -2.0).normalized ()));
    poses.back ().translation () += 0.01 * n * Eigen::Vector3d (1.0, -0.5, 0.3);
  }
  IntersectionConstraint constraint (grid_, cap_vox);
  constraint.addBody (bodies, poses, beta);
  const std::vector<LowerBound> bounds = constraint.bounds ();
  ASSERT_EQ (bounds.size (), grid_.size ());
  int inside = 0;
  forEachVoxel (grid_, [&] (std::size_t n, const Eigen::Vector3d& p) {
    double deepest = 0.0;
    for (const Eigen::Isometry3d& T : poses)
      if (const auto u = bodies.sampleInside (bodies.grid.toVoxel (T * p)))
        deepest = std::max (deepest, std::min (cap_vox, -*u / grid_.voxel_size_m));
    EXPECT_NEAR (bounds[n].distance (), deepest, quantum_vox) << p.transpose ();
    inside += deepest > 0.0;
  });
  EXPECT_GT (inside, 100);
}

TEST_P (IntersectionConstraintTest, ScalesTheWeightsOfWhatIsThere)
{
  IntersectionConstraint scaled (grid_, cap_vox);
  scaled.addBody (body_, {testPose ()}, beta);
  scaled.scaleWeights (4.0);
  scaled.addHalfSpace ({0.0, 0.0, 1.0, 0.02}, {}, beta);
  IntersectionConstraint direct (grid_, cap_vox);
  direct.addBody (body_, {testPose ()}, 4.0 * beta);
  direct.addHalfSpace ({0.0, 0.0, 1.0, 0.02}, {}, beta);
  EXPECT_TRUE (scaled.bounds () == direct.bounds ());
}

TEST_P (IntersectionConstraintTest, HalfSpaceSparesFreeSpace)
{
  const Eigen::Vector4d plane (0.36, 0.48, 0.8, -0.005);
  std::vector<std::uint8_t> free_space (grid_.size ());
  for (std::size_t n = 0; n < free_space.size (); ++n)
    free_space[n] = n % 3 == 0;
  IntersectionConstraint constraint (grid_, cap_vox);
  constraint.addHalfSpace (plane, free_space, beta);
  const std::vector<LowerBound> bounds = constraint.bounds ();
  ASSERT_EQ (bounds.size (), grid_.size ());
  std::size_t inside = 0;
  forEachVoxel (grid_, [&] (std::size_t n, const Eigen::Vector3d& p) {
    const double depth = -(plane.head<3> ().dot (p) + plane[3]) / grid_.voxel_size_m;
    const double expected = free_space[n] ? 0.0 : std::clamp (depth, 0.0, cap_vox);
    EXPECT_NEAR (bounds[n].distance (), expected, quantum_vox) << p.transpose ();
    EXPECT_EQ (static_cast<bool> (bounds[n]), expected > 0.0) << p.transpose ();
    inside += expected > 0.0;
  });
  EXPECT_GT (inside, grid_.size () / 10);
}

TEST_P (IntersectionConstraintTest, SaysNothingWhereTheBodyIsNotSupported)
{
  SignedDistanceField half = body_;
  half.supported.assign (half.grid.size (), 0);
  forEachVoxel (half.grid, [&] (std::size_t n, const Eigen::Vector3d& p) { half.supported[n] = p.x () > 0.0; });
  IntersectionConstraint constraint (grid_, cap_vox);
  constraint.addBody (half, {Eigen::Isometry3d::Identity ()}, beta);
  const std::vector<LowerBound> bounds = constraint.bounds ();
  ASSERT_EQ (bounds.size (), grid_.size ());
  std::size_t bounded = 0, wrong = 0;
  forEachVoxel (grid_, [&] (std::size_t n, const Eigen::Vector3d& p) {
    wrong += p.x () < -half.grid.voxel_size_m && bounds[n];
    bounded += static_cast<bool> (bounds[n]);
  });
  EXPECT_EQ (wrong, 0u);
  EXPECT_GT (bounded, 100u);
}

INSTANTIATE_TEST_SUITE_P (VoxelSizes, IntersectionConstraintTest, testing::Values (0.003, 0.005));

TEST (IntersectionBodies, OutsideTheirVolumeSayNothing)
{
  // A body that fills its volume; beyond the volume nothing is known.
  SignedDistanceField body = sampleField ([] (const Eigen::Vector3d&) { return -0.1; }, 0.02, 0.005);
  const VoxelGrid grid = testGrid (0.004);
  IntersectionConstraint constraint (grid, cap_vox);
  constraint.addBody (body, {Eigen::Isometry3d::Identity ()}, beta);
  const std::vector<LowerBound> bounds = constraint.bounds ();
  ASSERT_EQ (bounds.size (), grid.size ());
  std::size_t wrong = 0;
  forEachVoxel (grid, [&] (std::size_t n, const Eigen::Vector3d& p) {
    const double outside = p.cwiseAbs ().maxCoeff () - 0.02;
    wrong += std::abs (outside) > 1e-9 && static_cast<bool> (bounds[n]) != (outside < 0.0);
  });
  EXPECT_EQ (wrong, 0u);

  IntersectionConstraint far (grid, cap_vox);
  Eigen::Isometry3d away = Eigen::Isometry3d::Identity ();
  away.translation ().x () = 10.0;
  far.addBody (body, {away}, beta);
  EXPECT_TRUE (far.bounds ().empty ());
  EXPECT_TRUE (IntersectionConstraint (grid, cap_vox).bounds ().empty ());
}

TEST (IntersectionBodies, TheDeepestCounts)
{
  const VoxelGrid grid = testGrid (0.004);
  const SignedDistanceField small = sampleField (sphere (0.03), 0.04, 0.0025);
  const SignedDistanceField large = sampleField (sphere (0.04), 0.05, 0.0025);
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity ();
  Eigen::Isometry3d there = here;
  there.translation ().z () = 0.02;
  const auto boundsOf = [&] (auto&&... bodies) {
    IntersectionConstraint constraint (grid, 100.0);
    (constraint.addBody (*bodies.first, {bodies.second.first}, bodies.second.second), ...);
    return constraint.bounds ();
  };
  const auto body = [] (const SignedDistanceField& f, const Eigen::Isometry3d& T, double b) {
    return std::make_pair (&f, std::make_pair (T, b));
  };
  const std::vector<LowerBound> a = boundsOf (body (small, here, 0.01));
  const std::vector<LowerBound> b = boundsOf (body (large, there, 0.5));
  const std::vector<LowerBound> ab = boundsOf (body (small, here, 0.01), body (large, there, 0.5));
  EXPECT_EQ (ab, boundsOf (body (large, there, 0.5), body (small, here, 0.01))) << "depends on the order";
  std::size_t from_a = 0, from_b = 0;
  for (std::size_t n = 0; n < grid.size (); ++n)
  {
    EXPECT_EQ (ab[n].distance (), std::max (a[n].distance (), b[n].distance ()));
    if (a[n].distance () == b[n].distance ())
      continue;
    const bool first = a[n].distance () > b[n].distance ();
    EXPECT_EQ (ab[n].weight (), (first ? a : b)[n].weight ());
    ++(first ? from_a : from_b);
  }
  EXPECT_GT (from_a, 0u);
  EXPECT_GT (from_b, 0u);
}
