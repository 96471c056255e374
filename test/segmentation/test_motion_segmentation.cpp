// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/segmentation/motion_segmentation.h>

#include "common/not_a_number.h"
#include "label_comparison.h"
#include "moving_view.h"

#include <pcl/cosection/common/error.h>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief The segmentation of the last of some frames. */
struct Found
{
  MovingView last;
  std::vector<std::uint32_t> labels;
  LabelComparison comparison;

  std::set<std::uint32_t> bodies () const
  {
    std::set<std::uint32_t> numbers (labels.begin (), labels.end ());
    numbers.erase (0);
    numbers.erase (MotionSegments::unexplained);
    return numbers;
  }

  /** \brief Number of resting pixels that are labelled as moving. */
  long wrong () const
  {
    long count = 0;
    for (std::size_t i = 0; i < labels.size (); ++i)
      count += labels[i] != 0 && last.labels[i] == 0;
    return count;
  }
};

Found
segmented (const MovingTable& table, const std::vector<int>& frames, const MotionSegmentationOptions& options = {})
{
  MovingBodyFinder finder (options);
  Found found;
  for (const int n : frames)
  {
    found.last = table.at (n);
    finder.add (found.last.frame);
  }
  found.labels = finder.segment ().labels;
  found.comparison = compareLabels (found.last.labels, found.labels, found.last.valid);
  return found;
}

std::vector<int>
upTo (int last, int step = 2)
{
  std::vector<int> frames;
  for (int n = last % step; n <= last; n += step)
    frames.push_back (n);
  return frames;
}

const Eigen::Vector3d carton (0.2, 0.14, 0.1);
const std::string resting = movingBox (1, carton, R"({"position": [0.2, 0.1, 0.051]})");

} // namespace

