// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Warnings of what no view shows of an object: the rest of its outline, or how far it reaches behind one flat side.

#include "completion_scene.h"

#include "volume/analytic_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

const std::string of_outline = "of its outline", of_depth = "only one side of it was seen";
const Eigen::Vector3d middle (0.0, 0.0, 0.05), straight_above (0.0, -0.001, 0.6), level (0.0, -0.5, 0.05);

/** \brief A box on the table, and maybe a wall before its left part. */
AnalyticScene
boxOnTable (bool is_hidden = false)
{
  AnalyticScene scene;
  scene.add (0, halfSpace (table_plane));
  scene.add (1, placed (box ({0.06, 0.04, 0.05}), middle));
  if (is_hidden)
    scene.add (2, placed (box ({0.04, 0.01, 0.08}), Eigen::Vector3d (-0.05, -0.12, 0.08)));
  return scene;
}

RenderedView
seenFrom (const AnalyticScene& scene, const Eigen::Vector3d& eye, const Eigen::Vector3d& target = middle)
{
  return scene.render (tableCamera (), lookAt (eye, target));
}

/** \brief Remove the readings that are that near, to the right, to one of object 2. */
RenderedView
withShadow (RenderedView seen, int width_px)
{
  const std::vector<int> labels = seen.labels;
  const int columns = seen.view.camera.width;
  for (std::size_t n = 0; n < labels.size (); ++n)
    if (labels[n] == 2)
      for (int u = static_cast<int> (n) % columns, k = 1; k <= width_px && u + k < columns; ++k)
        if (labels[n + k] != 2)
        {
          seen.view.depth[n + k] = std::numeric_limits<float>::quiet_NaN ();
          seen.labels[n + k] = -1;
        }
  seen.points.clear ();
  return seen;
}

/** \brief The points of the readings again, with the normals of the shapes. */
RenderedView
withPoints (RenderedView seen, const AnalyticScene& scene)
{
  const DepthView& view = seen.view;
  for (int v = 0; v < view.camera.height; ++v)
    for (int u = 0; u < view.camera.width; ++u)
      if (const int label = seen.labels[static_cast<std::size_t> (v) * view.camera.width + u]; label >= 0)
      {
        const Eigen::Vector3d p = view.T_world_sensor * view.camera.unproject (u, v, view.at (u, v));
        seen.points[label].push_back (
            {p.cast<float> (), gradient (scene.shape (label), p).normalized ().cast<float> ()});
      }
  return seen;
}

/** \brief Whether there is a warning of an object. */
bool
warns (const SceneResult& result, const std::string& object, const std::string& text)
{
  return std::any_of (result.warnings.begin (), result.warnings.end (), [&] (const std::string& warning) {
    return warning.find (object + ": ") == 0 && warning.find (text) != std::string::npos;
  });
}

SceneResult
completed (const RenderedView& seen)
{
  return complete (seen, optionsFor (voxel_m));
}

TEST (Guesses, TheDepthBehindTheOnlySideIsOne)
{
  const SceneResult result = completed (seenFrom (boxOnTable (), level));
  EXPECT_TRUE (warns (result, "object 1", of_depth));
  EXPECT_FALSE (warns (result, "object 1", of_outline));
}

TEST (Guesses, WhatASecondSideOrThePlaneShowsIsNone)
{
  for (const Eigen::Vector3d& eye :
       {Eigen::Vector3d (0.0, -0.45, 0.3), Eigen::Vector3d (0.35, -0.35, 0.05), straight_above})
    EXPECT_TRUE (completed (seenFrom (boxOnTable (), eye)).warnings.empty ()) << eye.transpose ();
  for (const Shape shape : {Shape::Sphere, Shape::Torus, Shape::Cup})
    EXPECT_TRUE (completed (seenFrom (tableScene (shape), level)).warnings.empty ()) << nameOf (shape);
}

/** \brief As a thing in a hand before a wall, which looks as if it stood on that. */
TEST (Guesses, TheLengthDownToAPlaneFarBelowIsOne)
{
  for (const auto& [height_m, is_guess] : {std::pair (0.05, false), std::pair (0.35, true)})
  {
    AnalyticScene scene;
    scene.add (0, halfSpace (table_plane));
    const Eigen::Isometry3d turned (Eigen::AngleAxisd (0.6, Eigen::Vector3d::UnitX ()));
    scene.add (1, placed (box ({0.06, 0.04, 0.05}), is_guess ? Eigen::Translation3d (0.0, 0.0, height_m) * turned
                                                             : Eigen::Isometry3d (Eigen::Translation3d (middle))));
    const SceneResult result = completed (seenFrom (scene, {0.0, -0.001, 0.9}));
    EXPECT_EQ (warns (result, "object 1", "down to a plane"), is_guess) << height_m;
  }
}

TEST (Guesses, WhatIsNearerHidesIsOne)
{
  const Eigen::Vector3d eye (0.0, -0.45, 0.25);
  const AnalyticScene scene = boxOnTable (true);
  const RenderedView seen = seenFrom (scene, eye);
  for (const int width_px : {0, 8, 16}) // of a shadow, as projectors make it
  {
    const SceneResult result = completed (withPoints (withShadow (seen, width_px), scene));
    EXPECT_TRUE (warns (result, "object 1", of_outline)) << width_px;
    EXPECT_FALSE (warns (result, "object 2", of_outline)) << width_px;
  }
}

TEST (Guesses, WhatAnotherViewShowsIsNone)
{
  const AnalyticScene scene = boxOnTable (true);
  const RenderedView before = seenFrom (scene, {0.0, -0.45, 0.25}), behind = seenFrom (scene, {0.3, 0.4, 0.25}),
                     aside = seenFrom (scene, {0.0, -0.45, 0.25}, {0.6, 0.0, 0.0}); // the object is not in view
  ASSERT_EQ (aside.points.count (1), 0u);
  for (const auto& [views, is_guess] :
       {std::pair (std::vector{before, behind}, false), std::pair (std::vector{before, aside}, true)})
  {
    CoSection task (optionsFor (voxel_m));
    std::vector<OrientedPoint> points, background;
    for (const RenderedView& seen : views)
    {
      task.addView (seen.view);
      if (seen.points.count (1) > 0)
        points.insert (points.end (), seen.points.at (1).begin (), seen.points.at (1).end ());
      background.insert (background.end (), seen.points.at (0).begin (), seen.points.at (0).end ());
    }
    task.setBackground (background);
    task.addObject ({1, points, {}});
    EXPECT_EQ (warns (task.reconstruct (), "object 1", of_outline), is_guess);
  }
}

} // namespace
