// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Surfaces that organised views see at grazing angles, and mixed pixels, which also lie along the rays.

#include "common/temporary_folder.h"

#include <pcl/cosection/io/pcd_view.h>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>

using namespace pcl::cosection;

namespace {

constexpr int width = 640;
constexpr int height = 480;
constexpr float focal_px = 525.0f;
constexpr float background_m = 2.0f;
constexpr float front_m = 0.8f;
constexpr float half_width_m = 0.08f;
constexpr float depth_m = 0.3f;

class GrazingSurfaces : public testing::Test
{
protected:
  /** \brief An organised view. \a depthOf gives the object's depth along a ray (x, y, 1), NaN beside it; the depth of
   * the background is constant or given by \a backgroundOf. */
  LabelledView see (
      const std::function<float (float, float)>& depthOf, float sigma_m, double missing,
      const std::function<float (float, float)>& backgroundOf = [] (float, float) { return background_m; }) const
  {
    std::mt19937 random (7);
    std::normal_distribution<float> noise (0.0f, 1.0f);
    std::bernoulli_distribution drops (missing);
    pcl::PointCloud<pcl::PointXYZL> cloud (width, height);
    for (int v = 0; v < height; ++v)
      for (int u = 0; u < width; ++u)
      {
        const float x = (static_cast<float> (u) - 319.5f) / focal_px;
        const float y = (static_cast<float> (v) - 239.5f) / focal_px;
        const float depth = depthOf (x, y);
        auto& p = cloud (u, v);
        p.label = std::isnan (depth) ? 0 : 1;
        const float z = (std::isnan (depth) ? backgroundOf (x, y) : depth) + sigma_m * noise (random);
        p.x = x * z;
        p.y = y * z;
        p.z = drops (random) ? std::numeric_limits<float>::quiet_NaN () : z;
      }
    const std::string path = folder_.file ("view.pcd");
    pcl::io::savePCDFileBinary (path, cloud);
    return readPcdView (path);
  }

private:
  pcl::cosection::test::TemporaryFolder folder_;
};

/** \brief The depth of a box whose top is below the sensor. */
float
boxBelow (float below_m, float x, float y)
{
  constexpr float none = std::numeric_limits<float>::quiet_NaN ();
  if (!(y > 0.0f))
    return none;
  const float top = below_m / y;
  const float depth = top > front_m ? top : front_m;
  return depth < front_m + depth_m && std::abs (x) * depth < half_width_m && y * front_m < below_m + 0.15f ? depth
                                                                                                           : none;
}

} // namespace

TEST_F (GrazingSurfaces, HaveNormals)
{
  for (const float below_m : {0.06f, 0.09f, 0.13f}) // seen at 4 to 10 degrees
    for (const auto& [sigma_m, missing] : {std::pair (0.0f, 0.0), std::pair (0.0015f, 0.3)})
    {
      SCOPED_TRACE (std::to_string (below_m) + " m below, noise " + std::to_string (sigma_m) + " m");
      std::size_t readings = 0;
      const LabelledView view = see (
          [&, below = below_m] (float x, float y) {
            const float depth = boxBelow (below, x, y);
            readings += depth > front_m + 0.02f;
            return depth;
          },
          sigma_m, missing);
      std::size_t known = 0;
      std::size_t wrong = 0;
      for (const OrientedPoint& p : view.objects.at (1).points)
        if (p.position.z () > front_m + 0.02f)
        {
          ++known;
          wrong += -p.normal.y () < 0.95f; // 18 degrees
        }
      EXPECT_GT (static_cast<double> (known), 0.8 * (1.0 - missing) * static_cast<double> (readings));
      EXPECT_LT (static_cast<double> (wrong), 0.02 * static_cast<double> (known));
    }
}

TEST_F (GrazingSurfaces, AreNoFlyingPixels)
{
  for (const int trail_px : {1, 2, 3, 4})
    for (const float behind_m : {0.1f, 0.4f, 1.2f})
    {
      SCOPED_TRACE (std::to_string (trail_px) + " pixels to " + std::to_string (behind_m) + " m behind");
      const LabelledView view = see (
          [&, trail = trail_px, behind = behind_m] (float x, float y) {
            constexpr float none = std::numeric_limits<float>::quiet_NaN ();
            const auto beyond = (std::abs (x) - half_width_m / front_m) * focal_px; // pixels
            if (std::abs (y) > 0.15f || beyond > static_cast<float> (trail))
              return none;
            return front_m + (beyond <= 0.0f ? 0.0f : behind * beyond / static_cast<float> (trail + 1));
          },
          0.001f, 0.0);
      std::size_t flying = 0;
      for (const OrientedPoint& p : view.objects.at (1).points)
        flying += p.position.z () > front_m + 0.02f;
      EXPECT_EQ (flying, 0u);
    }
}

TEST_F (GrazingSurfaces, AreNoSmearedEdges)
{
  for (const float behind_m : {0.15f, 0.3f, 0.6f})
    for (const int width_px : {7, 9, 11})
      for (const int labelled_px : {width_px / 2, width_px, width_px + 3}) // exact labels, and larger ones
      {
        SCOPED_TRACE (std::to_string (width_px) + " pixels to " + std::to_string (behind_m) + " m behind, " +
                      std::to_string (labelled_px) + " of them of the plate");
        const auto beyondEdge = [] (float x) { return (std::abs (x) - half_width_m / front_m) * focal_px; }; // pixels
        const auto smeared = [&, behind = behind_m, width = width_px] (float x, float y) {
          const float far_away = std::abs (y) > 0.15f ? 1.0f : beyondEdge (x) / static_cast<float> (width);
          return front_m + behind * std::min (1.0f, std::max (0.0f, far_away));
        };
        const LabelledView view = see (
            [&, labelled = labelled_px] (float x, float y) {
              const bool on_plate = std::abs (y) < 0.15f && beyondEdge (x) < static_cast<float> (labelled);
              return on_plate ? smeared (x, y) : std::numeric_limits<float>::quiet_NaN ();
            },
            0.0005f, 0.0, smeared);
        std::size_t flying = 0;
        for (const OrientedPoint& p : view.objects.at (1).points)
          flying += p.normal.z () > -0.3f;
        EXPECT_EQ (flying, 0u);
      }
}
