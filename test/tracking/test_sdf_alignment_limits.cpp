// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Geometry that does not determine a pose, points without a distance, and wrong arguments.

#include "common/not_a_number.h"
#include "tracking_scene.h"
#include "volume/tsdf_views.h"

#include "pcl_cosection/tracking/surface_points.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/tracking/sdf_alignment.h>

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

SignedDistanceField
fieldOf (const std::function<double (const Eigen::Vector3d&)>& distance, int resolution = 48)
{
  SignedDistanceField field;
  field.grid = cubeGrid (resolution, 0.3 / resolution);
  for (int k = 0; k < resolution; ++k)
    for (int j = 0; j < resolution; ++j)
      for (int i = 0; i < resolution; ++i)
        field.values.push_back (static_cast<float> (distance (field.grid.center (i, j, k))));
  return field;
}

const Eigen::Vector3d plane_normal = Eigen::Vector3d (0.3, -0.2, 1.0).normalized ();
constexpr double ball_radius_m = 0.08;

SignedDistanceField
planeField ()
{
  return fieldOf ([] (const Eigen::Vector3d& p) { return plane_normal.dot (p); });
}

SignedDistanceField
ballField ()
{
  return fieldOf ([] (const Eigen::Vector3d& p) { return p.norm () - ball_radius_m; });
}

/** \brief Three faces of a corner, which determine a pose. */
SignedDistanceField
cornerField ()
{
  return fieldOf ([] (const Eigen::Vector3d& p) { return (p - Eigen::Vector3d::Constant (0.02)).maxCoeff (); });
}

Eigen::Isometry3d
nearby (double shift_m, double angle_rad)
{
  return Eigen::Translation3d (shift_m * Eigen::Vector3d (1.0, -1.0, 2.0).normalized ()) *
         Eigen::AngleAxisd (angle_rad, Eigen::Vector3d (2.0, 1.0, -1.0).normalized ()) * Eigen::Isometry3d::Identity ();
}

} // namespace

TEST (SdfAlignmentLimits, PlaneHoldsWhatItLeavesOpen)
{
  const SignedDistanceField field = planeField ();
  std::vector<Eigen::Vector3f> points;
  for (const Eigen::Vector3f& p : surfacePoints (field))
    if (p.norm () < 0.1f)
      points.push_back (p);
  const Eigen::Isometry3d guess = nearby (0.01, radians (4.0));
  const SdfAlignmentResult result = SdfAlignment ().align (points, {}, field, guess);
  EXPECT_TRUE (result.converged);
  EXPECT_EQ (result.observed_directions, 3);
  EXPECT_LT (result.observability[2], 1e-6);
  EXPECT_GT (result.observability[3], 0.1);
  EXPECT_LT (result.rms_m, 1e-5);
  // It turned and moved onto the plane, but neither along it nor about its normal.
  const Eigen::Isometry3d motion = result.T_grid_sensor * guess.inverse ();
  const Eigen::Vector3d centroid = guess.translation (); // that of the points is the origin
  const Eigen::Vector3d shift = motion * centroid - centroid;
  EXPECT_LT ((shift - plane_normal.dot (shift) * plane_normal).norm (), 5e-4);
  const Eigen::AngleAxisd turn (motion.linear ());
  EXPECT_LT (std::abs (turn.angle () * turn.axis ().dot (plane_normal)), radians (0.2));
  // No direction along the plane gains information, wherever the origin is.
  SdfAlignmentResult::Vector6d along = SdfAlignmentResult::Vector6d::Zero ();
  along.head<3> () = plane_normal.unitOrthogonal ();
  EXPECT_LT (along.dot (result.information * along), 1e-6 * result.information.trace ());
}

TEST (SdfAlignmentLimits, BallHoldsItsRotation)
{
  const SignedDistanceField field = ballField ();
  const std::vector<Eigen::Vector3f> points = surfacePoints (field);
  const Eigen::Isometry3d guess = nearby (0.015, radians (10.0));
  const SdfAlignmentResult result = SdfAlignment ().align (points, {}, field, guess);
  EXPECT_TRUE (result.converged);
  EXPECT_EQ (result.observed_directions, 3);
  EXPECT_LT (result.observability[2], 1e-3);
  EXPECT_LT (result.T_grid_sensor.translation ().norm (), 2e-4);
  EXPECT_LT (Eigen::AngleAxisd (result.T_grid_sensor.linear () * guess.linear ().transpose ()).angle (),
             radians (0.01));
}

