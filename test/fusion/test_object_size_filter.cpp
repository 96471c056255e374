// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Something as large as a stool is seen over its corner, where it is too long for an object, and from its front.

#include <pcl/cosection/fusion/frame_segmenter.h>
#include <pcl/cosection/simulation/scene_renderer.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace pcl::cosection;

namespace {

const char* const stool =
    R"({"frames": 2, "camera": {"width": 320, "height": 240, "fx": 262, "fy": 262, "cx": 159.5, "cy": 119.5, "keys": [
    {"time": 0, "position": [-1.2, -1.1, 1.1], "look_at": [0, 0, 0.2]}, {"time": 1, "position": [0, -1.7, 0.7],
      "look_at": [0, 0, 0.2]}]},
  "background": {"parts": [{"type": "plane", "extent": 12, "position": [0, 0, 0]}]},
  "objects": [{"name": "stool", "id": 1, "shape": {"type": "box", "size": [0.42, 0.3, 0.36]},
    "keys": [{"position": [0, 0, 0.18]}]},
    {"name": "ball", "id": 2, "shape": {"type": "sphere", "radius": 0.08}, "keys": [{"position": [0.4, -0.3,
      0.08]}]}]})";

/** \brief Views of the stool, and which things a segmenter finds in them. */
class Views
{
public:
  /** \brief Whether most of a thing is labelled. */
  bool finds (GeometricSegmenter& segmenter, bool from_the_front, int id)
  {
    const double time = from_the_front ? 1.0 : 0.0;
    const SimulatedFrame view = SceneRenderer (scene_).render (time);
    RgbdFrame images;
    images.depth = measureDepth (view.depth, view.normals, scene_.camera, DepthNoise (), 1, 0);
    std::vector<Eigen::Vector3f> points;
    for (int v = 0; v < scene_.camera.height; ++v)
      for (int u = 0; u < scene_.camera.width; ++u)
      {
        const float z = images.depth.at (u, v);
        points.push_back (std::isfinite (z) ? Eigen::Vector3f (scene_.camera.unproject (u, v, z).cast<float> ())
                                            : Eigen::Vector3f::Constant (std::numeric_limits<float>::quiet_NaN ()));
      }
    const Eigen::Isometry3d T_world_camera = scene_.camera_motion.at (time);
    const Image<std::uint16_t> labels (scene_.camera.width, scene_.camera.height, 0);
    const Image<std::uint8_t> moving (scene_.camera.width, scene_.camera.height, 0);
    const FrameInstances found = segmenter.segment (
        {images, scene_.camera, points, T_world_camera, {}, labels, moving});
    std::size_t pixels = 0, labelled = 0;
    for (std::size_t n = 0; found.mask && n < points.size (); ++n)
      if (view.mask.pixels[n] == id)
      {
        ++pixels;
        labelled += found.mask->pixels[n] != 0;
      }
    return 2 * labelled > pixels;
  }

private:
  SimulatedScene scene_ = parseSceneSpec (stool, "stool");
};

} // namespace

TEST (ObjectSizeFilter, WhatWasTooLongIsNoObjectFromItsFront)
{
  Views views;
  GeometricSegmenter segmenter;
  for (int n = 0; n < 3; ++n)
  {
    EXPECT_FALSE (views.finds (segmenter, false, 1)) << n;
    EXPECT_TRUE (views.finds (segmenter, false, 2)) << n;
  }
  for (int n = 0; n < 3; ++n)
  {
    EXPECT_FALSE (views.finds (segmenter, true, 1)) << n;
    EXPECT_TRUE (views.finds (segmenter, true, 2)) << n;
  }
  EXPECT_TRUE (views.finds (segmenter, true, 1)); // most frames say so now
}

TEST (ObjectSizeFilter, ASequenceBeginsWithout)
{
  Views views;
  GeometricSegmenter segmenter;
  for (int n = 0; n < 3; ++n)
    EXPECT_FALSE (views.finds (segmenter, false, 1));
  EXPECT_FALSE (views.finds (segmenter, true, 1));
  segmenter.begin ();
  EXPECT_TRUE (views.finds (segmenter, true, 1));
}
