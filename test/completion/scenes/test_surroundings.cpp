// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Surroundings of objects given as planes and meshes: a table, a wall, a shelf, a bin.

#include "completion/lowest_vertex.h"
#include "surrounding_views.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/surface/hessian_imls.h>

#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief A closed box. */
TriangleMesh
block (const Eigen::Vector3f& low, const Eigen::Vector3f& high)
{
  TriangleMesh mesh;
  for (int c = 0; c < 8; ++c)
    mesh.vertices.emplace_back (c & 1 ? high.x () : low.x (), c & 2 ? high.y () : low.y (),
                                c & 4 ? high.z () : low.z ());
  const auto face = [&mesh] (std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back ({a, b, c});
    mesh.triangles.push_back ({a, c, d});
  };
  face (0, 2, 3, 1);
  face (4, 5, 7, 6);
  face (0, 1, 5, 4);
  face (2, 6, 7, 3);
  face (0, 4, 6, 2);
  face (1, 3, 7, 5);
  return mesh;
}

/** \brief One quadrilateral, a b c d counter-clockwise as seen from free space. */
TriangleMesh
sheet (const std::array<Eigen::Vector3f, 4>& corners)
{
  TriangleMesh mesh;
  mesh.vertices.assign (corners.begin (), corners.end ());
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

TriangleMesh
tableTop ()
{
  return sheet (
      {Eigen::Vector3f (-1, -1, 0), Eigen::Vector3f (1, -1, 0), Eigen::Vector3f (1, 1, 0), Eigen::Vector3f (-1, 1, 0)});
}

/** \brief The object's points and a view that shows only the object. */
struct Cropped
{
  explicit Cropped (Shape shape) : seen (tableScene (shape).render (tableCamera (), fromAbove ())), view (seen.view)
  {
    for (std::size_t i = 0; i < view.depth.size (); ++i)
      if (seen.labels[i] != 1)
        view.depth[i] = std::numeric_limits<float>::quiet_NaN ();
  }

  RenderedView seen;
  DepthView view;
};

template <typename Surround>
ObjectResult
completeAmong (const Cropped& object, Surround&& surround)
{
  CoSection task (optionsFor (voxel_m));
  task.addView (object.view);
  surround (task);
  task.addObject ({1, object.seen.points.at (1), {}});
  return task.reconstruct ().objects.at (0);
}

float
highest (const TriangleMesh& mesh, int axis)
{
  float most = -std::numeric_limits<float>::infinity ();
  for (const Eigen::Vector3f& v : mesh.vertices)
    most = std::max (most, v[axis]);
  return most;
}

bool
isSaid (const SceneResult& result, const std::string& text)
{
  return std::any_of (result.warnings.begin (), result.warnings.end (),
                      [&] (const std::string& warning) { return warning.find (text) != std::string::npos; });
}

constexpr float tolerance_m = 0.5f * static_cast<float> (voxel_m);

} // namespace

TEST (Surroundings, ATableAsAMeshKeepsObjectsAbove)
{
  const Cropped box (Shape::Box);
  const ObjectResult free = completeAmong (box, [] (CoSection&) {});
  const ObjectResult solid = completeAmong (box, [] (CoSection& task) {
    task.addObstacle (block ({-0.5f, -0.5f, -0.1f}, {0.5f, 0.5f, 0.0f}));
  });
  const ObjectResult open = completeAmong (box, [] (CoSection& task) { task.addObstacle (tableTop ()); });
  EXPECT_LT (lowest (free.mesh, 2), -tolerance_m); // without it the test would show nothing
  EXPECT_GE (lowest (solid.mesh, 2), -tolerance_m);
  EXPECT_GE (lowest (open.mesh, 2), -tolerance_m);
  EXPECT_LE (solid.penetration_m, tolerance_m);
  EXPECT_LE (meanDistance (solid.mesh, open.mesh, 0.04), 0.25 * voxel_m);
}

TEST (Surroundings, AWallBehindBoundsTheHiddenBack)
{
  const Cropped ball (Shape::Sphere);
  const double wall_y = 0.05; // the sensor looks along +y, and the ball reaches to 0.06
  const auto table = [] (CoSection& task) { task.addSupportPlane ({0.0, 0.0, 1.0, 0.0}); };
  const ObjectResult without = completeAmong (ball, [&] (CoSection& task) { table (task); });
  const ObjectResult plane = completeAmong (ball, [&] (CoSection& task) {
    table (task);
    task.addSupportPlane ({0.0, -1.0, 0.0, wall_y});
  });
  const ObjectResult mesh = completeAmong (ball, [&] (CoSection& task) {
    table (task);
    const float y = static_cast<float> (wall_y);
    task.addObstacle (sheet ({Eigen::Vector3f (-1, y, -1), Eigen::Vector3f (1, y, -1), Eigen::Vector3f (1, y, 1),
                              Eigen::Vector3f (-1, y, 1)}));
  });
  ASSERT_GT (highest (without.mesh, 1), 0.02f);
  for (const ObjectResult* object : {&plane, &mesh})
  {
    EXPECT_TRUE (computeTopology (object->mesh).closed_manifold);
    EXPECT_LE (highest (object->mesh, 1), wall_y + tolerance_m);
    EXPECT_GE (lowest (object->mesh, 2), -tolerance_m);
  }
}