TEST (SdfAlignmentLimits, CornerDeterminesAllDirections)
{
  const SignedDistanceField field = cornerField ();
  const SdfAlignmentResult result = SdfAlignment ().align (surfacePoints (field), {}, field,
                                                           nearby (0.01, radians (3.0)));
  EXPECT_TRUE (result.converged);
  EXPECT_EQ (result.observed_directions, 6);
  EXPECT_GT (result.inlier_share, 0.95);
  EXPECT_LT (PoseError (result.T_grid_sensor, Eigen::Isometry3d::Identity (), Eigen::Vector3d::Zero ()).shift_m, 1e-3);
}

TEST (SdfAlignmentLimits, PointsThatSayNothingAreLeftOut)
{
  const SignedDistanceField field = cornerField ();
  const std::vector<Eigen::Vector3f> points = surfacePoints (field);
  const Eigen::Isometry3d guess = nearby (0.01, radians (3.0));
  SdfAlignmentOptions options;
  options.levels = 1; // so that the rest keeps its order
  SdfAlignment alignment (options);
  const SdfAlignmentResult expected = alignment.align (points, {}, field, guess);

  std::vector<Eigen::Vector3f> more;
  std::vector<float> weights;
  for (std::size_t n = 0; n < points.size (); ++n)
  {
    more.push_back (points[n]);
    weights.push_back (1.0f);
    more.push_back (Eigen::Vector3f (0.0f, n % 2 ? not_a_number : std::numeric_limits<float>::infinity (), 0.0f));
    weights.push_back (1.0f);
    more.push_back (Eigen::Vector3f (0.01f, 0.05f, 0.0f));
    weights.push_back (n % 3 == 0 ? 0.0f : n % 3 == 1 ? not_a_number : -1.0f);
  }
  const SdfAlignmentResult result = alignment.align (more, weights, field, guess);
  EXPECT_EQ (std::memcmp (result.T_grid_sensor.data (), expected.T_grid_sensor.data (), 16 * sizeof (double)), 0);
  EXPECT_EQ (result.points, points.size ());
  // Far away they are points, but have no distance.
  more.assign (points.begin (), points.end ());
  more.push_back (Eigen::Vector3f::Constant (1e30f));
  EXPECT_EQ (alignment.align (more, {}, field, guess).points_with_distance, expected.points_with_distance);
}

TEST (SdfAlignmentLimits, VoxelsWithoutADistanceSayNothing)
{
  const std::vector<Eigen::Vector3f> points = surfacePoints (cornerField ());
  for (const float unknown :
       {not_a_number, std::numeric_limits<float>::infinity (), std::numeric_limits<float>::max (), -1e30f})
  {
    SignedDistanceField field = cornerField ();
    for (std::size_t v = 0; v < field.values.size (); v += 50)
      field.values[v] = unknown;
    const SdfAlignmentResult result = SdfAlignment ().align (points, {}, field, nearby (0.005, radians (2.0)));
    EXPECT_TRUE (result.converged) << unknown;
    EXPECT_LT (result.T_grid_sensor.translation ().norm (), 1e-3) << unknown;
    EXPECT_TRUE (result.information.allFinite ()) << unknown;
    EXPECT_LT (result.points_with_distance, points.size ()) << unknown;
  }
}

TEST (SdfAlignmentLimits, UnsupportedVoxelsSayNothing)
{
  SignedDistanceField field = cornerField ();
  const std::vector<Eigen::Vector3f> points = surfacePoints (field);
  const Eigen::Isometry3d guess = Eigen::Isometry3d::Identity ();
  const std::size_t all = SdfAlignment ().align (points, {}, field, guess).points_with_distance;
  field.supported.assign (field.values.size (), 1);
  EXPECT_EQ (SdfAlignment ().align (points, {}, field, guess).points_with_distance, all);
  std::fill (field.supported.begin (),
             field.supported.begin () + static_cast<std::ptrdiff_t> (field.supported.size () / 2), 0);
  const SdfAlignmentResult half = SdfAlignment ().align (points, {}, field, guess);
  EXPECT_LT (half.points_with_distance, all * 3 / 4);
  EXPECT_GT (half.points_with_distance, all / 4);
  field.supported.assign (field.values.size (), 0);
  EXPECT_EQ (SdfAlignment ().align (points, {}, field, guess).stop, SdfAlignmentStop::TooFewPoints);
}

