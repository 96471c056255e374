// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "analytic_fields.h"
#include "tsdf_views.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/volume/iso_surface.h>
#include <pcl/cosection/volume/tsdf_volume.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace pcl::cosection;

namespace {

/** \brief Keep the pixels that see a surface at less than 60 degrees: the others are for the caller to leave out. */
Image<float>
frontalDepth (const Eigen::Vector3d& center, const PinholeCamera& camera, const Eigen::Isometry3d& pose,
              Image<float> depth)
{
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
    {
      const Eigen::Vector3d p = pose * camera.unproject (u, v, depth.at (u, v));
      const Eigen::Vector3d ray = (p - pose.translation ()).normalized ();
      if (!(-ray.dot ((p - center).normalized ()) > 0.5))
        depth.at (u, v) = std::numeric_limits<float>::quiet_NaN ();
    }
  return depth;
}

double
rootMeanSquare (const std::vector<double>& values)
{
  double sum = 0.0;
  for (const double value : values)
    sum += value * value;
  return std::sqrt (sum / static_cast<double> (values.size ()));
}

} // namespace

class TsdfSphere : public ::testing::TestWithParam<double>
{};

TEST_P (TsdfSphere, ComesBackWithinAFractionOfAVoxel)
{
  const double voxel_size_m = GetParam ();
  const PinholeCamera camera{320, 240, 280.0, 280.0, 159.5, 119.5};
  const Eigen::Vector3d center = Eigen::Vector3d::Zero ();
  TsdfOptions options;
  options.truncation_vox = std::min (10.0, 0.05 / voxel_size_m); // views from opposite sides do not meet
  TsdfVolume volume (test::cubeGrid (static_cast<int> (0.3 / voxel_size_m), voxel_size_m), options);
  for (const auto& pose : test::posesAround (0.5))
  {
    const auto depth = test::renderDepth (test::sphereRay (0.1), camera, pose);
    volume.integrate (frontalDepth (center, camera, pose, depth), camera, pose);
  }

  const TriangleMesh mesh = volume.surfaceMesh ();
  ASSERT_GT (mesh.vertices.size (), 500u);
  std::vector<double> errors;
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
  {
    errors.push_back (mesh.vertices[v].cast<double> ().norm () - 0.1);
    EXPECT_LT (std::abs (errors.back ()), 0.5 * voxel_size_m);
    EXPECT_GT (mesh.normals[v].dot (mesh.vertices[v].normalized ()), 0.8);
  }
  EXPECT_LT (rootMeanSquare (errors), 0.1 * voxel_size_m);
  const MeshTopology topology = computeTopology (mesh);
  EXPECT_TRUE (topology.closed_manifold);
  EXPECT_EQ (topology.components, 1);
}

INSTANTIATE_TEST_SUITE_P (VoxelSizes, TsdfSphere, ::testing::Values (0.004, 0.006, 0.01));

TEST (TsdfSurface, APlaneIsOpenAndFlat)
{
  const PinholeCamera camera = test::smallCamera ();
  const Eigen::Vector3d normal = Eigen::Vector3d (0.2, -0.3, -1.0).normalized ();
  const auto plane = test::planeRay (normal, 0.013);
  TsdfVolume volume (test::cubeGrid (40, 0.01));
  for (const Eigen::Vector3d& eye : {Eigen::Vector3d (0.0, 0.0, -0.5), Eigen::Vector3d (0.15, 0.1, -0.5),
                                     Eigen::Vector3d (-0.2, 0.05, -0.45), Eigen::Vector3d (0.05, -0.15, -0.55)})
  {
    const auto pose = test::lookAtOrigin (eye);
    volume.integrate (test::renderDepth (plane, camera, pose), camera, pose);
  }
  const TriangleMesh mesh = volume.surfaceMesh ();
  ASSERT_GT (mesh.vertices.size (), 1000u);
  std::vector<double> errors;
  for (const auto& vertex : mesh.vertices)
  {
    errors.push_back (normal.dot (vertex.cast<double> ()) - 0.013);
    EXPECT_LT (std::abs (errors.back ()), 0.3 * 0.01);
  }
  EXPECT_LT (rootMeanSquare (errors), 0.05 * 0.01);
  const MeshTopology topology = computeTopology (mesh);
  EXPECT_GT (topology.boundary_edges, 0);
  EXPECT_EQ (topology.non_manifold_edges, 0);

  EXPECT_TRUE (volume.surfaceMesh (4.5).empty ());
  const TriangleMesh sure = volume.surfaceMesh (4.0);
  EXPECT_FALSE (sure.empty ());
  EXPECT_LT (sure.vertices.size (), mesh.vertices.size ());
}

