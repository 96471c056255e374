// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion/scenes/completion_scene.h"

#include <pcl/cosection/surface/normals.h>
#include <pcl/cosection/volume/iso_surface.h>

#include <gtest/gtest.h>

#include <random>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

struct Oriented
{
  std::vector<Eigen::Vector3f> points, normals;

  std::vector<Eigen::Vector3f> flipped () const
  {
    std::vector<Eigen::Vector3f> all (normals);
    for (Eigen::Vector3f& n : all)
      n = -n;
    return all;
  }

  /** \brief The normals with random signs. */
  std::vector<Eigen::Vector3f> shuffled () const
  {
    std::mt19937 random (7);
    std::vector<Eigen::Vector3f> all (normals);
    for (Eigen::Vector3f& n : all)
      n *= random () % 2 ? 1.0f : -1.0f;
    return all;
  }

  double agreement (const std::vector<Eigen::Vector3f>& others) const
  {
    std::size_t same = 0;
    for (std::size_t n = 0; n < normals.size (); ++n)
      same += normals[n].dot (others[n]) > 0.0f;
    return static_cast<double> (same) / static_cast<double> (normals.size ());
  }
};

Oriented
wholeSurface (Shape shape)
{
  const TriangleMesh mesh = extractIsoSurface (sampleField (onTable (shape), 0.15, 0.005));
  return {mesh.vertices, mesh.normals};
}

Oriented
seenPart (Shape shape)
{
  Oriented part;
  const RenderedView seen = tableScene (shape).render (tableCamera (), fromAbove ());
  for (const OrientedPoint& p : seen.points.at (1))
  {
    part.points.push_back (p.position);
    part.normals.push_back (p.normal);
  }
  return part;
}

class NormalOrientation : public testing::TestWithParam<Shape>
{};

} // namespace

TEST_P (NormalOrientation, ShareTellsOutwardFromInward)
{
  for (const Oriented& surface : {wholeSurface (GetParam ()), seenPart (GetParam ())})
  {
    EXPECT_GT (outwardShare (surface.points, surface.normals), 0.75);
    EXPECT_NEAR (outwardShare (surface.points, surface.flipped ()),
                 1.0 - outwardShare (surface.points, surface.normals), 1e-3);
  }
}

TEST_P (NormalOrientation, NeighboursAgreeAndFaceOutward)
{
  for (const Oriented& surface : {wholeSurface (GetParam ()), seenPart (GetParam ())})
  {
    std::vector<Eigen::Vector3f> normals = surface.shuffled ();
    ASSERT_LT (surface.agreement (normals), 0.6);
    orientConsistently (surface.points, normals);
    EXPECT_GT (surface.agreement (normals), 0.99);
  }
}

INSTANTIATE_TEST_SUITE_P (Shapes, NormalOrientation,
                          testing::Values (Shape::Sphere, Shape::Box, Shape::Torus, Shape::Cup),
                          [] (const auto& info) { return nameOf (info.param); });

TEST (NormalOrientationOf, FlatPiecesDoNotTell)
{
  std::vector<Eigen::Vector3f> points, normals;
  for (int i = 0; i < 30; ++i)
    for (int j = 0; j < 30; ++j)
    {
      points.emplace_back (0.01f * i, 0.01f * j, 0.0f);
      normals.emplace_back (Eigen::Vector3f::UnitZ ());
    }
  EXPECT_NEAR (outwardShare (points, normals), 0.5, 0.1);
}

TEST (NormalOrientationOf, SeparateBodiesFaceOutwardEach)
{
  Oriented two = wholeSurface (Shape::Sphere);
  const Oriented other = wholeSurface (Shape::Box);
  for (std::size_t n = 0; n < other.points.size (); ++n)
  {
    two.points.emplace_back (other.points[n] + Eigen::Vector3f (0.5f, 0.0f, 0.0f));
    two.normals.push_back (other.normals[n]);
  }
  std::vector<Eigen::Vector3f> normals = two.shuffled ();
  orientConsistently (two.points, normals);
  EXPECT_GT (two.agreement (normals), 0.99);
}

TEST (NormalOrientationOf, UnknownNormalsStayUnknown)
{
  Oriented ball = wholeSurface (Shape::Sphere);
  std::vector<Eigen::Vector3f> normals = ball.shuffled ();
  const Eigen::Vector3f nothing = Eigen::Vector3f::Constant (std::nanf (""));
  normals[5] = normals[50] = nothing;
  orientConsistently (ball.points, normals);
  EXPECT_FALSE (normals[5].allFinite ());
  EXPECT_FALSE (normals[50].allFinite ());
  normals.assign (normals.size (), nothing);
  orientConsistently (ball.points, normals); // nothing to do
  EXPECT_EQ (outwardShare (ball.points, normals), 0.5);
  std::vector<Eigen::Vector3f> none;
  orientConsistently ({}, none);
  EXPECT_EQ (outwardShare ({}, {}), 0.5);
}
