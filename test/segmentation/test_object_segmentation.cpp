// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/segmentation/geometric_segmentation.h>

#include "common/not_a_number.h"
#include "label_comparison.h"
#include "table_view.h"

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief Expect each true object, and no others. */
void
expectFound (const SceneView& view, double least_iou)
{
  const ObjectSegmentation found = segmentObjects (view.points, view.width, view.height);
  const LabelComparison comparison = compareLabels (view.labels, found.labels, view.valid);
  EXPECT_EQ (found.objects, comparison.best_iou.size ());
  EXPECT_EQ (comparison.background_pixels, 0u);
  for (const auto& [object, iou] : comparison.best_iou)
    EXPECT_GE (iou, least_iou) << "object " << object;
  std::vector<std::ptrdiff_t> pixels;
  for (std::uint32_t n = 1; n <= found.objects; ++n)
    pixels.push_back (std::count (found.labels.begin (), found.labels.end (), n));
  EXPECT_TRUE (std::is_sorted (pixels.rbegin (), pixels.rend ())) << "the largest in the image is first";
  for (std::size_t i = 0; i < view.valid.size (); ++i)
    ASSERT_TRUE (view.valid[i] || found.labels[i] == 0u) << "a pixel without reading has a label";
}

} // namespace

TEST (ObjectSegmentation, BoxesApart)
{
  expectFound (viewOfTable (boxOnTable (1, {0.10, 0.10, 0.12}, {-0.2, 0, 0}, 20) +
                            boxOnTable (2, {0.2, 0.12, 0.03}, {0.1, 0, 0}, -15)),
               0.9);
}

TEST (ObjectSegmentation, StackedAndTouching)
{
  expectFound (viewOfTable (boxOnTable (1, {0.2, 0.14, 0.06}, {-0.25, 0.05, 0}, -20) +
                            boxOnTable (2, {0.1, 0.1, 0.08}, {-0.25, 0.05, 0.06}, 25) +
                            boxOnTable (3, {0.1, 0.1, 0.1}, {0.2, 0, 0}, 0) +
                            boxOnTable (4, {0.08, 0.1, 0.06}, {0.291, -0.03, 0}, 0)),
               0.85);
}

TEST (ObjectSegmentation, DividedBySomethingInFront)
{
  expectFound (viewOfTable (boxOnTable (1, {0.3, 0.06, 0.14}, {0, 0.2, 0}, 5) +
                            boxOnTable (2, {0.06, 0.06, 0.2}, {0, 0.05, 0}, 30)),
               0.9);
}

TEST (ObjectSegmentation, AlignedThingsAreNotOne)
{
  // Their fronts are in one plane, and something stands before the gap: but the table is seen through it.
  expectFound (viewOfTable (boxOnTable (1, {0.12, 0.06, 0.1}, {-0.14, 0.2, 0}, 0) +
                            boxOnTable (2, {0.12, 0.06, 0.1}, {0.14, 0.2, 0}, 0) +
                            boxOnTable (3, {0.06, 0.06, 0.08}, {-0.06, 0.05, 0}, 10)),
               0.85);
}

TEST (ObjectSegmentation, InsideOfACup)
{
  const std::string cup = R"({"name": "cup", "id": 1, "shape": {"type": "revolution", "profile":
    [[0, 0], [0.04, 0], [0.04, 0.1], [0.036, 0.1], [0.036, 0.005], [0, 0.005]]}, "keys": [{"position": [0, 0, 0]}]})";
  expectFound (viewOfTable (cup, {-0.1, -0.5, 0.5}), 0.9);
}

TEST (ObjectSegmentation, TheFloorOfAPlateIsNoTable)
{
  // It is 4 mm above the table: three standard deviations of a reading.
  const std::string plate = R"({"name": "plate", "id": 1, "shape": {"type": "revolution", "profile":
    [[0, 0], [0.06, 0], [0.1, 0.03], [0.1, 0.034], [0.06, 0.004], [0, 0.004]]}, "keys": [{"position": [0, 0, 0]}]})";
  // The box has more pixels than the plate's rim, and fewer than the plate.
  expectFound (viewOfTable (plate + boxOnTable (2, {0.09, 0.12, 0.1}, {0.22, 0.0, 0.0}, 10), {-0.1, -0.5, 0.5}), 0.9);
}

TEST (ObjectSegmentation, TheTableInARingIsNoObject)
{
  const std::string ring = R"({"name": "ring", "id": 1, "shape": {"type": "revolution", "profile":
    [[0.06, 0], [0.1, 0], [0.1, 0.03], [0.06, 0.03]]}, "keys": [{"position": [0, 0, 0]}]})";
  expectFound (viewOfTable (ring, {-0.1, -0.5, 0.5}), 0.85);
}

