// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "run_folder.h"

#include "common/message_of.h"
#include "pcl_cosection/io/image_io.h"
#include "pcl_cosection/visualization/scene_legend.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/visualization/scene_picture.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief Without anything that is written over it, and from the camera. */
SceneView
plainView ()
{
  SceneView view;
  view.width = 320;
  view.height = 240;
  view.oversampling = 1;
  view.legend = view.caption = false;
  view.colour = ColourMode::Instance;
  return view;
}

/** \brief Whether a pixel has the hue of a colour, in whatever light. */
bool
hasHue (const TriangleMesh::Colour& pixel, const TriangleMesh::Colour& colour)
{
  const Eigen::Vector3d a (pixel[0], pixel[1], pixel[2]), b (colour[0], colour[1], colour[2]);
  return a.norm () > 20.0 && a.normalized ().dot (b.normalized ()) > 0.998;
}

std::size_t
countHue (const Picture& picture, const TriangleMesh::Colour& colour)
{
  return static_cast<std::size_t> (std::count_if (picture.pixels.begin (), picture.pixels.end (),
                                                  [&colour] (const auto& pixel) { return hasHue (pixel, colour); }));
}

/** \brief Pixels that the vertices of an object fall on, or what is nearer to its middle. */
std::vector<Eigen::Vector2i>
projected (const RunScene& scene, const SceneRecord::Object& object, double stamp, double share = 1.0)
{
  const Eigen::Isometry3d T_camera_object = scene.cameraAt (stamp)->inverse () * *scene.poseAt (object, stamp);
  std::vector<Eigen::Vector2i> pixels;
  for (const Eigen::Vector3f& v : object.mesh.vertices)
    pixels.push_back (
        scene.camera ().project (T_camera_object * (share * v.cast<double> ())).array ().round ().cast<int> ());
  return pixels;
}

} // namespace

TEST (ScenePicture, ObjectsAreWhereTheyWere)
{
  const RunScene scene = movingRun ();
  for (const double stamp : {0.0, 11.0})
  {
    const Picture picture = drawScene (scene, stamp, plainView ());
    ASSERT_EQ (picture.width, 320);
    for (const SceneRecord::Object& object : scene.run.objects)
    {
      std::size_t hit = 0;
      const std::vector<Eigen::Vector2i> pixels = projected (scene, object, stamp, 0.85);
      for (const Eigen::Vector2i& p : pixels)
        hit += hasHue (picture.at (p.x (), p.y ()), instanceColour (object.id));
      EXPECT_GT (static_cast<double> (hit), 0.8 * static_cast<double> (pixels.size ()))
          << object.name << ' ' << stamp; // the objects may hide each other
    }
  }
}

TEST (ScenePicture, WhatIsNotKnownIsNotShown)
{
  const RunScene scene = movingRun ();
  EXPECT_GT (countHue (drawScene (scene, 11.0, plainView ()), instanceColour (2)), 500u);
  const Picture later = drawScene (scene, 12.0, plainView ());
  EXPECT_EQ (countHue (later, instanceColour (2)), 0u);
  EXPECT_GT (countHue (later, instanceColour (1)), 500u);
  SceneView view = plainView ();
  view.objects = false;
  EXPECT_EQ (countHue (drawScene (scene, 0.0, view), instanceColour (1)), 0u);
  EXPECT_THROW (drawScene (scene, 99.0, plainView ()), InvalidArgument); // the camera is nowhere then
  view.viewpoint = overview (scene);
  EXPECT_NO_THROW (drawScene (scene, 99.0, view));
}

TEST (ScenePicture, TsdfIsWhatWasSeen)
{
  const RunScene scene = movingRun ();
  SceneView view = plainView ();
  view.viewpoint = Viewpoint{{0.3, -0.5, 0.04}, {0.3, 0.0, 0.04}, {0.0, 0.0, 1.0}, 0.7}; // the box, from the side
  view.frustum = view.path = view.background = false;
  const std::size_t whole = countHue (drawScene (scene, 0.0, view), instanceColour (2));
  view.surface = SurfaceMode::Tsdf;
  const std::size_t upper = countHue (drawScene (scene, 0.0, view), instanceColour (2));
  EXPECT_GT (whole, 1000u);
  EXPECT_LT (upper, whole / 2);
}