TEST (MotionSegmentation, SlidesAlongATable)
{
  // Its top slides along itself, in front of the table: only its outline and the sides show the motion.
  const MovingTable table (resting + movingBox (2, carton, R"({"time": 0.3, "position": [-0.2, 0, 0.051]},
                                                              {"time": 1.3, "position": [0, -0.1, 0.051]})"));
  EXPECT_TRUE (segmented (table, upTo (9)).bodies ().empty ());
  const Found moved = segmented (table, upTo (20)); // by some 5 cm
  EXPECT_EQ (moved.bodies ().size (), 1u);
  EXPECT_GE (moved.comparison.best_iou.at (2), 0.85);
  EXPECT_EQ (moved.comparison.best_iou.at (1), 0.0);
  const Found later = segmented (table, upTo (36));
  EXPECT_GE (later.comparison.best_iou.at (2), 0.9);
}

TEST (MotionSegmentation, OfTwoThatTouchOneMovesAway)
{
  const std::string stays = movingBox (1, carton, R"({"position": [-0.1, 0.1, 0.051]})");
  const MovingTable table (stays + movingBox (2, carton, R"({"time": 0.3, "position": [0.1005, 0.1, 0.051]},
                                                            {"time": 1.3, "position": [0.25, 0.1, 0.051]})"));
  const Found moved = segmented (table, upTo (22)); // by 4 cm
  EXPECT_GE (moved.comparison.best_iou.at (2), 0.8);
  EXPECT_EQ (moved.comparison.best_iou.at (1), 0.0);
  EXPECT_EQ (moved.bodies ().size (), 1u);
}

TEST (MotionSegmentation, PushedSideways)
{
  // The boxes are in a row, and the front one is pulled out sideways: their fronts stay in their planes.
  const std::string stays = movingBox (1, carton, R"({"position": [0.0, 0.2, 0.051]})");
  const MovingTable table (stays + movingBox (2, carton, R"({"time": 0.3, "position": [0.0, 0.0595, 0.051]},
                                                            {"time": 1.3, "position": [0.15, 0.0595, 0.051]})"));
  const Found moved = segmented (table, upTo (24));
  EXPECT_GE (moved.comparison.best_iou.at (2), 0.8);
  EXPECT_EQ (moved.comparison.best_iou.at (1), 0.0);
}

TEST (MotionSegmentation, OnlyTheCameraMoves)
{
  const MovingTable table (resting +
                               movingBox (2, carton, R"({"position": [-0.2, -0.1, 0.051], "rpy_deg": [0, 0, 20]})"),
                           R"({"time": 0, "position": [-0.4, -0.9, 0.7], "look_at": [0, 0, 0.05]},
                              {"time": 2, "position": [0.5, -0.7, 0.5], "look_at": [0.1, 0, 0.05]})");
  for (const int last : {20, 40, 58})
  {
    const Found found = segmented (table, upTo (last));
    EXPECT_TRUE (found.bodies ().empty ()) << "frame " << last;
    EXPECT_EQ (found.wrong (), 0) << "frame " << last;
  }
}

TEST (MotionSegmentation, TheCameraMovesToo)
{
  const MovingTable table (resting + movingBox (2, carton, R"({"time": 0.3, "position": [-0.2, 0, 0.051]},
                                                              {"time": 1.3, "position": [0, -0.1, 0.051]})"),
                           R"({"time": 0, "position": [-0.4, -0.9, 0.7], "look_at": [0, 0, 0.05]},
                              {"time": 2, "position": [0.3, -0.7, 0.5], "look_at": [0.1, 0, 0.05]})");
  const Found moved = segmented (table, upTo (26));
  EXPECT_GE (moved.comparison.best_iou.at (2), 0.85);
  EXPECT_EQ (moved.bodies ().size (), 1u);
  EXPECT_LT (moved.wrong (), 60);
}

TEST (MotionSegmentation, Turns)
{
  const MovingTable table (resting + movingBox (2, carton, R"({"time": 0.3, "position": [-0.2, 0, 0.051]},
                                                              {"time": 1.3, "position": [-0.2, 0, 0.051],
                                                                "rpy_deg": [0, 0, 60]})"));
  const Found moved = segmented (table, upTo (24));
  EXPECT_GE (moved.comparison.best_iou.at (2), 0.8);
  EXPECT_EQ (moved.bodies ().size (), 1u);
}

TEST (MotionSegmentation, TwoMotionsAreTwoBodies)
{
  const MovingTable table (movingBox (1, carton, R"({"time": 0.3, "position": [0.2, 0.1, 0.051]},
                                                    {"time": 1.3, "position": [0.3, 0.1, 0.051], "rpy_deg": [0, 0,
                                                      30]})") +
                           movingBox (2, carton, R"({"time": 0.3, "position": [-0.2, 0, 0.051]},
                                                    {"time": 1.3, "position": [0, -0.1, 0.051]})"));
  const Found moved = segmented (table, upTo (28));
  EXPECT_EQ (moved.bodies ().size (), 2u);
  EXPECT_GE (moved.comparison.best_iou.at (1), 0.8);
  EXPECT_GE (moved.comparison.best_iou.at (2), 0.8);
}

TEST (MotionSegmentation, WhatComesInSightBehindIsAtRest)
{
  // Something as wide as a person passes: the table and the box behind it appear again.
  const MovingTable table (resting + movingBox (2, {0.3, 0.1, 0.5}, R"({"time": 0.2, "position": [-0.1, -0.25,
    0.251]},
                                                                       {"time": 1.2, "position": [0.5, -0.25,
                                                                         0.251]})"));
  for (const int last : {18, 24, 30})
  {
    const Found found = segmented (table, upTo (last));
    EXPECT_EQ (found.bodies ().size (), 1u) << "frame " << last;
    EXPECT_GE (found.comparison.best_iou.at (2), 0.85) << "frame " << last;
    for (const auto& [body, iou] : found.comparison.best_iou) // the box may be hidden
      EXPECT_EQ (iou > 0.0, body == 2) << "body " << body << ", frame " << last;
    EXPECT_LT (found.wrong (), 100) << "frame " << last;
  }
}

TEST (MotionSegmentation, ABodyKeepsItsNumber)
{
  const MovingTable table (movingBox (1, carton, R"({"time": 0.3, "position": [0.2, 0.1, 0.051]},
                                                    {"time": 1.3, "position": [0.3, 0.1, 0.051], "rpy_deg": [0, 0,
                                                      30]})") +
                           movingBox (2, carton, R"({"time": 0.3, "position": [-0.2, 0, 0.051]},
                                                    {"time": 1.3, "position": [0, -0.1, 0.051]})"));
  MovingBodyFinder finder;
  std::map<std::uint32_t, std::set<std::uint32_t>> numbers;
  for (int n = 0; n <= 38; n += 2)
  {
    const MovingView view = table.at (n);
    finder.add (view.frame);
    if (n < 22 || n % 6 != 4)
      continue;
    const MotionSegments found = finder.segment ();
    for (std::size_t i = 0; i < found.labels.size (); ++i)
      if (found.labels[i] != 0 && view.labels[i] != 0)
        numbers[view.labels[i]].insert (found.labels[i]);
  }
  for (const std::uint32_t id : {1u, 2u})
    EXPECT_EQ (numbers[id].size (), 1u) << "body " << id;
}

TEST (MotionSegmentation, SlowMotionShowsAgainstAModelOfTheRoom)
{
  const MovingTable table (movingBox (1, carton, R"({"position": [0.2, 0.1, 0.051]})"));
  MotionFrame frame = table.at (0).frame;
  MovingBodyFinder finder;
  finder.add (frame);
  frame = table.at (1).frame;
  finder.add (frame);
  const std::vector<std::uint32_t> without = finder.segment ().labels;
  EXPECT_EQ (std::count (without.begin (), without.end (), 0u), static_cast<long> (without.size ()));
  frame.expected_depth = table.at (1).room_depth;
  finder.add (frame);
  // It was put there before the first frame: it did not move in them, and is not where the room is.
  const std::vector<std::uint32_t> with = finder.segment ().labels;
  const MovingView truth = table.at (1);
  long box = 0, hits = 0;
  for (std::size_t i = 0; i < with.size (); ++i)
  {
    box += truth.labels[i] == 1 && truth.valid[i];
    hits += truth.labels[i] == 1 && with[i] != 0;
  }
  EXPECT_GT (hits, box / 2);
}

TEST (MotionSegmentation, WhatMovesAsAKnownBodyIsAPartOfIt)
{
  const MovingTable table (resting + movingBox (2, carton, R"({"time": 0.3, "position": [-0.2, 0, 0.051]},
                                                              {"time": 1.3, "position": [0, -0.1, 0.051]})"));
  MovingBodyFinder finder;
  MovingView view;
  const auto positionAt = [&] (int n) { // as the simulation's smooth motion, by the mean of the body's readings
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity ();
    const double s = std::min (1.0, std::max (0.0, n / 30.0 - 0.3));
    T.translation () = (Eigen::Vector3d (0.2, -0.1, 0.0) * (s * s * (3.0 - 2.0 * s)));
    return T;
  };
  for (const int n : upTo (24))
  {
    view = table.at (n);
    view.frame.bodies.assign (view.labels.size (), 0);
    for (int v = 0; v < 240; ++v) // its left half only
      for (int u = 0; u < 110; ++u)
        if (view.labels[v * 320 + u] == 2)
          view.frame.bodies[v * 320 + u] = 7;
    view.frame.T_world_body[7] = positionAt (n);
    finder.add (view.frame);
  }
  const std::vector<std::uint32_t> labels = finder.segment ().labels;
  const LabelComparison comparison = compareLabels (view.labels, labels, view.valid);
  EXPECT_GE (comparison.best_iou.at (2), 0.8);
  EXPECT_GT (std::count (labels.begin (), labels.end (), 7u), 0);
  EXPECT_EQ (
      std::count_if (labels.begin (), labels.end (), [] (std::uint32_t label) { return label != 0 && label != 7; }), 0);
}

TEST (MotionSegmentation, AnyNumberOfThreads)
{
  const MovingTable table (resting + movingBox (2, carton, R"({"time": 0.3, "position": [-0.2, 0, 0.051]},
                                                              {"time": 1.3, "position": [0, -0.1, 0.051]})"));
  MotionSegmentationOptions options;
  options.threads = 1;
  const std::vector<std::uint32_t> one = segmented (table, upTo (24), options).labels;
  options.threads = 3;
  EXPECT_EQ (one, segmented (table, upTo (24), options).labels);
}

TEST (MotionSegmentation, OfPcl)
{
  const MovingTable table (resting + movingBox (2, carton, R"({"time": 0.3, "position": [-0.2, 0, 0.051]},
                                                              {"time": 1.3, "position": [0, -0.1, 0.051]})"));
  MotionSegmentation<pcl::PointXYZ> segmentation;
  pcl::PointCloud<pcl::Label> labels;
  std::vector<pcl::PointIndices> label_indices;
  MovingView view;
  for (const int n : {0, 8, 24})
  {
    view = table.at (n);
    auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>> (320, 240);
    for (std::size_t i = 0; i < cloud->size (); ++i)
      (*cloud)[i].getVector3fMap () = view.frame.points[i];
    cloud->sensor_origin_.head<3> () = view.frame.T_world_sensor.translation ().cast<float> ();
    cloud->sensor_orientation_ = Eigen::Quaternionf (view.frame.T_world_sensor.linear ().cast<float> ());
    segmentation.setInputCloud (cloud);
    segmentation.segment (labels, label_indices);
    EXPECT_EQ (labels.width, 320u);
    EXPECT_EQ (labels.height, 240u);
    EXPECT_EQ (label_indices.empty (), n < 24);
  }
  ASSERT_EQ (label_indices.size (), 1u);
  std::size_t right = 0;
  for (const auto i : label_indices[0].indices)
  {
    EXPECT_EQ (labels[i].label, 1u);
    right += view.labels[i] == 2;
  }
  EXPECT_GT (right, 0.9 * static_cast<double> (label_indices[0].indices.size ()));
}

TEST (MotionSegmentation, WrongInput)
{
  const MovingTable table (resting);
  const MotionFrame good = table.at (0).frame;
  MovingBodyFinder finder;
  EXPECT_TRUE (finder.segment ().labels.empty ());
  const auto refused = [&] (const auto& change) {
    MotionFrame frame = good;
    change (frame);
    EXPECT_THROW (finder.add (frame), InvalidArgument);
  };
  finder.add (good);
  refused ([] (MotionFrame& frame) { frame.points.pop_back (); });
  refused ([] (MotionFrame& frame) { frame.camera.fx = 0.0; });
  refused ([] (MotionFrame& frame) {
    frame.points.assign (frame.points.size (), Eigen::Vector3f::Constant (not_a_number));
  });
  refused ([] (MotionFrame& frame) { frame.bodies.assign (3, 0); });
  refused ([] (MotionFrame& frame) { frame.expected_depth.assign (3, 0.0f); });
  refused ([] (MotionFrame& frame) { frame.T_world_sensor.translation ().x () = not_a_number; });
  refused ([] (MotionFrame& frame) { frame.T_world_sensor.linear () *= 2.0; });
  refused ([] (MotionFrame& frame) { frame.T_world_body[1].translation ().x () = not_a_number; });
  refused ([] (MotionFrame& frame) { // of another size than the first
    frame.camera.width = 160;
    frame.camera.height = 480;
  });
  EXPECT_EQ (finder.segment ().labels.size (), good.points.size ());
  MotionSegmentationOptions options;
  options.window = 0;
  EXPECT_THROW (MovingBodyFinder{options}, InvalidArgument);

  MotionSegmentation<pcl::PointXYZ> segmentation;
  pcl::PointCloud<pcl::Label> labels;
  std::vector<pcl::PointIndices> label_indices;
  EXPECT_FALSE (segmentation.setOptions (options));
  const auto leftOut = [&] {
    segmentation.segment (labels, label_indices);
    return labels.empty () && label_indices.empty ();
  };
  EXPECT_TRUE (leftOut ());
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>> ();
  cloud->resize (100);
  segmentation.setInputCloud (cloud);
  EXPECT_TRUE (leftOut ());
  *cloud = pcl::PointCloud<pcl::PointXYZ> (320, 240, pcl::PointXYZ (not_a_number, not_a_number, not_a_number));
  EXPECT_TRUE (leftOut ());
}
