// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "evaluation/evaluation_meshes.h"

#include "pcl_cosection/visualization/sdf_slices.h"
#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

TEST (SdfSlices, CutsOfABoxShowItsInside)
{
  const Eigen::Vector3f low (-0.1f, -0.06f, -0.04f), high (0.1f, 0.06f, 0.04f);
  const SdfSlices slices (boxMesh (low, high), 64);
  for (int axis = 0; axis < 3; ++axis)
    for (const double share : {0.5, 0.0})
    {
      const SdfSlice slice = slices.slice (axis, share, 160);
      const Picture& picture = slice.picture;
      ASSERT_GT (picture.width, 20);
      std::size_t wrong = 0;
      for (int v = 0; v < picture.height; ++v)
        for (int u = 0; u < picture.width; ++u)
        {
          const float s = (static_cast<float> (u) + 0.5f) / static_cast<float> (picture.width);
          const float t = (static_cast<float> (v) + 0.5f) / static_cast<float> (picture.height);
          const Eigen::Vector3f p = slice.corners[0] + s * (slice.corners[1] - slice.corners[0]) +
                                    t * (slice.corners[3] - slice.corners[0]);
          const bool is_inside = ((p - low).array () > 0.004f).all () && ((high - p).array () > 0.004f).all ();
          const bool is_outside = ((p - low).array () < -0.004f).any () || ((high - p).array () < -0.004f).any ();
          const auto& pixel = picture.at (u, v);
          wrong += (is_inside && !(pixel[2] > pixel[0])) || (is_outside && !(pixel[0] > pixel[2]));
        }
      EXPECT_EQ (wrong, 0u) << axis << ' ' << share;
      EXPECT_NEAR (slice.corners[0][axis], slice.corners[2][axis], 1e-6);
    }
}

TEST (SdfSlices, ColoursOfDistances)
{
  EXPECT_EQ (distanceColour (0.0, 1.0), (TriangleMesh::Colour{255, 255, 255}));
  EXPECT_EQ (distanceColour (5.0, 1.0), distanceColour (1.0, 1.0));
  EXPECT_EQ (distanceColour (-5.0, 1.0), distanceColour (-1.0, 1.0));
  EXPECT_GT (distanceColour (0.5, 1.0)[0], distanceColour (0.5, 1.0)[2]);
  EXPECT_GT (distanceColour (-0.5, 1.0)[2], distanceColour (-0.5, 1.0)[0]);
}

TEST (SdfSlices, NothingHasNoSlices)
{
  EXPECT_THROW (SdfSlices{TriangleMesh{}}, InvalidArgument);
  EXPECT_THROW (SdfSlices (boxMesh ({0, 0, 0}, {1, 1, 1}), 2), InvalidArgument);
}
