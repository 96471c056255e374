// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Shelves, whose boards, sides and backs are parallel to the faces of the objects in them.

#include <pcl/cosection/segmentation/geometric_segmentation.h>

#include "label_comparison.h"
#include "table_view.h"

#include <gtest/gtest.h>

#include <sstream>
#include <vector>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

std::string
boxAt (const Eigen::Vector3d& size, const Eigen::Vector3d& position)
{
  std::ostringstream text;
  text << R"({"type": "box", "size": [)" << size.x () << ", " << size.y () << ", " << size.z () << R"(], "position": [)"
       << position.x () << ", " << position.y () << ", " << position.z () << "]}";
  return text.str ();
}

/** \brief A room with boards of 2 cm between sides and a back; the front is at y = -0.15. */
std::string
shelf (const std::vector<double>& boards, double width = 1.2)
{
  std::string parts = R"({"type": "room", "size": [4, 4, 2.5], "position": [0, -0.5, 1.25]})";
  const double height = boards.back ();
  for (const double z : boards)
    parts += ", " + boxAt ({width, 0.3, 0.02}, {0, 0, z});
  for (const double side : {-0.5, 0.5})
    parts += ", " + boxAt ({0.02, 0.3, height}, {side * width, 0, 0.5 * height});
  return parts + ", " + boxAt ({width, 0.02, height}, {0, 0.16, 0.5 * height});
}

std::string
cylinder (int id, double radius, double height, const Eigen::Vector3d& foot)
{
  std::ostringstream text;
  text << R"(, {"name": "can)" << id << R"(", "id": )" << id << R"(, "shape": {"type": "cylinder", "radius": )"
       << radius << R"(, "height": )" << height << R"(}, "keys": [{"position": [)" << foot.x () << ", " << foot.y ()
       << ", " << foot.z () << "]}]}";
  return text.str ();
}

/** \brief Expect each true object, and at most a few small pieces of the room. */
void
expectFoundOnShelf (const SceneView& view, double least_iou, std::size_t background_pixels = 0)
{
  const ObjectSegmentation found = segmentObjects (view.points, view.width, view.height);
  const LabelComparison comparison = compareLabels (view.labels, found.labels, view.valid);
  EXPECT_LE (comparison.background_pixels, background_pixels);
  for (const auto& [object, iou] : comparison.best_iou)
    EXPECT_GE (iou, least_iou) << "object " << object;
}

} // namespace

TEST (ShelfSegmentation, FacesAlongTheShelf)
{
  const std::string objects = boxOnTable (1, {0.12, 0.08, 0.2}, {-0.4, -0.02, 0.46}, 0) +
                              boxOnTable (2, {0.2, 0.14, 0.06}, {0.02, -0.02, 0.46}, 0) +
                              boxOnTable (3, {0.1, 0.1, 0.08}, {0.02, -0.02, 0.52}, 0) +
                              boxOnTable (4, {0.07, 0.07, 0.18}, {0.45, -0.05, 0.46}, 0) +
                              boxOnTable (5, {0.25, 0.15, 0.12}, {-0.3, -0.02, 0.11}, 0) +
                              cylinder (6, 0.05, 0.2, {0.1, -0.04, 0.11});
  expectFoundOnShelf (viewOfScene (shelf ({0.1, 0.45, 0.8}), objects, {0, -1.3, 0.75}, {0, 0, 0.45}), 0.85, 700);
}

TEST (ShelfSegmentation, FlushWithTheFrontOfTheBoard)
{
  // Their fronts continue that of the board, without any edge.
  const std::string objects = boxOnTable (1, {0.14, 0.3, 0.18}, {-0.35, 0, 0.41}, 0) +
                              boxOnTable (2, {0.2, 0.15, 0.1}, {-0.1, -0.075, 0.41}, 0) +
                              boxOnTable (3, {0.12, 0.2, 0.25}, {0.3, -0.05, 0.41}, 0);
  expectFoundOnShelf (viewOfScene (shelf ({0.4, 0.8}, 1.0), objects, {0.3, -1.2, 0.9}, {0, 0, 0.6}), 0.75, 700);
}

