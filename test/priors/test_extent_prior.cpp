// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// ExtentPrior against its definition, voxel by voxel.

#include "completion/scenes/surrounding_views.h"

#include "pcl_cosection/priors/extent_prior.h"
#include "pcl_cosection/volume/distance_transform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr int cell_px = 4; // of a silhouette

using Views = std::vector<std::pair<const DepthView*, Eigen::Isometry3d>>;

enum Evidence
{
  nothing,
  occluded,
  behind,
};

/** \brief The pixel of a point in the sensor's frame; negative if it is not in the image. */
Eigen::Vector2i
pixelOf (const PinholeCamera& camera, const Eigen::Vector3d& p)
{
  if (!(p.z () > 0.0))
    return {-1, -1};
  const Eigen::Vector2d pixel = camera.project (p).array () + 0.5;
  if (pixel.minCoeff () < 0.0 || pixel.x () >= camera.width || pixel.y () >= camera.height)
    return {-1, -1};
  return pixel.cast<int> ();
}

std::vector<float>
silhouette (const DepthView& view, const Eigen::Isometry3d& T_grid_sensor, const std::vector<OrientedPoint>& points)
{
  std::vector<float> nearest (view.depth.size (), std::numeric_limits<float>::infinity ()); // by cell
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d p = T_grid_sensor.inverse () * point.position.cast<double> ();
    const Eigen::Vector2i at = pixelOf (view.camera, p);
    if (at.x () < 0)
      continue;
    float& depth = nearest[at.y () / cell_px * view.camera.width + at.x () / cell_px];
    depth = std::min (depth, static_cast<float> (p.z ()));
  }
  return nearest;
}

std::vector<float>
defined (const ExtentPrior& prior, const VoxelGrid& grid, const std::vector<float>& distance_vox,
         const std::vector<OrientedPoint>& points, const Views& views)
{
  std::vector<std::vector<float>> silhouettes;
  for (const auto& [view, T] : views)
    silhouettes.push_back (silhouette (*view, T, points));
  const Eigen::Vector3d extents = observedExtents (points) / grid.voxel_size_m;
  std::vector<float> bounds (grid.size ());
  for (int k = 0; k < grid.dims.z (); ++k)
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        const Eigen::Vector3d p = grid.center (i, j, k);
        int evidence = views.empty () ? behind : nothing;
        for (std::size_t v = 0; v < views.size (); ++v)
        {
          const DepthView& view = *views[v].first;
          const Eigen::Vector3d q = views[v].second.inverse () * p;
          const Eigen::Vector2i at = pixelOf (view.camera, q);
          if (at.x () < 0)
            continue;
          if (q.z () > silhouettes[v][at.y () / cell_px * view.camera.width + at.x () / cell_px])
            evidence = behind;
          else if (q.z () > view.at (at.x (), at.y ()))
            evidence = std::max<int> (evidence, occluded);
        }
        const double factor = evidence == behind     ? prior.depth_factor
                              : evidence == occluded ? prior.occluded_factor
                                                     : prior.side_factor;
        const std::size_t n = grid.index (i, j, k);
        bounds[n] = static_cast<float> (std::max (0.0, distance_vox[n] - factor * extents[1]));
      }
  return bounds;
}

class ExtentPriorTest : public testing::TestWithParam<int> // how many views
{
protected:
  ExtentPriorTest ()
  {
    AnalyticScene scene = tableScene (Shape::Cup);
    scene.add (2, placed (sphere (0.03), Eigen::Vector3d (0.13, 0.03, 0.04))); // hides parts
    for (int sensor = 0; sensor < 3; ++sensor)
      seen_.push_back (scene.render (tableCamera (), around (sensor)));
    for (const RenderedView& seen : seen_)
      points_.insert (points_.end (), seen.points.at (1).begin (), seen.points.at (1).end ());
    for (int v = 0; v < GetParam (); ++v)
      views_.emplace_back (&seen_[v].view, seen_[v].view.T_world_sensor);
    Eigen::AlignedBox3d box;
    for (const OrientedPoint& p : points_)
      box.extend (p.position.cast<double> ());
    grid_.voxel_size_m = 0.006;
    grid_.dims = ((box.sizes ().array () + 0.2) / grid_.voxel_size_m).cast<int> (); // no whole number of tiles
    grid_.origin_m = box.min ().array () - 0.1;
    std::vector<std::uint8_t> data (grid_.size (), 0);
    for (const OrientedPoint& p : points_)
      if (const auto at = grid_.nearest (p.position.cast<double> ()))
        data[grid_.index (at->x (), at->y (), at->z ())] = 1;
    distance_vox_ = distanceTransform (grid_.dims, data);
  }

  std::vector<RenderedView> seen_;
  std::vector<OrientedPoint> points_;
  Views views_;
  VoxelGrid grid_;
  std::vector<float> distance_vox_;
};

} // namespace

TEST_P (ExtentPriorTest, IsItsDefinition)
{
  const ExtentPrior prior;
  const std::vector<float> expected = defined (prior, grid_, distance_vox_, points_, views_);
  const std::vector<float> bounds = prior.bounds (grid_, distance_vox_, points_, views_);
  EXPECT_EQ (bounds, prior.bounds (grid_, distance_vox_, points_, views_, 1)) << "depends on the threads";
  ASSERT_EQ (bounds.size (), expected.size ());
  std::size_t bounded = 0;
  for (std::size_t n = 0; n < bounds.size (); ++n)
  {
    ASSERT_NEAR (bounds[n], expected[n], 1e-3) << "voxel " << n;
    bounded += expected[n] > 0.0f;
  }
  EXPECT_GT (bounded, bounds.size () / 20);
  EXPECT_LT (bounded, bounds.size ());
}

INSTANTIATE_TEST_SUITE_P (Views, ExtentPriorTest, testing::Values (0, 1, 3));
