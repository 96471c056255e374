// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Points in PLY files, fields as other programs name them, labels that are numbered in other ways, other axes.

#include "pcd_view_fixture.h"

#include "pcl_cosection/io/cloud/surface_file.h"

#include <pcl/cosection/common/error.h>

#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <algorithm>
#include <cstring>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

const std::string ply_of_three = "ply\nformat ascii 1.0\ncomment as a scanner writes it\nelement vertex 3\n"
                                 "property double x\nproperty double y\nproperty double z\n"
                                 "property float nx\nproperty float ny\nproperty float nz\n"
                                 "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                                 "property float scalar_Label\nend_header\n"
                                 "0.1 0 1 0 0 -2 255 128 0 3\n0.2 0 1 0 0 -2 255 128 0 3\n0 0.1 1 0 0 -2 255 128 0 3\n";

bool
warns (const LabelledView& view, const std::string& of)
{
  return std::any_of (view.warnings.begin (), view.warnings.end (),
                      [&] (const std::string& warning) { return warning.find (of) != std::string::npos; });
}

template <typename T>
void
append (std::string& bytes, T value, bool big_endian)
{
  char raw[sizeof (T)];
  std::memcpy (raw, &value, sizeof (T));
  if (big_endian)
    std::reverse (raw, raw + sizeof (T));
  bytes.append (raw, sizeof (T));
}

} // namespace

using CloudFile = PcdView;

TEST_F (CloudFile, PlyHasNormalsColoursAndLabels)
{
  const LabelledView view = readPcdView (write (ply_of_three, "scan.ply"));
  ASSERT_EQ (view.objects.count (3), 1u);
  ASSERT_EQ (view.objects.at (3).points.size (), 3u);
  EXPECT_TRUE (warns (view, "scalar_Label is taken for it"));
  const OrientedPoint& point = view.objects.at (3).points[0];
  EXPECT_TRUE (point.position.isApprox (Eigen::Vector3f (0.1f, 0.0f, 1.0f)));
  EXPECT_TRUE (point.normal.isApprox (Eigen::Vector3f (0.0f, 0.0f, -1.0f)));
  EXPECT_EQ (point.colour, (std::array<std::uint8_t, 3>{255, 128, 0}));
}

TEST_F (CloudFile, PlyOfEitherByteOrder)
{
  for (const bool big_endian : {false, true})
  {
    std::string bytes = std::string ("ply\nformat binary_") + (big_endian ? "big" : "little") +
                        "_endian 1.0\nelement other 1\nproperty list uchar short things\nelement vertex 2\n"
                        "property float x\nproperty list uchar int skipped\nproperty float y\nproperty double z\n"
                        "property ushort label\nend_header\n";
    append<std::uint8_t> (bytes, 2, big_endian);
    append<std::int16_t> (bytes, 5, big_endian);
    append<std::int16_t> (bytes, 6, big_endian);
    for (const float x : {0.25f, 0.5f})
    {
      append (bytes, x, big_endian);
      append<std::uint8_t> (bytes, 1, big_endian);
      append<std::int32_t> (bytes, 7, big_endian);
      append (bytes, 2.0f * x, big_endian);
      append (bytes, 1.5, big_endian);
      append<std::uint16_t> (bytes, 40000, big_endian);
    }
    const SurfaceFile scan = loadSurface (write (bytes, "scan.ply"));
    ASSERT_EQ (scan.mesh.vertices.size (), 2u) << big_endian;
    EXPECT_EQ (scan.mesh.vertices[1], Eigen::Vector3f (0.5f, 1.0f, 1.5f));
    EXPECT_EQ (readPcdView (path ("scan.ply")).objects.at (40000).readings, 2u);
  }
}