TEST (ShelfSegmentation, AgainstTheBack)
{
  const std::string objects = boxOnTable (1, {0.15, 0.1, 0.12}, {-0.3, 0.1, 0.51}, 0) +
                              boxOnTable (2, {0.1, 0.05, 0.2}, {0.05, 0.125, 0.51}, 0) +
                              boxOnTable (3, {0.2, 0.2, 0.1}, {0.3, 0.05, 0.51}, 0);
  expectFoundOnShelf (viewOfScene (shelf ({0.15, 0.5, 0.85}, 1.0), objects, {0.1, -1.1, 1.0}, {0, 0, 0.6}), 0.75, 700);
}

TEST (ShelfSegmentation, SeenAtASmallAngle)
{
  // Normals of the board are missing or wrong: it is hardly seen.
  const std::string objects = boxOnTable (1, {0.12, 0.08, 0.2}, {-0.3, -0.02, 0.51}, 0) +
                              boxOnTable (2, {0.15, 0.1, 0.1}, {0.0, -0.05, 0.51}, 0) +
                              cylinder (3, 0.045, 0.15, {0.3, -0.02, 0.51});
  expectFoundOnShelf (viewOfScene (shelf ({0.15, 0.5, 0.9}), objects, {-0.2, -1.2, 0.62}, {0, 0, 0.55}), 0.8, 700);
}

TEST (ShelfSegmentation, EmptyShelvesHoldNothing)
{
  for (const double height : {0.5, 0.8, 1.2})
  {
    const SceneView view = viewOfScene (shelf ({0.1, 0.45, 0.8}), "", {0.1, -1.3, height}, {0, 0, 0.45});
    const ObjectSegmentation found = segmentObjects (view.points, view.width, view.height);
    const LabelComparison comparison = compareLabels (view.labels, found.labels, view.valid);
    EXPECT_LE (comparison.background_pixels, 1500u) << "from a height of " << height;
  }
}

TEST (ShelfSegmentation, ALegThatTheBorderCutsIsNoObject)
{
  // Its visible part is shorter than an object may be, but it extends to the floor.
  const std::string desk = R"({"type": "room", "size": [3, 2, 2.5], "position": [0, -0.4, 1.25]}, )" +
                           boxAt ({1.4, 0.7, 0.03}, {0, 0.25, 0.735}) + ", " +
                           boxAt ({0.05, 0.05, 0.72}, {-0.65, -0.05, 0.36}) + ", " +
                           boxAt ({0.05, 0.05, 0.72}, {0.65, -0.05, 0.36});
  const SceneView view = viewOfScene (desk, boxOnTable (1, {0.4, 0.14, 0.05}, {-0.1, 0.1, 0.75}, 3),
                                      {-0.3, -0.95, 1.25}, {0, 0.1, 0.78});
  expectFoundOnShelf (view, 0.85, 1200);
}

TEST (ShelfSegmentation, FlushWithTheEdgeOfATable)
{
  // Readings of its front alternate between its plane and that of the table's edge.
  const std::string desk = R"({"type": "room", "size": [3, 2, 2.5], "position": [0, -0.4, 1.25]}, )" +
                           boxAt ({1.4, 0.7, 0.03}, {0, 0.25, 0.735});
  const SceneView view = viewOfScene (desk, boxOnTable (1, {0.22, 0.15, 0.05}, {0.3, -0.025, 0.75}, 0),
                                      {0.2, -0.8, 1.0}, {0, 0.1, 0.8});
  expectFoundOnShelf (view, 0.5, 1200);
}

TEST (ShelfSegmentation, AnyNumberOfThreads)
{
  const SceneView view = viewOfScene (shelf ({0.1, 0.45, 0.8}),
                                      boxOnTable (1, {0.12, 0.08, 0.2}, {-0.4, -0.02, 0.46}, 0), {0, -1.3, 0.75},
                                      {0, 0, 0.45});
  ObjectSegmentationOptions options;
  options.threads = 1;
  const ObjectSegmentation one = segmentObjects (view.points, view.width, view.height, options);
  options.threads = 3;
  EXPECT_EQ (one.labels, segmentObjects (view.points, view.width, view.height, options).labels);
}
