// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "completion/analytic_scene.h"

#include <pcl/cosection/fusion/co_section_backend.h>

#include <gtest/gtest.h>

#include <cstddef>

namespace pcl::cosection::test {

/** \brief A ball on a table, seen from places on a line: their distances are those of the views. */
class BackendTest : public testing::Test
{
protected:
  static constexpr int ball = 3;

  BackendTest ()
  {
    scene_.add (0, halfSpace (Eigen::Vector4d::UnitZ ()));
    scene_.add (ball, placed (sphere (0.05), middle));
  }

  Eigen::Isometry3d sensor (double x) const
  {
    Eigen::Isometry3d T = lookAt ({0.0, -0.4, 0.3}, middle);
    T.translation ().x () = x;
    return T;
  }

  Keyframe keyframe (double x) const
  {
    const RenderedView seen = scene_.render (camera_, sensor (x));
    Keyframe keyframe;
    keyframe.view = seen.view;
    for (const auto& [label, points] : seen.points)
      for (OrientedPoint point : points)
      {
        point.position = (sensor (x).inverse () * point.position.cast<double> ()).cast<float> ();
        point.normal = (sensor (x).linear ().transpose () * point.normal.cast<double> ()).cast<float> ();
        keyframe.points[label].push_back (point);
      }
    return keyframe;
  }

  static BackendOptions options (std::size_t views = 100, std::size_t keyframes = 40)
  {
    BackendOptions options;
    options.method.voxel_size_m = 0.006;
    options.method.whole_background = true;
    options.method.threads = 1;
    options.max_views = views;
    options.max_keyframes = keyframes;
    return options;
  }

  static const CoSectionBackend::Poses& atRest ()
  {
    static const CoSectionBackend::Poses poses = {{ball, Eigen::Isometry3d::Identity ()}};
    return poses;
  }

  static void expectSame (const SceneResult& a, const SceneResult& b)
  {
    ASSERT_EQ (a.objects.size (), b.objects.size ());
    for (std::size_t n = 0; n < a.objects.size (); ++n)
    {
      EXPECT_EQ (a.objects[n].error, "");
      ASSERT_EQ (a.objects[n].mesh.vertices.size (), b.objects[n].mesh.vertices.size ());
      for (std::size_t v = 0; v < a.objects[n].mesh.vertices.size (); ++v)
        ASSERT_EQ (a.objects[n].mesh.vertices[v], b.objects[n].mesh.vertices[v]) << v;
    }
    ASSERT_EQ (a.background.vertices.size (), b.background.vertices.size ());
    for (std::size_t v = 0; v < a.background.vertices.size (); ++v)
      ASSERT_EQ (a.background.vertices[v], b.background.vertices[v]) << v;
  }

  const Eigen::Vector3d middle{0.0, 0.0, 0.05};
  const PinholeCamera camera_{80, 60, 90.0, 90.0, 39.5, 29.5};
  AnalyticScene scene_;
};

} // namespace pcl::cosection::test