TEST_F (CloudFile, PlyOfPclHasItsCameraAndItsOrganisation)
{
  pcl::PointCloud<pcl::PointXYZRGBL> cloud = organizedStep ();
  cloud.sensor_origin_ = Eigen::Vector4f (1.0f, 2.0f, 3.0f, 0.0f);
  cloud.sensor_orientation_ = Eigen::Quaternionf (Eigen::AngleAxisf (0.5f, Eigen::Vector3f (1, 2, 3).normalized ()));
  pcl::io::savePCDFileBinary (path ("view.pcd"), cloud);
  for (const bool binary : {false, true})
  {
    pcl::PLYWriter ().write (path ("view.ply"), cloud, binary, true);
    const LabelledView expected = readPcdView (path ("view.pcd")), view = readPcdView (path ("view.ply"));
    EXPECT_TRUE (view.organized);
    ASSERT_TRUE (view.view && expected.view);
    EXPECT_TRUE (view.view->T_world_sensor.isApprox (expected.view->T_world_sensor, 1e-4));
    EXPECT_EQ (view.view->depth.size (), expected.view->depth.size ());
    ASSERT_EQ (view.objects.size (), expected.objects.size ());
    EXPECT_EQ (view.objects.at (7).points.size (), expected.objects.at (7).points.size ());
    EXPECT_EQ (view.objects.at (7).points[0].colour, (std::array<std::uint8_t, 3>{10, 20, 30}));
  }
}

TEST_F (CloudFile, CameraThatCannotBeIsNotUsed)
{
  std::string file = ply_of_three;
  file.insert (file.find ("end_header"),
               "element camera 1\nproperty float view_px\nproperty float view_py\n"
               "property float view_pz\nproperty float viewportx\nproperty float viewporty\n");
  const LabelledView view = readPcdView (write (file + "1e30 0 0 1.5 2\n", "scan.ply"));
  EXPECT_FALSE (view.organized);
  EXPECT_EQ (view.objects.at (3).readings, 3u);
}

TEST_F (CloudFile, MeshIsTakenAsItsVertices)
{
  std::string mesh = ply_of_three;
  mesh.insert (mesh.find ("end_header"), "element face 1\nproperty list uchar int vertex_indices\n");
  const LabelledView view = readPcdView (write (mesh + "3 0 1 2\n", "mesh.ply"));
  EXPECT_EQ (view.objects.at (3).readings, 3u);
  EXPECT_TRUE (warns (view, "its faces are not used"));
}

TEST_F (CloudFile, BadPlyIsRefusedInOneLine)
{
  const auto expect = [&] (const std::string& content, const std::string& reason) {
    EXPECT_NE (failure<Error> (write (content, "bad.ply")).find (reason), std::string::npos) << reason;
  };
  const std::string head = "ply\nformat ascii 1.0\n";
  expect ("plyer\n", "is neither a PCD nor a PLY file");
  expect ("ply\n", "header does not end");
  expect (head + "element face 0\nend_header\n", "has no vertices");
  expect (head + "element vertex 0\nproperty float x\nend_header\n", "holds no points");
  expect (head + "element vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n", "no field z");
  expect (head + "element vertex 900000000\nproperty float x\nend_header\n1\n", "shorter than its header says");
  expect (ply_of_three.substr (0, ply_of_three.size () - 10), "shorter than its header says");
  std::string word = ply_of_three;
  expect (word.replace (word.rfind ("0.1"), 3, "abc"), "is not a number");
}

TEST_F (CloudFile, ColoursMayBeInThreeFields)
{
  const std::string rows = "0 0 1 1 0.5 0\n1 0 1 1 0.5 0\n0 1 1 1 0.5 0\n";
  const LabelledView view = readPcdView (
      write (header (3, 1, "ascii", "x y z r g b", "4 4 4 4 4 4", "F F F F F F") + rows));
  ASSERT_TRUE (view.has_colour);
  EXPECT_EQ (view.objects.at (1).points[0].colour, (std::array<std::uint8_t, 3>{255, 127, 0}));
}