TEST (ScenePicture, LinesAreHiddenBySurfaces)
{
  RunScene scene = movingRun ();
  SceneView view = plainView ();
  view.viewpoint = Viewpoint{{0.0, 0.0, 4.0}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 0.9}; // from above
  view.objects = false;
  const Picture with = drawScene (scene, 20.0, view);
  view.path = view.frustum = false;
  const Picture without = drawScene (scene, 20.0, view);
  const auto differing = [] (const Picture& a, const Picture& b) {
    std::size_t count = 0;
    for (std::size_t n = 0; n < a.pixels.size (); ++n)
      count += a.pixels[n] != b.pixels[n];
    return count;
  };
  EXPECT_GT (differing (with, without), 200u);
  // A lid between the eye and the camera hides its path.
  TriangleMesh lid = planeMesh (4.0, 1, 3.0);
  for (auto& v : lid.vertices)
    v -= Eigen::Vector3f (2.0f, 2.0f, 0.0f);
  scene.run.background = lid;
  const Picture covered = drawScene (scene, 20.0, view);
  view.path = view.frustum = true;
  EXPECT_EQ (differing (drawScene (scene, 20.0, view), covered), 0u);
}

TEST (ScenePicture, OneLooksThroughTheBackOfTheBackground)
{
  const RunScene scene = movingRun ();
  SceneView view = plainView ();
  view.viewpoint = Viewpoint{{0.0, 0.01, -3.0}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 0.7}; // from below the floor
  view.path = view.frustum = false;
  EXPECT_GT (countHue (drawScene (scene, 0.0, view), instanceColour (1)), 300u);
  view.viewpoint->eye.z () = 3.0;
  view.objects = false;
  EXPECT_GT (countHue (drawScene (scene, 0.0, view), instanceColour (RunScene::background)), 10000u);
}

TEST (ScenePicture, BoxesEncloseTheObjects)
{
  const RunScene scene = movingRun ();
  SceneView view = plainView ();
  view.objects = view.background = false;
  view.boxes = true;
  const Picture picture = drawScene (scene, 0.0, view);
  for (const SceneRecord::Object& object : scene.run.objects)
  {
    Eigen::AlignedBox2i drawn, covered;
    for (int v = 0; v < picture.height; ++v)
      for (int u = 0; u < picture.width; ++u)
        if (hasHue (picture.at (u, v), instanceColour (object.id)))
          drawn.extend (Eigen::Vector2i (u, v));
    for (const Eigen::Vector2i& p : projected (scene, object, 0.0))
      covered.extend (p);
    EXPECT_TRUE ((drawn.min ().array () <= covered.min ().array () + 1).all () &&
                 (drawn.max ().array () >= covered.max ().array () - 1).all ());
  }
}

TEST (ScenePicture, ColoursTellWhatIsAskedFor)
{
  RunScene scene = movingRun ();
  TriangleMesh& mesh = scene.run.objects[0].mesh;
  mesh.provenance.assign (mesh.vertices.size (), static_cast<std::uint8_t> (Provenance::Hull));
  mesh.confidence.assign (mesh.vertices.size (), 1.0f);
  mesh.colours.assign (mesh.vertices.size (), {10, 200, 30});
  scene.errors[1].completed.assign (mesh.vertices.size (), 1.0);
  const auto colourOf = [&scene] (ColourMode mode) {
    return surfaceColours (scene, 1, SurfaceMode::Completed, mode).front ();
  };
  EXPECT_EQ (colourOf (ColourMode::Real), (TriangleMesh::Colour{10, 200, 30}));
  EXPECT_EQ (colourOf (ColourMode::Provenance), legendOf (scene, ColourMode::Provenance).entries[2].colour);
  EXPECT_EQ (colourOf (ColourMode::Confidence), (TriangleMesh::Colour{62, 112, 200}));
  EXPECT_EQ (colourOf (ColourMode::Error), (TriangleMesh::Colour{196, 30, 44})); // beyond the scale
  EXPECT_EQ (colourOf (ColourMode::Instance), instanceColour (1));
  EXPECT_NE (instanceColour (1), instanceColour (2));
  // What is not known has no colour.
  for (const ColourMode mode : {ColourMode::Real, ColourMode::Provenance, ColourMode::Confidence, ColourMode::Error})
  {
    const auto colour = surfaceColours (scene, 2, SurfaceMode::Completed, mode).front ();
    EXPECT_EQ (colour[0], colour[1]);
    EXPECT_EQ (colour[1], colour[2]);
  }
  EXPECT_TRUE (legendOf (scene, ColourMode::Error).hasScale ());
  EXPECT_TRUE (legendOf (scene, ColourMode::Confidence).hasScale ());
  EXPECT_EQ (legendOf (scene, ColourMode::Instance).entries.size (), 2u);
  scene.classes[2] = "cup";
  EXPECT_EQ (legendOf (scene, ColourMode::Instance).entries[0].text, "object " + scene.run.objects[0].name);
  EXPECT_EQ (legendOf (scene, ColourMode::Instance).entries[1].text, "object " + scene.run.objects[1].name + ", cup");
  scene.classes[2] = std::string (200, 'x');
  EXPECT_LT (legendOf (scene, ColourMode::Instance).entries[1].text.size (), 40u);
  scene.classes[2] = "123456789012345678\u6C34\u676F"; // two letters of three bytes
  EXPECT_NE (legendOf (scene, ColourMode::Instance).entries[1].text.find (", 123456789012345678..."),
             std::string::npos);
  EXPECT_TRUE (legendOf (scene, ColourMode::Real).entries.empty ());
}

