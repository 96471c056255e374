// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "common/message_of.h"
#include "common/small_meshes.h"
#include "common/temporary_folder.h"

#include "pcl_cosection/rendering/picture.h"
#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

using namespace pcl::cosection;

namespace {

using Colour = std::array<std::uint8_t, 3>;

Picture
gradient (int width, int height)
{
  Picture picture;
  picture.width = width;
  picture.height = height;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      picture.pixels.push_back ({static_cast<std::uint8_t> (u), static_cast<std::uint8_t> (v), 77});
  return picture;
}

} // namespace

TEST (Picture, PngKeepsEveryPixelTheRightWayUp)
{
  const test::TemporaryFolder folder;
  const auto picture = gradient (31, 17);
  writePng (picture, folder.file ("a.png"));
  vtkNew<vtkPNGReader> reader;
  reader->SetFileName (folder.file ("a.png").c_str ());
  reader->Update ();
  vtkImageData* image = reader->GetOutput ();
  ASSERT_EQ (image->GetDimensions ()[0], 31);
  ASSERT_EQ (image->GetDimensions ()[1], 17);
  for (int v = 0; v < 17; ++v)
    for (int u = 0; u < 31; ++u)
      for (int channel = 0; channel < 3; ++channel)
        EXPECT_EQ (image->GetScalarComponentAsDouble (u, 16 - v, 0, channel), picture.pixels[v * 31 + u][channel]);
}

TEST (Picture, PngErrorsNameTheFile)
{
  const test::TemporaryFolder folder;
  const auto path = folder.file ("no/a.png");
  EXPECT_EQ (test::messageOf<IoError> ([&] { writePng (gradient (2, 2), path); }),
             "cannot write '" + path + "': No such file or directory");
  EXPECT_THROW (writePng (Picture (), folder.file ("a.png")), InvalidArgument);
  EXPECT_EQ (folder.entries (), 0u);
}

TEST (Picture, BesideKeepsPicturesApart)
{
  const auto both = beside ({gradient (5, 4), gradient (3, 4)}, 2);
  ASSERT_EQ (both.width, 10);
  ASSERT_EQ (both.height, 4);
  for (int v = 0; v < 4; ++v)
  {
    EXPECT_EQ (both.pixels[v * 10 + 4], (Colour{4, static_cast<std::uint8_t> (v), 77}));
    EXPECT_EQ (both.pixels[v * 10 + 5], (Colour{255, 255, 255}));
    EXPECT_EQ (both.pixels[v * 10 + 7], (Colour{0, static_cast<std::uint8_t> (v), 77}));
  }
  EXPECT_THROW (beside ({gradient (5, 4), gradient (3, 5)}), InvalidArgument);
  EXPECT_EQ (beside ({}).width, 0);
}

TEST (Picture, ShadingIsBrightestWhereTheSurfaceFacesTheCamera)
{
  PinholeCamera camera;
  camera.width = camera.height = 81;
  camera.fx = camera.fy = 100.0;
  camera.cx = camera.cy = 40.0;
  Rasterizer rasterizer (camera, Eigen::Isometry3d::Identity ());
  rasterizer.draw (test::sphereMesh (0.3, 40), 0, Eigen::Isometry3d (Eigen::Translation3d (0, 0, 1)), {200, 100, 0});
  const auto picture = shade (rasterizer.image (), camera, {1, 2, 3});
  EXPECT_EQ (picture.pixels[0], (Colour{1, 2, 3}));
  const auto centre = picture.pixels[40 * 81 + 40];
  EXPECT_NEAR (centre[0], 200, 1);
  EXPECT_NEAR (centre[1], 100, 1);
  EXPECT_EQ (centre[2], 0);
  EXPECT_LT (picture.pixels[40 * 81 + 65][0], 190);
  EXPECT_GT (picture.pixels[40 * 81 + 65][0], 40);
  camera.width = 80;
  EXPECT_THROW (shade (rasterizer.image (), camera), InvalidArgument);
}

TEST (Picture, ProvenanceHasFourColours)
{
  auto mesh = test::boxMesh ({0, 0, 0}, {1, 1, 1});
  mesh.provenance = {0, 1, 2, 3, 0, 1, 2, 3};
  const auto colours = provenanceColours (mesh);
  ASSERT_EQ (colours.size (), 8u);
  for (int a = 0; a < 4; ++a)
  {
    EXPECT_EQ (colours[a], colours[a + 4]);
    for (int b = 0; b < a; ++b)
      EXPECT_NE (colours[a], colours[b]);
  }
}