TEST_F (CloudFile, ColoursMayBeWholeNumbers)
{
  const auto firstColour = [&] (const std::string& colour) {
    const std::string rows = "0 0 1 " + colour + "\n1 0 1 " + colour + "\n0 1 1 " + colour + "\n";
    return readPcdView (write (header (3, 1, "ascii", "x y z rgb", "4 4 4 4", "F F F F") + rows))
        .objects.at (1)
        .points[0]
        .colour;
  };
  EXPECT_EQ (firstColour ("660510"), (std::array<std::uint8_t, 3>{10, 20, 30}));         // 0x0a141e
  EXPECT_EQ (firstColour ("9.25571652e-40"), (std::array<std::uint8_t, 3>{10, 20, 30})); // the same bits
}

TEST_F (CloudFile, NamesOfFieldsMayDiffer)
{
  const std::string rows = "0 0 1 0 0 -1 4\n1 0 1 0 0 -1 4\n0 1 1 0 0 -1 4\n";
  const LabelledView view = readPcdView (write (
      header (3, 1, "ascii", "X Y Z NormalX NormalY NormalZ Classification", "4 4 4 4 4 4 4", "F F F F F F F") + rows));
  ASSERT_EQ (view.objects.count (4), 1u);
  EXPECT_EQ (view.objects.at (4).points.size (), 3u); // with the normals that were given
}

TEST_F (CloudFile, OtherLabelsMayBeTheBackground)
{
  std::string rows;
  for (const int label : {0, 0, 1, 255, 7, 7, 7})
    rows += std::to_string (rows.size ()) + " 0.5 1 " + std::to_string (label) + "\n";
  const std::string file = write (header (7, 1, "ascii", "x y z label", "4 4 4 4", "F F F U") + rows);
  PcdViewOptions options;
  options.background_labels = {1, 0};
  options.ignored_labels = {255};
  LabelledView view = readPcdView (file, options);
  EXPECT_EQ (view.objects.at (0).readings, 3u);
  EXPECT_EQ (view.objects.at (7).readings, 3u);
  EXPECT_EQ (view.objects.size (), 2u);
  EXPECT_TRUE (warns (view, "1 points of a negative label, or of one that is ignored"));

  options = {};
  options.background_labels = {255}; // objects are counted from 0
  view = readPcdView (file, options);
  EXPECT_EQ (view.objects.at (0).readings, 1u);
  EXPECT_EQ (view.objects.at (255).readings, 2u);
  EXPECT_TRUE (warns (view, "label 0 is no background; it is object 255"));

  options.background_labels = {9};
  EXPECT_TRUE (warns (readPcdView (file, options), "no point has the label of the background"));
  EXPECT_TRUE (
      warns (readPcdView (write (header (3, 1) + "0 0 1\n1 0 1\n0 1 1\n"), options), "no label is background"));
}

TEST_F (CloudFile, AxesMayBeThoseOfOpenGl)
{
  pcl::PointCloud<pcl::PointXYZRGBL> cloud = organizedStep ();
  pcl::io::savePCDFileBinary (path ("optical.pcd"), cloud);
  for (pcl::PointXYZRGBL& p : cloud)
  {
    p.y = -p.y;
    p.z = -p.z;
  }
  pcl::io::savePCDFileBinary (path ("opengl.pcd"), cloud);
  PcdViewOptions options;
  options.axes = SensorAxes::OpenGl;
  const LabelledView expected = readPcdView (path ("optical.pcd")), view = readPcdView (path ("opengl.pcd"), options);
  ASSERT_TRUE (view.view && expected.view);
  EXPECT_EQ (view.warnings, std::vector<std::string> ());
  EXPECT_EQ (view.view->camera.fx, expected.view->camera.fx);
  const OrientedPoint &a = expected.objects.at (7).points[0], &b = view.objects.at (7).points[0];
  const Eigen::Vector3f turn (1.0f, -1.0f, -1.0f); // the mesh is in the frame of the file
  EXPECT_TRUE (b.position.isApprox (turn.cwiseProduct (a.position), 1e-5f));
  EXPECT_TRUE (b.normal.isApprox (turn.cwiseProduct (a.normal), 1e-4f));
}
