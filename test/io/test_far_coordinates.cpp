// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Coordinates that are far from their origin: of surveys, with offsets of kilometres.

#include "pcd_view_fixture.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>

#include <cstring>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

const Eigen::Vector3d utm (512434.25, 5405590.5, 348.75);

/** \brief A binary file with points of a bumpy square of a metre, in front of a sensor that is a metre above. */
template <typename Real>
std::string
square (const Eigen::Vector3d& offset, const Eigen::Vector3d& viewpoint)
{
  constexpr int side = 60;
  std::ostringstream place;
  place.precision (15);
  place << viewpoint.x () << ' ' << viewpoint.y () << ' ' << viewpoint.z () << " 0 1 0 0"; // looks down
  const std::string size = sizeof (Real) == 8 ? "8 8 8" : "4 4 4";
  std::string bytes = header (side * side, 1, "binary", "x y z", size, "F F F", place.str ());
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
    {
      const Eigen::Vector3d p = offset +
                                Eigen::Vector3d (i / 59.0 - 0.5, j / 59.0 - 0.5, 0.02 * ((i / 10 + j / 10) % 2));
      for (int axis = 0; axis < 3; ++axis)
      {
        const auto value = static_cast<Real> (p[axis]);
        bytes.append (reinterpret_cast<const char*> (&value), sizeof (value));
      }
    }
  return bytes;
}

bool
says (const std::vector<std::string>& warnings, const std::string& text)
{
  for (const std::string& warning : warnings)
    if (warning.find (text) != std::string::npos)
      return true;
  return false;
}

} // namespace

using FarCoordinates = PcdView;

TEST_F (FarCoordinates, AreTakenRelativeToAnOrigin)
{
  const Eigen::Vector3d above (0.0, 0.0, 1.0);
  PcdViewOptions options;
  options.world_points = true;
  const LabelledView expected = readPcdView (write (square<double> ({0, 0, 0}, above), "near.pcd"), options);
  EXPECT_TRUE (expected.origin.isZero (0.0));
  for (const bool said : {true, false}) // that the points are in the world frame
  {
    options.world_points = said;
    const LabelledView view = readPcdView (write (square<double> (utm, utm + above)), options);
    EXPECT_TRUE (says (view.warnings, "far from their origin"));
    EXPECT_EQ (says (view.warnings, "taken as with --world-points"), !said);
    EXPECT_LT ((view.origin - utm).norm (), 2.0);
    ASSERT_EQ (view.view.has_value (), expected.view.has_value ());
    const auto &points = view.objects.at (1).points, &near = expected.objects.at (1).points;
    ASSERT_EQ (points.size (), near.size ());
    for (std::size_t n = 0; n < points.size (); n += 7)
    {
      const Eigen::Vector3d place = view.origin + points[n].position.cast<double> () - utm;
      EXPECT_LT ((place - near[n].position.cast<double> ()).norm (), 1e-6);
      EXPECT_GT (points[n].normal.dot (near[n].normal), 0.98f);
    }
    EXPECT_LT ((view.view->T_world_sensor.translation () + view.origin - utm - above).norm (), 1e-6);
  }
}

TEST_F (FarCoordinates, AnotherViewGetsTheOriginOfTheFirst)
{
  const std::string file = write (square<double> (utm, utm + Eigen::Vector3d::UnitZ ()));
  PcdViewOptions options;
  options.world_points = true;
  options.origin = {512000.0, 5405000.0, 300.0};
  const LabelledView view = readPcdView (file, options);
  EXPECT_EQ (view.origin, Eigen::Vector3d (512000.0, 5405000.0, 300.0));
  EXPECT_FALSE (says (view.warnings, "far"));
  options.origin = {0.0, 0.0, 0.0};
  EXPECT_TRUE (says (readPcdView (file, options).warnings, "m from the first view; its coordinates are rounded"));
}

TEST_F (FarCoordinates, PlaceOfTheSensorThatIsNotNearIsNotUsed)
{
  PcdViewOptions options;
  options.world_points = true;
  const LabelledView view = readPcdView (write (square<double> (utm, Eigen::Vector3d::UnitZ ())), options);
  EXPECT_TRUE (says (view.warnings, "where the sensor is said to have stood, which is not used"));
  EXPECT_LT ((view.origin - utm).norm (), 2.0);
  EXPECT_LT (view.objects.at (1).points[0].position.norm (), 2.0f);
}

TEST_F (FarCoordinates, WithoutAViewpointTheyAreAWorldFrame)
{
  const LabelledView view = readPcdView (write (square<double> (utm, Eigen::Vector3d::Zero ())));
  EXPECT_LT ((view.origin - utm).norm (), 2.0);
  const Eigen::Vector3d first = view.origin + view.objects.at (1).points[0].position.cast<double> () - utm;
  EXPECT_LT (first.cwiseAbs ().maxCoeff (), 0.6);
}

TEST_F (FarCoordinates, ThatTheFileHasRoundedAreRefused)
{
  const std::string message = failure<IoError> (write (square<float> (utm, utm)));
  EXPECT_NE (message.find ("are rounded to 0.6"), std::string::npos) << message;
  EXPECT_NE (message.find ("doubles"), std::string::npos) << message;
  // 16 km from the origin floats are rounded to 2 mm, an eighth of the distance between the points.
  EXPECT_TRUE (
      says (readPcdView (write (square<float> ({16000, 0, 0}, {16000, 0, 1}))).warnings, "are rounded to 0.0019"));
}

TEST_F (FarCoordinates, WhatALidarSeesFarAwayStaysInItsFrame)
{
  const LabelledView view = readPcdView (write (square<float> ({0, 0, 200}, {0, 0, 0})));
  EXPECT_FALSE (says (view.warnings, "rounded")) << view.warnings[0];
}

TEST_F (FarCoordinates, WrongOptionsAreRefused)
{
  PcdViewOptions options;
  options.origin = {0.0, std::numeric_limits<double>::infinity (), 0.0};
  EXPECT_THROW (options.validate (), InvalidArgument);
  options = {};
  options.planes = {{0.0, 0.0, 0.0, 1.0}};
  EXPECT_THROW (options.validate (), InvalidArgument);
}

TEST_F (FarCoordinates, MeshesAreWrittenInDoubles)
{
  TriangleMesh mesh;
  for (int n = 0; n < 4; ++n)
    mesh.vertices.push_back (0.001f * Eigen::Vector3f (n == 1, n == 2, n == 3));
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  for (const char* const name : {"m.ply", "m.obj"})
  {
    saveMesh (mesh, path (name), utm);
    EXPECT_THROW (loadMesh (path (name)), IoError) << "rounded to floats, a millimetre is nothing";
    const Eigen::Vector3d origin = localOrigin (path (name));
    EXPECT_LT ((origin - utm).norm (), 0.1);
    const TriangleMesh again = loadMesh (path (name), utm);
    ASSERT_EQ (again.triangles.size (), 4u);
    EXPECT_NEAR (computeMassProperties (again).volume_m3, 1e-9 / 6.0, 1e-12);
  }
  EXPECT_EQ (loadPlyMesh (path ("m.ply"), utm).vertices.size (), 4u);
  saveMesh (mesh, path ("near.ply"));
  EXPECT_TRUE (localOrigin (path ("near.ply")).isZero (0.0));
  saveMesh (mesh, path ("m.stl"), utm); // without room for it
  EXPECT_NEAR (computeMassProperties (loadMesh (path ("m.stl"))).volume_m3, 1e-9 / 6.0, 1e-12);
}