TEST (Surroundings, AShelfHoldsItFromThreeSides)
{
  const Cropped box (Shape::Box); // 14 x 10 x 9 cm
  const float back = 0.05f, top = 0.09f;
  const ObjectResult object = completeAmong (box, [&] (CoSection& task) {
    task.addObstacle (block ({-0.4f, -0.2f, -0.02f}, {0.4f, 0.2f, 0.0f}));
    task.addObstacle (block ({-0.4f, -0.2f, top}, {0.4f, 0.2f, top + 0.02f}));
    task.addObstacle (block ({-0.4f, back, -0.02f}, {0.4f, back + 0.02f, top + 0.02f}));
  });
  EXPECT_TRUE (computeTopology (object.mesh).closed_manifold);
  EXPECT_GE (lowest (object.mesh, 2), -tolerance_m);
  EXPECT_LE (highest (object.mesh, 2), top + tolerance_m);
  EXPECT_LE (highest (object.mesh, 1), back + tolerance_m);
}

TEST (Surroundings, ABinIsFreeInside)
{
  const Cropped ball (Shape::Sphere);
  TriangleMesh bin = tableTop (); // an open sheet, its front inside
  const float r = 0.075f;
  for (const auto& wall : {sheet ({Eigen::Vector3f (-r, r, 0), Eigen::Vector3f (r, r, 0), Eigen::Vector3f (r, r, 0.15f),
                                   Eigen::Vector3f (-r, r, 0.15f)}),
                           sheet ({Eigen::Vector3f (r, r, 0), Eigen::Vector3f (r, -r, 0),
                                   Eigen::Vector3f (r, -r, 0.15f), Eigen::Vector3f (r, r, 0.15f)}),
                           sheet ({Eigen::Vector3f (-r, -r, 0), Eigen::Vector3f (-r, r, 0),
                                   Eigen::Vector3f (-r, r, 0.15f), Eigen::Vector3f (-r, -r, 0.15f)})})
    appendMesh (bin, wall);
  const ObjectResult object = completeAmong (ball, [&] (CoSection& task) { task.addObstacle (bin); });
  EXPECT_TRUE (computeTopology (object.mesh).closed_manifold);
  EXPECT_GE (lowest (object.mesh, 2), -tolerance_m);
  EXPECT_LE (meanError (object.mesh, onTable (Shape::Sphere)), 2.5 * voxel_m);
  for (int axis = 0; axis < 2; ++axis)
    EXPECT_LE (highest (object.mesh, axis), r + tolerance_m);
}

TEST (Surroundings, FarMeshesChangeNothing)
{
  const Cropped box (Shape::Box);
  const ObjectResult alone = completeAmong (box, [] (CoSection&) {});
  const ObjectResult far = completeAmong (box, [] (CoSection& task) {
    task.addObstacle (block ({3.0f, 3.0f, 3.0f}, {4.0f, 4.0f, 4.0f}));
  });
  EXPECT_EQ (alone.mesh.vertices, far.mesh.vertices);
}

TEST (Surroundings, PlanesThatMayBeWrongAreSaid)
{
  const Cropped ball (Shape::Sphere);
  const ObjectResult free = completeAmong (ball, [] (CoSection&) {});
  for (const double height_m : {0.0, 0.07, -20.0})
  {
    CoSection task (optionsFor (voxel_m));
    task.addView (ball.view);
    task.addSupportPlane ({0.0, 0.0, 1.0, -height_m});
    task.addObject ({1, ball.seen.points.at (1), {}});
    const SceneResult result = task.reconstruct ();
    EXPECT_EQ (isSaid (result, "behind a plane that was given"), height_m > 0.0) << height_m;
    EXPECT_EQ (isSaid (result, "are left out, as they are far from all objects"), height_m < -1.0) << height_m;
    EXPECT_EQ (result.objects.at (0).mesh.vertices == free.mesh.vertices, height_m < -1.0) << height_m;
  }
}

