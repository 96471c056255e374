// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Things that organised views show as bands of a few pixels.

#include "labelled_image.h"

#include "pcl_cosection/view/visibility/mean_width.h"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

class ThinThings : public LabelledImage
{
protected:
  static constexpr float focal_px = 525.0f, wall_m = 1.0f, thing_m = 0.8f;

  ThinThings () : LabelledImage (160, 120, focal_px) { set (0, 160, 0, 120, wall_m); }

  /** \brief A rectangle of pixels that shows the thing. */
  void show (int left, int right, int top, int bottom)
  {
    set (left, right, top, bottom, thing_m);
    label (left, right, top, bottom, 1);
  }

  /** \brief A square, which has reliable normals, so that all is not taken for points without an order. */
  void showBody () { show (40, 100, 80, 115); }

  /** \brief The points of the thing above the body. */
  std::vector<OrientedPoint> pointsOfBand () const
  {
    std::vector<OrientedPoint> points;
    for (const OrientedPoint& point : read ().objects.at (1).points)
      if (point.position.y () / point.position.z () < (75.0f - 59.5f) / focal_px)
        points.push_back (point);
    return points;
  }

  /** \brief The mean width of the thing, in its pixels. */
  double widthPx () const
  {
    const LabelledView view = read ();
    return meanWidth ({{&*view.view, Eigen::Isometry3d::Identity ()}}, view.objects.at (1).points) * focal_px / thing_m;
  }
};

} // namespace

TEST_F (ThinThings, FaceTheSensor)
{
  for (const int width : {2, 3, 4})
  {
    SCOPED_TRACE (width);
    set (0, 160, 0, 120, wall_m);
    label (0, 160, 0, 120, 0);
    showBody ();
    show (70, 70 + width, 20, 80);
    const std::vector<OrientedPoint> points = pointsOfBand ();
    EXPECT_GE (points.size (), 50u * static_cast<std::size_t> (width)); // of 55 rows
    for (const OrientedPoint& point : points)
      EXPECT_LT (point.normal.z (), -0.95f);
  }
}

TEST_F (ThinThings, OnASlantFaceTheSensorAcross)
{
  showBody ();
  for (int v = 20; v < 80; ++v)
  {
    set (70, 73, v, v + 1, thing_m + 0.001f * static_cast<float> (80 - v)); // 6 cm farther above than below
    label (70, 73, v, v + 1, 1);
  }
  const std::vector<OrientedPoint> points = pointsOfBand ();
  ASSERT_GE (points.size (), 150u); // of 165
  const Eigen::Vector3f along = (points.back ().position - points.front ().position).normalized ();
  for (const OrientedPoint& point : points)
  {
    EXPECT_LT (std::abs (point.normal.dot (along)), 0.1f);
    EXPECT_LT (point.normal.z (), -0.6f);
  }
}

/** \brief As a sheet that is seen along it shows its near edge beside its far one. */
TEST_F (ThinThings, BesideAnEdgeThatIsFartherFaceTheSensor)
{
  showBody ();
  show (70, 72, 20, 80);
  set (72, 75, 20, 80, thing_m + 0.1f);
  label (72, 75, 20, 80, 1);
  std::size_t near = 0;
  for (const OrientedPoint& point : pointsOfBand ())
    near += point.position.z () < thing_m + 0.05f;
  EXPECT_GE (near, 100u); // of 120
}

/** \brief Where noise is larger than pixels are apart, it would pass for a line along the rays. */
TEST_F (ThinThings, OfNoiseHaveNoNormals)
{
  constexpr float far_m = 6.0f;
  set (0, 160, 0, 120, far_m + 2.0f);
  set (40, 100, 80, 115, far_m);
  label (40, 100, 80, 115, 1);
  for (int v = 20; v < 80; ++v)
    for (int u = 70; u < 72; ++u)
      set (u, u + 1, v, v + 1, far_m + 0.001f * static_cast<float> ((v * 67 + u * 31) % 240));
  label (70, 72, 20, 80, 1);
  for (const OrientedPoint& point : pointsOfBand ())
    EXPECT_LT (point.normal.dot (point.position.normalized ()), -0.25f);
}

/** \brief At the edges of what is wide, and alone, they are at no surface. */
TEST_F (ThinThings, MixedPixelsHaveNoNormals)
{
  show (40, 90, 20, 100);
  for (int v = 20; v < 100; ++v) // as far as anything between the thing and the wall
  {
    set (90, 92, v, v + 1, thing_m + 0.02f + 0.001f * static_cast<float> ((v * 67) % 180));
    label (90, 92, v, v + 1, 1);
  }
  std::size_t mixed = 0;
  for (const OrientedPoint& point : read ().objects.at (1).points)
    mixed += point.position.z () > thing_m + 0.015f;
  EXPECT_LE (mixed, 8u); // of 160
}

TEST_F (ThinThings, HaveSmallMeanWidths)
{
  show (20, 140, 60, 64);
  EXPECT_NEAR (widthPx (), 4.0, 0.3);
}

TEST_F (ThinThings, ASquareIsHalfAsWideAsItsEdge)
{
  show (40, 100, 30, 90);
  EXPECT_NEAR (widthPx (), 30.0, 2.0);
  for (int n = 0; n < 50; ++n) // what is missing is no outline
    set (45 + n, 46 + n, 35 + n, 36 + n, std::nanf (""));
  EXPECT_NEAR (widthPx (), 30.0, 2.0);
}