TEST (SdfAlignmentLimits, NoPoseIsNoError)
{
  const SignedDistanceField field = cornerField ();
  const Eigen::Isometry3d guess = nearby (0.01, radians (3.0));
  for (const std::vector<Eigen::Vector3f>& points :
       {std::vector<Eigen::Vector3f> (), std::vector<Eigen::Vector3f> (100, Eigen::Vector3f::Constant (not_a_number)),
        std::vector<Eigen::Vector3f> (100, Eigen::Vector3f::Constant (9.0f)),
        std::vector<Eigen::Vector3f> (5, Eigen::Vector3f::Zero ())})
  {
    const SdfAlignmentResult result = SdfAlignment ().align (points, {}, field, guess);
    EXPECT_FALSE (result.converged);
    EXPECT_EQ (result.stop, SdfAlignmentStop::TooFewPoints);
    EXPECT_TRUE (result.T_grid_sensor.isApprox (guess, 1e-12));
    EXPECT_LE (result.observed_directions, points.size () == 5 ? 3 : 0); // five points in one place have no lever
  }
  EXPECT_EQ (SdfAlignment ().align ({100, Eigen::Vector3f::Zero ()}, {}, TsdfVolume (field.grid)).stop,
             SdfAlignmentStop::TooFewPoints); // an empty volume has no distances
  const SignedDistanceField constant = fieldOf ([] (const Eigen::Vector3d&) { return 0.1; });
  const SdfAlignmentResult flat = SdfAlignment ().align ({100, Eigen::Vector3f::Zero ()}, {}, constant, guess);
  EXPECT_EQ (flat.stop, SdfAlignmentStop::NoGradient);
  EXPECT_FALSE (flat.converged);
  EXPECT_STRNE (describe (flat.stop), "");
}

TEST (SdfAlignmentLimits, FewerPointsAndIterationsOnRequest)
{
  const SignedDistanceField field = cornerField ();
  std::vector<Eigen::Vector3f> points = surfacePoints (field);
  while (points.size () < 50000)
    points.insert (points.end (), points.begin (), points.end ());
  SdfAlignmentOptions options;
  options.max_points = 10000;
  const SdfAlignmentResult sampled = SdfAlignment (options).align (points, {}, field, nearby (0.01, radians (3.0)));
  EXPECT_NEAR (static_cast<double> (sampled.points), 10000.0, 500.0);
  EXPECT_TRUE (sampled.converged);
  options.max_iterations = 1;
  const SdfAlignmentResult stopped = SdfAlignment (options).align (points, {}, field, nearby (0.01, radians (3.0)));
  EXPECT_EQ (stopped.iterations, 1);
  EXPECT_EQ (stopped.stop, SdfAlignmentStop::MaxIterations);
}

TEST (SdfAlignmentLimits, RefusesWhatIsNotValid)
{
  SignedDistanceField field = cornerField ();
  const std::vector<Eigen::Vector3f> points (100, Eigen::Vector3f::Zero ());
  SdfAlignment alignment;
  EXPECT_THROW (alignment.align (points, std::vector<float> (99, 1.0f), field), InvalidArgument);
  Eigen::Isometry3d guess = Eigen::Isometry3d::Identity ();
  guess.translation ().x () = not_a_number;
  EXPECT_THROW (alignment.align (points, {}, field, guess), InvalidArgument);
  guess = Eigen::Isometry3d::Identity ();
  guess.linear () *= 2.0;
  EXPECT_THROW (alignment.align (points, {}, field, guess), InvalidArgument);
  guess.linear () = -Eigen::Matrix3d::Identity ();
  EXPECT_THROW (alignment.align (points, {}, field, guess), InvalidArgument);
  field.values.pop_back ();
  EXPECT_THROW (SdfTarget{field}, InvalidArgument);
  EXPECT_THROW (SdfTarget{SignedDistanceField ()}, InvalidArgument);

  const auto refused = [] (const std::function<void (SdfAlignmentOptions&)>& change) {
    SdfAlignmentOptions options;
    change (options);
    EXPECT_THROW (SdfAlignment{options}, InvalidArgument);
  };
  refused ([] (auto& o) { o.huber_m = -1.0; });
  refused ([] (auto& o) { o.max_distance_m = not_a_number; });
  refused ([] (auto& o) { o.max_iterations = 0; });
  refused ([] (auto& o) { o.levels = 0; });
  refused ([] (auto& o) { o.min_level_points = 0; });
  refused ([] (auto& o) { o.max_points = -1; });
  refused ([] (auto& o) { o.tolerance_vox = 0.0; });
  refused ([] (auto& o) { o.min_observability = 1.0; });
  refused ([] (auto& o) { o.min_points = 0; });
  refused ([] (auto& o) { o.threads = -1; });
}
