// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Alignment of an object's views with its volume, from poses nearby.

#include "tracking_scene.h"

#include <pcl/cosection/tracking/sdf_alignment.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr int resolution = 64;
constexpr int trials = 200;

struct Bounds
{
  double shift_m;
  double angle_rad;
};

struct Outcome
{
  int good = 0; // within the bounds
  int converged = 0;
};

/** \brief Align from guesses that are wrong by up to 10 degrees and 5 cm. */
Outcome
alignPerturbed (const SdfTarget& target, const Eigen::Vector3d& center, const std::vector<BodyView>& views,
                const Bounds& bounds)
{
  std::mt19937 random (7);
  SdfAlignment alignment;
  Outcome outcome;
  for (int trial = 0; trial < trials; ++trial)
  {
    const BodyView& view = views[trial % views.size ()];
    const Eigen::Isometry3d guess = randomMotion (random, center, radians (10.0), 0.05) * view.T_body_sensor;
    const SdfAlignmentResult result = alignment.align (view.points (body_camera), {}, target, guess);
    const PoseError error (result.T_grid_sensor, view.T_body_sensor, center);
    outcome.converged += result.converged;
    outcome.good += error.shift_m < bounds.shift_m && error.angle_rad < bounds.angle_rad;
  }
  return outcome;
}

/** \brief A truck of boxes and axles; a car, an outline extruded. Neither has more than one plane of symmetry. */
class SdfAlignmentOfToys : public testing::TestWithParam<std::string>
{
protected:
  SceneBody body_ = presetBody ("toys", GetParam ());
  Eigen::Vector3d center_ = bodyCenter (body_);
};

} // namespace

TEST_P (SdfAlignmentOfToys, ConvergesFromTenDegreesAndFiveCentimetres)
{
  const auto views = renderBody (body_, body_camera, posesAroundBody (center_, body_distance_m, 10), false);
  const Outcome outcome = alignPerturbed (bodyDistance (body_, resolution), center_, views, {1e-3, radians (0.2)});
  EXPECT_GE (outcome.good, trials * 95 / 100);
  EXPECT_GE (outcome.converged, trials * 95 / 100);
}

TEST_P (SdfAlignmentOfToys, ConvergesWithTheNoiseOfStructuredLight)
{
  const auto views = renderBody (body_, body_camera, posesAroundBody (center_, body_distance_m, 10), true);
  const Outcome outcome = alignPerturbed (bodyDistance (body_, resolution), center_, views, {2e-3, radians (0.5)});
  EXPECT_GE (outcome.good, trials * 95 / 100);
}

/** \brief A TSDF from views around the object, and other views between those. Averages of projective distances at
 * different angles are not zero on the surface, so the tolerance is a quarter of a voxel at the centre and at the ends.
 */
TEST_P (SdfAlignmentOfToys, ConvergesInTheTsdfOfASequence)
{
  std::vector<Eigen::Isometry3d> integrated, between;
  for (int frame = 0; frame < 24; ++frame)
  {
    integrated.push_back (poseOnCircle (center_, body_distance_m, radians (5.0 * frame)));
    if (frame % 2 == 0)
      between.push_back (poseOnCircle (center_, body_distance_m, radians (5.0 * frame + 2.5)));
  }
  TsdfOptions options;
  options.truncation_vox = 5.0;
  const TsdfVolume volume = bodyTsdf (body_, body_camera, renderBody (body_, body_camera, integrated, false),
                                      resolution, options);
  const double half_length_vox = 0.5 * resolution / 1.25; // the volume is a quarter larger
  const Bounds bounds{0.25 * volume.grid ().voxel_size_m, 0.25 / half_length_vox};
  const Outcome outcome = alignPerturbed (volume, center_, renderBody (body_, body_camera, between, false), bounds);
  EXPECT_GE (outcome.good, trials * 95 / 100);
}

