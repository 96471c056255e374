// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "penetration.h"

#include "pcl_cosection/common/parallel.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

/** \brief Largest depthAt (place) over the places where a field's zero set crosses edges of its grid; 0 if all are
 * outside. */
template <typename DepthAt>
double
deepest (const SignedDistanceField& field, int threads, DepthAt&& depthAt)
{
  const VoxelGrid& grid = field.grid;
  std::vector<double> deepest (grid.dims.z (), 0.0);
  parallelFor (0, grid.dims.z (), threads, [&] (int k) {
    const auto edge = [&] (int i, int j, int axis, float here, float there) {
      if ((here < 0.0f) == (there < 0.0f))
        return;
      Eigen::Vector3d at = grid.center (i, j, k);
      at[axis] += grid.voxel_size_m * here / (here - there);
      deepest[k] = std::max (deepest[k], depthAt (at));
    };
    const bool has_above = k + 1 < grid.dims.z ();
    for (int j = 0; j < grid.dims.y (); ++j)
    {
      const float* row = field.values.data () + grid.index (0, j, k);
      const float* next_row = j + 1 < grid.dims.y () ? field.values.data () + grid.index (0, j + 1, k)
                                                     : row; // itself: no crossing
      const float* row_above = has_above ? field.values.data () + grid.index (0, j, k + 1) : row;
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        if (i + 1 < grid.dims.x ())
          edge (i, j, 0, row[i], row[i + 1]);
        edge (i, j, 1, row[i], next_row[i]);
        edge (i, j, 2, row[i], row_above[i]);
      }
    }
  });
  return *std::max_element (deepest.begin (), deepest.end ());
}

double
penetrationOfGivenPlanes (const Scene& scene, const SceneObject& object, const SignedDistanceField& surface)
{
  const auto begin = object.support->planes.begin (); // given planes come first
  const std::vector<Eigen::Vector4d> given (begin, begin + static_cast<std::ptrdiff_t> (scene.planes.size ()));
  const std::vector<Eigen::Vector4d> planes = planesAtPoses (*object.input, object.observation->box.center (), given,
                                                             object.T_world_object);
  if (planes.empty ())
    return 0.0;
  return deepest (surface, scene.options.threads, [&] (const Eigen::Vector3d& at) {
    double depth = 0.0;
    for (const Eigen::Vector4d& plane : planes)
      depth = std::max (depth, -plane.head<3> ().dot (at) - plane[3]);
    return depth;
  });
}

} // namespace

double
penetration (const SignedDistanceField& surface, const SignedDistanceField& body,
             const std::vector<Eigen::Isometry3d>& T_body_object, int threads)
{
  return deepest (surface, threads, [&] (const Eigen::Vector3d& at) {
    double depth = 0.0;
    for (const Eigen::Isometry3d& T : T_body_object)
      if (const auto u = body.sampleInside (body.grid.toVoxel (T * at)))
        depth = std::max (depth, static_cast<double> (-*u));
    return depth;
  });
}

double
penetrationOfSurroundings (const Scene& scene, const SceneObject& object, const SignedDistanceField& surface,
                           const std::vector<SignedDistanceField::ConstPtr>& background,
                           const std::vector<Obstacle>& obstacles)
{
  const int threads = scene.options.threads;
  double deepest = penetrationOfGivenPlanes (scene, object, surface);
  for (const SignedDistanceField::ConstPtr& body : background)
    deepest = std::max (deepest, penetration (surface, *body, object.T_world_object, threads));
  for (const Obstacle& obstacle : obstacles)
    for (const Eigen::Isometry3d& T_field_world : obstacle.T_field_world)
      for (const Eigen::Isometry3d& T_world_object : object.T_world_object)
        deepest = std::max (deepest, penetration (surface, *obstacle.field, {T_field_world * T_world_object}, threads));
  return deepest;
}

} // namespace pcl::cosection
