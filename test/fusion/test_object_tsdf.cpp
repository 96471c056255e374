// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The TSDF volume of an object finds its place, grows, and shows what was seen.

#include "completion/analytic_scene.h"

#include "pcl_cosection/fusion/mapping/object_tsdf.h"
#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr double radius_m = 0.1;

/** \brief A ball seen from two sides. */
class ObjectTsdfTest : public testing::Test
{
protected:
  ObjectTsdfTest ()
  {
    scene_.add (1, sphere (radius_m));
    for (const double x : {-0.6, 0.6})
      views_.push_back (scene_.render (camera_, lookAt ({x, -0.2, 0.1}, Eigen::Vector3d::Zero ())));
  }

  std::vector<OrientedPoint> pointsOf (int view) const { return views_.at (view).points.at (1); }

  void integrate (int view, ObjectTsdf& tsdf) const
  {
    Image<float> depth (camera_.width, camera_.height);
    depth.pixels = views_.at (view).view.depth;
    Image<std::uint16_t> mask (camera_.width, camera_.height);
    for (std::size_t n = 0; n < mask.pixels.size (); ++n)
      mask.pixels[n] = views_.at (view).labels[n] == 1 ? 1 : 0;
    TsdfPixels pixels;
    pixels.labels = &mask;
    pixels.label = 1;
    tsdf.integrate (depth, camera_, views_.at (view).view.T_world_sensor, pixels);
  }

  /** \brief The mesh's extent along x, and a check that it lies on the ball. */
  static Eigen::Vector2d extent (const ObjectTsdf& tsdf)
  {
    const TriangleMesh mesh = tsdf.volume ()->surfaceMesh ();
    EXPECT_GT (mesh.vertices.size (), 100u);
    double low = 1.0, high = -1.0;
    for (const Eigen::Vector3f& vertex : mesh.vertices)
    {
      EXPECT_NEAR (vertex.norm (), radius_m, 2.0 * tsdf.volume ()->grid ().voxel_size_m);
      low = std::min (low, static_cast<double> (vertex.x ()));
      high = std::max (high, static_cast<double> (vertex.x ()));
    }
    return {low, high};
  }

  const PinholeCamera camera_{160, 120, 250.0, 250.0, 79.5, 59.5};
  AnalyticScene scene_;
  std::vector<RenderedView> views_;
};

} // namespace

TEST_F (ObjectTsdfTest, ThereIsNothingUntilThereIsRoom)
{
  ObjectTsdf tsdf;
  integrate (0, tsdf);
  EXPECT_FALSE (tsdf.volume ());
  tsdf.makeRoom ({});
  const std::vector<OrientedPoint> points = pointsOf (0);
  tsdf.makeRoom ({points.begin (), points.begin () + 19});
  EXPECT_FALSE (tsdf.volume ());
  tsdf.makeRoom (std::vector<OrientedPoint> (1000, points.front ())); // all at one place
  EXPECT_FALSE (tsdf.volume ());
}

TEST_F (ObjectTsdfTest, TwoSidesAreOnTheBall)
{
  ObjectTsdf tsdf;
  for (const int view : {0, 1})
  {
    tsdf.makeRoom (pointsOf (view));
    integrate (view, tsdf);
  }
  const Eigen::Vector2d x = extent (tsdf);
  EXPECT_LT (x[0], -0.95 * radius_m);
  EXPECT_GT (x[1], 0.95 * radius_m);
}

TEST_F (ObjectTsdfTest, AVolumeGrowsAndKeepsWhatItHas)
{
  ObjectTsdf tsdf;
  tsdf.makeRoom (pointsOf (0));
  integrate (0, tsdf);
  const VoxelGrid before = tsdf.volume ()->grid ();
  const TriangleMesh mesh = tsdf.volume ()->surfaceMesh ();
  std::vector<OrientedPoint> far = pointsOf (1);
  for (OrientedPoint& point : far)
    point.position.x () += 0.15f;
  tsdf.makeRoom (far);
  const VoxelGrid after = tsdf.volume ()->grid ();
  EXPECT_EQ (after.voxel_size_m, before.voxel_size_m);
  EXPECT_GT (after.dims.x (), before.dims.x ());
  const TriangleMesh again = tsdf.volume ()->surfaceMesh ();
  ASSERT_EQ (again.vertices.size (), mesh.vertices.size ());
  double sum = 0.0;
  for (const TriangleMesh* m : {&mesh, &again})
    for (const Eigen::Vector3f& vertex : m->vertices)
      sum += (m == &mesh ? 1.0 : -1.0) * vertex.cast<double> ().sum ();
  EXPECT_NEAR (sum / static_cast<double> (mesh.vertices.size ()), 0.0, 1e-6);
}

