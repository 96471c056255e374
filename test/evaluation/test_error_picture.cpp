// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "evaluation_meshes.h"

#include "pcl_cosection/evaluation/pictures/error_picture.h"
#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief How many pixels of a part of a picture are clearly red, blue. */
std::array<int, 2>
redAndBlue (const Picture& picture, int left, int top, int width, int height)
{
  std::array<int, 2> counts = {0, 0};
  for (int v = top; v < top + height; ++v)
    for (int u = left; u < left + width; ++u)
    {
      const auto& p = picture.at (u, v);
      counts[0] += p[0] > p[2] + 50 && p[0] > p[1] + 50;
      counts[1] += p[2] > p[0] + 50;
    }
  return counts;
}

} // namespace

TEST (ErrorColour, RunsFromBlueToRed)
{
  const auto low = errorColour (0.0), high = errorColour (1.0);
  EXPECT_GT (low[2], low[0]);
  EXPECT_GT (high[0], high[2]);
  EXPECT_EQ (errorColour (5.0), high);
  EXPECT_EQ (errorColour (-1.0), low);
  EXPECT_EQ (errorColour (std::numeric_limits<double>::quiet_NaN ()), high);
  EXPECT_EQ (errorColours ({0.0, 0.02}, 0.02), (std::vector<TriangleMesh::Colour>{low, high}));
  EXPECT_THROW (errorColours ({0.0}, 0.0), InvalidArgument);
}

TEST (RoundErrorUp, IsARoundNumberThatIsNotLess)
{
  EXPECT_DOUBLE_EQ (roundErrorUp (0.0), 0.001);
  EXPECT_DOUBLE_EQ (roundErrorUp (0.0011), 0.002);
  EXPECT_DOUBLE_EQ (roundErrorUp (0.002), 0.002);
  EXPECT_DOUBLE_EQ (roundErrorUp (0.0123), 0.02);
  EXPECT_DOUBLE_EQ (roundErrorUp (0.0275), 0.03);
  EXPECT_DOUBLE_EQ (roundErrorUp (0.07), 0.08);
  EXPECT_DOUBLE_EQ (roundErrorUp (0.9), 1.0);
}

TEST (ErrorPicture, ShowsWhatIsMissingOnTheTruthOnly)
{
  const TriangleMesh whole = sphereMesh (0.1, 32);
  ErrorPictureOptions options;
  options.panel_px = 128;
  const Picture picture = drawErrorPicture (whole, upperPart (whole), options);
  const int titles = picture.height / 2 - options.panel_px;
  for (int column = 0; column < 2; ++column)
  {
    const auto reconstruction = redAndBlue (picture, column * 128, titles, 128, 128);
    EXPECT_EQ (reconstruction[0], 0);
    EXPECT_GT (reconstruction[1], 1000);
    const auto truth = redAndBlue (picture, column * 128, 128 + 2 * titles, 128, 128);
    EXPECT_GT (truth[0], 500);
    EXPECT_GT (truth[1], 500);
  }
}

TEST (ErrorPicture, ColoursLargeTrianglesByPixel)
{
  // Two triangles; the reconstruction lacks the middle of the square, and has its corners.
  TriangleMesh ring = planeMesh (1.0, 8);
  std::vector<bool> keep;
  for (const auto& t : ring.triangles)
  {
    const Eigen::Vector3f centre = (ring.vertices[t[0]] + ring.vertices[t[1]] + ring.vertices[t[2]]) / 3.0f;
    keep.push_back ((centre - Eigen::Vector3f (0.5f, 0.5f, 0.0f)).cwiseAbs ().maxCoeff () > 0.25f);
  }
  ErrorPictureOptions options;
  options.panel_px = 128;
  options.error_max_m = 0.1;
  const Picture picture = drawErrorPicture (planeMesh (1.0, 1), extractTriangles (ring, keep), options);
  const int titles = picture.height / 2 - options.panel_px;
  EXPECT_GT (redAndBlue (picture, 0, 128 + 2 * titles, 128, 128)[0], 100);
  EXPECT_EQ (redAndBlue (picture, 0, titles, 128, 128)[0], 0);
}

TEST (ErrorPicture, RefusesBadOptions)
{
  const TriangleMesh mesh = sphereMesh (0.1, 8);
  ErrorPictureOptions options;
  options.up = options.front;
  EXPECT_THROW (drawErrorPicture (mesh, mesh, options), InvalidArgument);
  options = {};
  options.error_max_m = 0.0;
  EXPECT_THROW (drawErrorPicture (mesh, mesh, options), InvalidArgument);
  EXPECT_THROW (drawErrorPicture (mesh, TriangleMesh ()), DegenerateInput);
}
