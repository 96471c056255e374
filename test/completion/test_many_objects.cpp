// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "many_balls.h"

#include "pcl_cosection/completion/neighbours.h"

#include <gtest/gtest.h>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

/** \brief Small objects are completed at the same time: each as it is alone on one thread. */
TEST (ManyObjects, AreTheSameForAnyNumberOfThreads)
{
  const SceneResult one = completeManyBalls (6, 1), three = completeManyBalls (6, 3);
  ASSERT_EQ (one.objects.size (), three.objects.size ());
  for (std::size_t o = 0; o < one.objects.size (); ++o)
  {
    EXPECT_TRUE (one.objects[o].error.empty ()) << one.objects[o].error;
    ASSERT_FALSE (one.objects[o].mesh.empty ());
    EXPECT_EQ (one.objects[o].mesh.vertices, three.objects[o].mesh.vertices);
    EXPECT_EQ (one.objects[o].mesh.triangles, three.objects[o].mesh.triangles);
    EXPECT_EQ (one.objects[o].penetration_m, three.objects[o].penetration_m);
  }
}

namespace {

/** \brief Objects with volumes of 1 m in a row, so far apart. */
class Row
{
public:
  Row (std::size_t count, double step_m) : inputs_ (count), bodies_ (count), objects_ (count)
  {
    for (std::size_t o = 0; o < count; ++o)
    {
      VoxelGrid grid;
      grid.dims = Eigen::Vector3i::Constant (11);
      grid.voxel_size_m = 0.1;
      bodies_[o].grid = grid;
      const Eigen::Translation3d at (0.0, step_m * static_cast<double> (o), 0.0);
      inputs_[o].T_world_object = {Eigen::Isometry3d (at)};
      objects_[o].input = &inputs_[o];
      objects_[o].body = &bodies_[o];
    }
  }

  void move (std::size_t o, double x, double y)
  {
    inputs_[o].T_world_object.emplace_back (Eigen::Translation3d (x, y, 0.0));
  }

  std::vector<std::vector<std::size_t>> neighbours () const { return neighboursOf (objects_); }

private:
  std::vector<ObjectInput> inputs_;
  std::vector<BodyState> bodies_;
  std::vector<SceneObject> objects_;
};

using Indices = std::vector<std::size_t>;

} // namespace

TEST (Neighbours, AreThoseWhoseVolumesMeet)
{
  for (const auto& of_one : Row (50, 2.0).neighbours ())
    EXPECT_TRUE (of_one.empty ());
  const auto touching = Row (50, 1.0).neighbours ();
  EXPECT_EQ (touching[0], Indices ({1}));
  EXPECT_EQ (touching[20], Indices ({19, 21}));
  EXPECT_EQ (touching[49], Indices ({48}));
  EXPECT_TRUE (Row (0, 1.0).neighbours ().empty ());
}

TEST (Neighbours, OfAMovedObjectAreThoseOfAllItsPlaces)
{
  Row row (50, 2.0);
  row.move (10, 0.3, 80.5); // object 40
  const auto neighbours = row.neighbours ();
  EXPECT_EQ (neighbours[40], Indices ({10}));
  EXPECT_EQ (neighbours[10].front (), 9U + 2U); // on its way it may meet those between
  EXPECT_EQ (neighbours[9], Indices ());
}