TEST (Surroundings, ViewsAndNormalsThatMayBeWrongAreSaid)
{
  const Cropped ball (Shape::Sphere);
  const auto complete = [&] (const Eigen::Isometry3d& moved, float turned) {
    CoSection task (optionsFor (voxel_m));
    DepthView view = ball.view;
    view.T_world_sensor = moved * view.T_world_sensor;
    std::vector<OrientedPoint> points = ball.seen.points.at (1);
    for (OrientedPoint& p : points)
      p.normal *= turned;
    task.addView (view);
    task.addObject ({1, points, {}});
    return task.reconstruct ();
  };
  const Eigen::Isometry3d elsewhere (Eigen::Translation3d (3.0, 0.0, 0.0));
  const std::string no_view = "no view sees its points", turned = "normals point away from the views";
  const SceneResult right = complete (Eigen::Isometry3d::Identity (), 1.0f);
  EXPECT_FALSE (isSaid (right, no_view) || isSaid (right, turned));
  EXPECT_TRUE (isSaid (complete (elsewhere, 1.0f), no_view));
  EXPECT_TRUE (isSaid (complete (Eigen::Isometry3d::Identity (), -1.0f), turned));
}

TEST (Surroundings, ABodyThroughTheObjectIsSaid)
{
  const Cropped box (Shape::Box);
  TriangleMesh from_below = tableTop ();
  for (TriangleMesh::Triangle& t : from_below.triangles)
    std::swap (t[0], t[1]);
  const auto is_said = [&] (const TriangleMesh& body) {
    CoSection task (optionsFor (voxel_m));
    task.addView (box.view);
    task.addObstacle (body);
    task.addObject ({1, box.seen.points.at (1), {}});
    return isSaid (task.reconstruct (), "inside a body that was given");
  };
  EXPECT_FALSE (is_said (tableTop ()));
  EXPECT_TRUE (is_said (from_below));
  EXPECT_TRUE (is_said (block ({-0.5f, -0.5f, -0.1f}, {0.5f, 0.5f, 0.05f})));
  EXPECT_FALSE (is_said (block ({-0.5f, -0.5f, -0.1f}, {0.5f, 0.5f, 0.0f})));
}

TEST (Surroundings, WhatBoundsNothingIsRefused)
{
  EXPECT_THROW (CoSection ().addObstacle (TriangleMesh ()), InvalidArgument);
  TriangleMesh broken = tableTop ();
  broken.vertices[0].x () = std::numeric_limits<float>::quiet_NaN ();
  EXPECT_THROW (CoSection ().addObstacle (broken), InvalidArgument);
  EXPECT_THROW (CoSection ().addObstacle (tableTop (), {}), InvalidArgument);
  const auto field = [] (int edge, double voxel_size_m) {
    auto field = std::make_shared<SignedDistanceField> ();
    field->grid = {Eigen::Vector3i::Constant (edge), voxel_size_m, Eigen::Vector3d::Zero ()};
    field->values.assign (field->grid.size (), 1.0f);
    return field;
  };
  EXPECT_NO_THROW (CoSection ().addObstacle (field (2, voxel_m)));
  EXPECT_THROW (CoSection ().addObstacle (field (0, voxel_m)), InvalidArgument);
  EXPECT_THROW (CoSection ().addObstacle (field (2, -voxel_m)), InvalidArgument);
  EXPECT_THROW (CoSection ().addObstacle (field (2, std::nan (""))), InvalidArgument);
}

TEST (Surroundings, HessianImlsTakesPolygonMeshes)
{
  const Cropped box (Shape::Box);
  auto points = std::make_shared<pcl::PointCloud<pcl::PointNormal>> ();
  for (const OrientedPoint& p : box.seen.points.at (1))
    points->emplace_back (p.position.x (), p.position.y (), p.position.z (), p.normal.x (), p.normal.y (),
                          p.normal.z ());
  pcl::PolygonMesh table;
  toPolygonMesh (tableTop (), table);
  table.polygons.assign (1, pcl::Vertices ());
  table.polygons[0].vertices = {0, 1, 2, 3}; // a quadrilateral, as VTK's sources make them

  HessianIMLS<pcl::PointNormal> imls;
  imls.setInputCloud (points);
  imls.setVoxelSize (voxel_m);
  imls.addView (box.view);
  pcl::PolygonMesh ignored;
  imls.reconstruct (ignored);
  EXPECT_LT (lowest (imls.getTriangleMesh (), 2), -tolerance_m);
  imls.addObstacle (table);
  imls.reconstruct (ignored);
  EXPECT_GE (lowest (imls.getTriangleMesh (), 2), -tolerance_m);
  imls.clearConstraints ();
  imls.addView (box.view);
  imls.reconstruct (ignored);
  EXPECT_LT (lowest (imls.getTriangleMesh (), 2), -tolerance_m);

  table.polygons[0].vertices = {0, 1};
  EXPECT_FALSE (imls.addObstacle (table));
  table.polygons[0].vertices = {0, 1, 9};
  EXPECT_FALSE (imls.addObstacle (table));
}