TEST (TsdfSurface, NoSurfaceWhereOneCornerHasNoWeight)
{
  const auto field = test::sampleField (test::sphere (0.1), 0.13, 0.01);
  std::vector<std::uint8_t> supported (field.values.size (), 1);
  const int hidden = field.grid.dims.x () / 2 + 10; // of the voxel at (0.1, 0, 0)
  const int middle = field.grid.dims.x () / 2;
  supported[field.grid.index (hidden, middle, middle)] = 0;
  const TriangleMesh mesh = extractOpenIsoSurface (field, supported);
  const TriangleMesh closed = extractIsoSurface (field);
  const MeshTopology topology = computeTopology (mesh);
  EXPECT_EQ (topology.components, 1); // no loose vertices
  EXPECT_EQ (topology.non_manifold_edges, 0);
  EXPECT_GT (topology.boundary_edges, 0);
  EXPECT_LT (mesh.triangles.size (), closed.triangles.size ());
  const Eigen::Vector3d hole = field.grid.center (hidden, middle, middle);
  for (const auto& t : mesh.triangles)
  {
    const Eigen::Vector3d p = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]).cast<double> () / 3.0;
    EXPECT_GT ((p - hole).cwiseAbs ().maxCoeff (), 0.0099);
  }

  supported.assign (field.values.size (), 1);
  EXPECT_EQ (extractOpenIsoSurface (field, supported).triangles, closed.triangles);
  supported.assign (field.values.size (), 0);
  EXPECT_TRUE (extractOpenIsoSurface (field, supported).vertices.empty ());
  supported.pop_back ();
  EXPECT_THROW (extractOpenIsoSurface (field, supported), InvalidArgument);
}

TEST (TsdfSurface, AnEmptyVolumeHasNone)
{
  TsdfOptions options;
  options.colour = true;
  const TsdfVolume volume (test::cubeGrid (16, 0.01), options);
  const TriangleMesh mesh = volume.surfaceMesh ();
  EXPECT_TRUE (mesh.vertices.empty ());
  EXPECT_TRUE (mesh.triangles.empty ());
}

TEST (TsdfSurface, ColoursAreThoseOfThePixelsAveraged)
{
  const PinholeCamera camera = test::smallCamera ();
  const auto pose = test::lookAtOrigin ({0.0, 0.0, -0.5});
  const auto depth = test::renderDepth (test::planeRay ({0.0, 0.0, 1.0}, 0.003), camera, pose);
  TsdfOptions options;
  options.colour = true;
  TsdfVolume volume (test::cubeGrid (32, 0.01), options);
  // Red grows with x, as far as the camera's x axis goes; green flickers; blue is constant.
  const double camera_x = pose.linear ().col (0).x ();
  const double camera_y = pose.linear ().col (1).x ();
  const auto red = [&] (double x) { return 127.5 + 500.0 * x; };
  for (int n = 0; n < 200; ++n)
  {
    Picture picture (camera.width, camera.height);
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u)
      {
        const Eigen::Vector3d p = camera.unproject (u, v, depth.at (u, v));
        const double x = camera_x * p.x () + camera_y * p.y ();
        picture.at (u, v) = {static_cast<std::uint8_t> (std::clamp (red (x) + 0.5, 0.0, 255.0)),
                             static_cast<std::uint8_t> (n % 2 == 0 ? 90 : 110), 17};
      }
    TsdfPixels pixels;
    pixels.colours = &picture;
    volume.integrate (depth, camera, pose, pixels);
  }
  const TriangleMesh mesh = volume.surfaceMesh ();
  ASSERT_FALSE (mesh.empty ());
  ASSERT_EQ (mesh.colours.size (), mesh.vertices.size ());
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
  {
    EXPECT_NEAR (mesh.colours[v][0], red (mesh.vertices[v].x ()), 4.0);
    EXPECT_NEAR (mesh.colours[v][1], 100, 1);
    EXPECT_NEAR (mesh.colours[v][2], 17, 0);
  }

  // An average moves on however old it is.
  Picture black (camera.width, camera.height, {0, 0, 0});
  TsdfPixels pixels;
  pixels.colours = &black;
  for (int n = 0; n < 600; ++n)
    volume.integrate (depth, camera, pose, pixels);
  for (const auto& colour : volume.surfaceMesh ().colours)
    EXPECT_LE (*std::max_element (colour.begin (), colour.end ()), 1);

  EXPECT_FALSE (volume.colour ({0.0, 0.0, -0.15})); // free space has none
  EXPECT_FALSE (volume.colour ({9.0, 0.0, 0.0}));
}

TEST (TsdfSurface, ColoursFromAVolumeWithoutPicturesAreGrey)
{
  const PinholeCamera camera = test::smallCamera ();
  const auto pose = test::lookAtOrigin ({0.0, 0.0, -0.5});
  TsdfOptions options;
  options.colour = true;
  TsdfVolume volume (test::cubeGrid (16, 0.01), options);
  volume.integrate (test::renderDepth (test::planeRay ({0.0, 0.0, 1.0}, 0.003), camera, pose), camera, pose);
  const TriangleMesh mesh = volume.surfaceMesh ();
  ASSERT_FALSE (mesh.empty ());
  for (const auto& colour : mesh.colours)
    EXPECT_EQ (colour, (TriangleMesh::Colour{128, 128, 128}));
}