TEST (ObjectSegmentation, ADifferentVertical)
{
  // No direction of gravity is assumed: the same view, turned by half a revolution.
  SceneView view = viewOfTable (boxOnTable (1, {0.10, 0.10, 0.12}, {-0.2, 0, 0}, 20) +
                                boxOnTable (2, {0.2, 0.12, 0.05}, {0.1, 0, 0}, -15));
  std::reverse (view.points.begin (), view.points.end ());
  std::reverse (view.labels.begin (), view.labels.end ());
  std::reverse (view.valid.begin (), view.valid.end ());
  for (Eigen::Vector3f& p : view.points)
    p.head<2> () *= -1.0f;
  expectFound (view, 0.9);
}

TEST (ObjectSegmentation, CutByTheImage)
{
  // The table is not seen where the box stands, but behind it.
  expectFound (viewOfTable (boxOnTable (1, {0.12, 0.1, 0.12}, {0, -0.28, 0}, 0) +
                                boxOnTable (2, {0.1, 0.1, 0.1}, {0.15, 0, 0}, 20),
                            {0, -0.5, 0.5}),
               0.9);
}

TEST (ObjectSegmentation, FurnitureIsNoObject)
{
  const SceneView view = viewOfTable (boxOnTable (1, {0.7, 0.1, 0.1}, {0, 0.1, 0}, 0));
  EXPECT_EQ (segmentObjects (view.points, view.width, view.height).objects, 0u);
  ObjectSegmentationOptions options;
  options.max_object_size_m = 0.9;
  EXPECT_EQ (segmentObjects (view.points, view.width, view.height, options).objects, 1u);
}

TEST (ObjectSegmentation, SupportPlanesFaceTheSensor)
{
  const SceneView view = viewOfTable (boxOnTable (1, {0.10, 0.10, 0.12}, {0, 0, 0}, 20));
  const ObjectSegmentation found = segmentObjects (view.points, view.width, view.height);
  ASSERT_GE (found.support_planes.size (), 2u); // table, wall or floor
  for (const Eigen::Vector4f& plane : found.support_planes)
  {
    EXPECT_NEAR (plane.head<3> ().norm (), 1.0f, 1e-5f);
    EXPECT_GT (plane.w (), 0.0f);
  }
}

TEST (ObjectSegmentation, AnyNumberOfThreads)
{
  const SceneView view = viewOfTable (boxOnTable (1, {0.2, 0.14, 0.06}, {0, 0, 0}, -20) +
                                      boxOnTable (2, {0.1, 0.1, 0.08}, {0, 0, 0.06}, 25));
  ObjectSegmentationOptions options;
  options.threads = 1;
  const ObjectSegmentation one = segmentObjects (view.points, view.width, view.height, options);
  options.threads = 3;
  EXPECT_EQ (one.labels, segmentObjects (view.points, view.width, view.height, options).labels);
}

TEST (ObjectSegmentation, NothingToStandOn)
{
  std::vector<Eigen::Vector3f> points (64 * 48, Eigen::Vector3f::Constant (not_a_number));
  EXPECT_THROW (segmentObjects (points, 64, 48), DegenerateInput);
  points[100] = Eigen::Vector3f (0, 0, 1);
  EXPECT_THROW (segmentObjects (points, 64, 48), DegenerateInput);
  for (int i = 0; i < 64 * 48; ++i) // a ball
  {
    const Eigen::Vector3f ray = Eigen::Vector3f (static_cast<float> (i % 64 - 32), static_cast<float> (i / 64 - 24), 60)
                                    .normalized ();
    const float b = ray.z () * 0.5f, c = 0.25f - 0.01f;
    points[i] = b * b > c ? Eigen::Vector3f (ray * (b - std::sqrt (b * b - c)))
                          : Eigen::Vector3f::Constant (not_a_number);
  }
  EXPECT_THROW (segmentObjects (points, 64, 48), DegenerateInput);
  EXPECT_THROW (segmentObjects (std::vector<Eigen::Vector3f> (64 * 48, Eigen::Vector3f::Zero ()), 64, 48),
                DegenerateInput);
}

TEST (ObjectSegmentation, WrongArguments)
{
  const std::vector<Eigen::Vector3f> points (12, Eigen::Vector3f (0, 0, 1));
  EXPECT_THROW (segmentObjects (points, 5, 3), InvalidArgument);
  EXPECT_THROW (segmentObjects (points, 0, 0), InvalidArgument);
  for (const double wrong : {0.0, -1.0, static_cast<double> (not_a_number)})
  {
    ObjectSegmentationOptions options;
    options.max_object_size_m = wrong;
    EXPECT_THROW (options.validate (), InvalidArgument);
    options = {};
    options.min_object_size_m = wrong;
    EXPECT_THROW (options.validate (), InvalidArgument);
    options = {};
    options.concave_angle_rad = wrong;
    EXPECT_THROW (options.validate (), InvalidArgument);
    options = {};
    options.min_support_area_m2 = wrong;
    EXPECT_THROW (options.validate (), InvalidArgument);
  }
}