TEST_P (SdfAlignmentOfToys, IsTheSameForAnyNumberOfThreads)
{
  const PinholeCamera large{640, 480, 525.0, 525.0, 319.5, 239.5};
  const BodyView view = renderBody (body_, large, {poseOnCircle (center_, 0.5, 1.0)}, false).front ();
  const SignedDistanceField field = bodyDistance (body_, resolution);
  std::mt19937 random (3);
  const Eigen::Isometry3d guess = randomMotion (random, center_, radians (5.0), 0.03) * view.T_body_sensor;
  SdfAlignmentResult expected;
  for (const int threads : {1, 2, 5})
  {
    SdfAlignmentOptions options;
    options.threads = threads;
    const SdfAlignmentResult result = SdfAlignment (options).align (view.points (large), {}, field, guess);
    if (threads == 1)
    {
      expected = result;
      ASSERT_GT (result.points, 2u * 16384u); // enough for more than one thread
    }
    EXPECT_EQ (std::memcmp (result.T_grid_sensor.data (), expected.T_grid_sensor.data (), 16 * sizeof (double)), 0);
    EXPECT_EQ (std::memcmp (result.information.data (), expected.information.data (), 36 * sizeof (double)), 0);
    EXPECT_EQ (result.rms_m, expected.rms_m);
    EXPECT_EQ (result.iterations, expected.iterations);
  }
}

/** \brief The information matrix by central differences of trilinear samples, at the aligned pose. */
TEST_P (SdfAlignmentOfToys, InformationIsThatOfFiniteDifferences)
{
  const BodyView view = renderBody (body_, body_camera, {poseOnCircle (center_, body_distance_m, 1.0)}, false).front ();
  const std::vector<BodyView> integrated = renderBody (
      body_, body_camera, {poseOnCircle (center_, body_distance_m, 0.9), poseOnCircle (center_, body_distance_m, 1.1)},
      false);
  const TsdfVolume volume = bodyTsdf (body_, body_camera, integrated, resolution);
  const std::vector<Eigen::Vector3f> points = view.points (body_camera);
  std::vector<float> weights (points.size ());
  for (std::size_t n = 0; n < points.size (); ++n)
    weights[n] = 0.25f + static_cast<float> (n % 3);
  const SdfAlignmentResult result = SdfAlignment ().align (points, weights, volume, view.T_body_sensor);

  using Vector6d = SdfAlignmentResult::Vector6d;
  constexpr double h = 1e-7; // m, rad; seldom across a cell's face
  const double huber = 0.2 * volume.truncation ();
  SdfAlignmentResult::Matrix6d information = SdfAlignmentResult::Matrix6d::Zero ();
  std::size_t with_distance = 0;
  for (std::size_t n = 0; n < points.size (); ++n)
  {
    const Eigen::Vector3d p = result.T_grid_sensor * points[n].cast<double> ();
    const auto cell = volume.sample (p);
    if (!cell)
      continue;
    ++with_distance;
    Vector6d derivative;
    for (int d = 0; d < 6; ++d)
    {
      const Eigen::Vector3d axis = Eigen::Vector3d::Unit (d % 3);
      const Eigen::Vector3d step = h * (d < 3 ? axis : Eigen::Vector3d (axis.cross (p)));
      const auto after = volume.sample<double> (p + step);
      const auto before = volume.sample<double> (p - step);
      derivative[d] = after && before ? (after->value () - before->value ()) / (2.0 * h) : 0.0;
    }
    const double distance = std::abs (cell->value ());
    const double robust = distance <= huber ? 1.0 : huber / distance;
    const double w = robust * weights[n] * volume.weight (p) / volume.options ().max_weight;
    information += w * derivative * derivative.transpose ();
  }
  EXPECT_NEAR (static_cast<double> (result.points_with_distance), static_cast<double> (with_distance), 2.0);
  EXPECT_LT ((result.information - information).norm (), 1e-3 * information.norm ());
  // Rotations and translations are of different size.
  EXPECT_LT ((result.information - information).topLeftCorner (3, 3).norm (),
             1e-3 * information.topLeftCorner (3, 3).norm ());
  EXPECT_LT ((result.information - information).bottomRightCorner (3, 3).norm (),
             1e-3 * information.bottomRightCorner (3, 3).norm ());
}

INSTANTIATE_TEST_SUITE_P (Toys, SdfAlignmentOfToys, testing::Values ("truck", "car"),
                          [] (const auto& tested) { return tested.param; });