/** \brief At first a sliver, as of what comes into the image: its voxels would be so small that the whole does not fit.
 */
TEST_F (ObjectTsdfTest, ASliverDoesNotDecideForTheWhole)
{
  ObjectTsdf tsdf;
  std::vector<OrientedPoint> part = pointsOf (0);
  const Eigen::Vector3f place = part[part.size () / 2].position;
  std::sort (part.begin (), part.end (), [&] (const OrientedPoint& a, const OrientedPoint& b) {
    return (a.position - place).squaredNorm () < (b.position - place).squaredNorm ();
  });
  part.resize (25);
  tsdf.makeRoom (part);
  ASSERT_TRUE (tsdf.volume ());
  const double first_voxel_m = tsdf.volume ()->grid ().voxel_size_m;
  tsdf.makeRoom (pointsOf (0));
  integrate (0, tsdf);
  tsdf.makeRoom (pointsOf (1));
  integrate (1, tsdf);
  EXPECT_GT (tsdf.volume ()->grid ().voxel_size_m, 2.0 * first_voxel_m);
  const Eigen::Vector2d x = extent (tsdf);
  EXPECT_LT (x[0], -0.95 * radius_m);
  EXPECT_GT (x[1], 0.95 * radius_m);
}

TEST_F (ObjectTsdfTest, OutlierPointsDoNotTakeTheRoom)
{
  ObjectTsdfOptions options;
  options.max_resolution = 128;
  ObjectTsdf tsdf (options), first (options);
  tsdf.makeRoom (pointsOf (0));
  const double voxel_m = tsdf.volume ()->grid ().voxel_size_m;
  std::vector<OrientedPoint> points = pointsOf (0);
  const std::size_t outlier = points.size () / 20; // of the wall behind it
  for (std::size_t n = 0; n < outlier; ++n)
    points[n].position.y () = 5.0f;
  tsdf.makeRoom (points);
  EXPECT_EQ (tsdf.volume ()->grid ().voxel_size_m, voxel_m);
  EXPECT_LE (tsdf.volume ()->grid ().dims.maxCoeff (), 128);
  integrate (0, tsdf);
  extent (tsdf);
  // Fewer than one in a hundred do not count at all.
  points = pointsOf (0);
  for (std::size_t n = 0; n < points.size () / 200; ++n)
    points[n].position.setConstant (5.0f);
  first.makeRoom (points);
  EXPECT_NEAR (first.volume ()->grid ().voxel_size_m, voxel_m, 0.1 * voxel_m);
}

TEST_F (ObjectTsdfTest, AVolumeIsNeverLargerThanAllowed)
{
  ObjectTsdfOptions options;
  options.margin = 5.0;
  options.max_resolution = 100;
  ObjectTsdf tsdf (options);
  tsdf.makeRoom (pointsOf (0));
  EXPECT_LE (tsdf.volume ()->grid ().dims.maxCoeff (), 100);
  integrate (0, tsdf);
  extent (tsdf); // the ball is in its middle
}

TEST_F (ObjectTsdfTest, WrongOptionsAreRefused)
{
  for (void (*spoil) (ObjectTsdfOptions&) :
       {+[] (ObjectTsdfOptions& o) { o.resolution = 7; }, +[] (ObjectTsdfOptions& o) { o.margin = -0.1; },
        +[] (ObjectTsdfOptions& o) { o.margin = std::nan (""); }, +[] (ObjectTsdfOptions& o) { o.max_resolution = 63; },
        +[] (ObjectTsdfOptions& o) { o.tsdf.truncation_vox = 0.0; }})
  {
    ObjectTsdfOptions options;
    spoil (options);
    EXPECT_THROW (ObjectTsdf tsdf (options), InvalidArgument);
  }
}