TEST (ScenePicture, LegendAndCaptionAreWritten)
{
  const RunScene scene = movingRun ();
  SceneView view = plainView ();
  const Picture plain = drawScene (scene, 3.0, view);
  const auto differs = [&] (int u0, int u1, int v0, int v1) {
    const Picture other = drawScene (scene, 3.0, view);
    for (int v = v0; v < v1; ++v)
      for (int u = u0; u < u1; ++u)
        if (other.at (u, v) != plain.at (u, v))
          return true;
    return false;
  };
  view.caption = true;
  EXPECT_TRUE (differs (0, 160, 200, 240));
  EXPECT_FALSE (differs (160, 320, 0, 120));
  view.caption = false;
  view.legend = true;
  EXPECT_TRUE (differs (160, 320, 0, 120));
  EXPECT_EQ (sceneCaption (scene, 3.0, SurfaceMode::Completed, ColourMode::Instance),
             "frame 4 of 24, stamp 3, 2 objects, completed, colour: instance");
  EXPECT_EQ (sceneCaption (scene, 13.0, SurfaceMode::Tsdf, ColourMode::Real),
             "frame 14 of 24, stamp 13, 1 object, as seen");
}

TEST (ScenePicture, PointsAreThoseOfTheFrame)
{
  const TemporaryFolder folder;
  std::filesystem::create_directories (folder.file ("images/depth"));
  writeFile (folder.file ("images/calibration.txt"), "60 60 31.5 23.5 64 48\n");
  Image<float> depth (64, 48, 2.0f);
  depth.at (5, 7) = std::nanf ("");
  saveDepthImage (depth, folder.file ("images/depth/Depth0003.png"));
  RunScene scene;
  scene.dataset = folder.file ("images");
  StampedPose pose;
  pose.stamp = 3.0;
  pose.pose.translation () << 1.0, 2.0, 3.0;
  scene.run.camera = {pose};
  const FramePoints points = FramePointReader (scene).read (scene, 3.0);
  EXPECT_EQ (points.points.size (), 64u * 48u - 1u);
  EXPECT_EQ (points.colours.size (), points.points.size ());
  for (const Eigen::Vector3f& p : points.points)
    EXPECT_NEAR (p.z (), 5.0f, 1e-3f);
  EXPECT_NEAR (points.points.front ().x (), 1.0f - 2.0f * 31.5f / 60.0f, 1e-4f);
  EXPECT_TRUE (FramePointReader (scene).read (scene, 4.0).points.empty ());
  EXPECT_EQ (FramePointReader (scene).read (scene, 3.0, 4).points.size (), 16u * 12u);

  SceneView view = plainView ();
  view.surface = SurfaceMode::Points;
  const Picture picture = drawScene (scene, 3.0, view, &points);
  EXPECT_GT (std::count_if (picture.pixels.begin (), picture.pixels.end (), [] (const auto& p) { return p[0] < 220; }),
             64 * 48); // squares of two pixels

  scene.dataset = folder.file ("gone");
  EXPECT_NE (messageOf<IoError> ([&] { FramePointReader reader (scene); }).find ("name their folder with --dataset"),
             std::string::npos);
  scene.dataset.clear ();
  EXPECT_NE (messageOf<IoError> ([&] { FramePointReader reader (scene); }).find ("--dataset"), std::string::npos);
}

TEST (ScenePicture, OptionsAreChecked)
{
  const RunScene scene = movingRun ();
  for (const auto& [width, height, oversampling] :
       {std::tuple{10, 240, 1}, {320, 100000, 1}, {320, 240, 0}, {320, 240, 9}})
  {
    SceneView view = plainView ();
    view.width = width;
    view.height = height;
    view.oversampling = oversampling;
    EXPECT_THROW (drawScene (scene, 0.0, view), InvalidArgument);
  }
}
