// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion_scene.h"

#include "completion/mesh_distance.h"

#include <algorithm>
#include <cmath>

namespace pcl::cosection::test {
namespace {

const Eigen::Vector3d view_target (0.0, 0.0, 0.04);

} // namespace

std::string
nameOf (Shape shape)
{
  const char* names[] = {"Sphere", "Box", "Torus", "Cup"};
  return names[static_cast<int> (shape)];
}

Distance
onTable (Shape shape)
{
  switch (shape)
  {
  case Shape::Sphere:
    return placed (sphere (0.06), Eigen::Vector3d (0.0, 0.0, 0.06));
  case Shape::Box:
    return placed (box ({0.07, 0.05, 0.045}), Eigen::Vector3d (0.0, 0.0, 0.045));
  case Shape::Torus:
    return placed (torus (0.06, 0.025), Eigen::Vector3d (0.0, 0.0, 0.025));
  case Shape::Cup:
    break;
  }
  return cup (0.05, 0.1, 0.015);
}

AnalyticScene
tableScene (Shape shape)
{
  AnalyticScene scene;
  scene.add (0, halfSpace ({0.0, 0.0, 1.0, 0.0}));
  scene.add (1, onTable (shape));
  return scene;
}

PinholeCamera
tableCamera ()
{
  return {240, 180, 230.0, 230.0, 119.5, 89.5};
}

Eigen::Isometry3d
fromAbove ()
{
  return lookAt ({0.1, -0.42, 0.33}, view_target);
}

Eigen::Isometry3d
fromTheFront ()
{
  return lookAt ({0.05, -0.5, 0.12}, view_target);
}

CoSectionOptions
optionsFor (double voxel_size_m)
{
  CoSectionOptions options;
  options.voxel_size_m = voxel_size_m;
  options.threads = 1;
  return options;
}

Eigen::Isometry3d
motion (double angle_rad, const Eigen::Vector3d& axis, const Eigen::Vector3d& translation_m)
{
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity ();
  T.linear () = Eigen::AngleAxisd (angle_rad, axis.normalized ()).toRotationMatrix ();
  T.translation () = translation_m;
  return T;
}

double
effectOfMotion (Shape shape, double voxel_size_m, const Eigen::Isometry3d& T)
{
  const AnalyticScene scene = tableScene (shape);
  const auto completed = [&] (const Eigen::Isometry3d& M) {
    return complete (scene.moved (M).render (tableCamera (), M * fromAbove ()), optionsFor (voxel_size_m))
        .objects.at (0)
        .mesh;
  };
  const TriangleMesh still = completed (Eigen::Isometry3d::Identity ());
  TriangleMesh moved = completed (T);
  for (Eigen::Vector3f& v : moved.vertices)
    v = (T.inverse () * v.cast<double> ()).cast<float> ();
  const double reach_m = 4.0 * voxel_size_m;
  if (still.empty () || moved.empty ())
    return reach_m / voxel_size_m;
  return std::max (meanDistance (still, moved, reach_m), meanDistance (moved, still, reach_m)) / voxel_size_m;
}

SceneResult
complete (const RenderedView& seen, const CoSectionOptions& options)
{
  CoSection scene (options);
  scene.addView (seen.view);
  for (const auto& [label, points] : seen.points)
    if (label == 0)
      scene.setBackground (points);
    else
      scene.addObject ({label, points, {}});
  return scene.reconstruct ();
}

FieldDifference
differenceNearSurface (const SignedDistanceField& a, const SignedDistanceField& b, bool near_data)
{
  constexpr double near_vox = 2.0;
  const VoxelGrid& grid = a.grid;
  double sum = 0.0;
  FieldDifference difference;
  for (int k = 0; k < grid.dims.z (); ++k)
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        const std::size_t n = grid.index (i, j, k);
        const double u = a.values[n];
        const auto v = near_data && !a.supported[n] ? std::nullopt : b.sample (grid.center (i, j, k));
        if (!v || std::min (std::abs (u), std::abs (static_cast<double> (*v))) > near_vox * grid.voxel_size_m)
          continue;
        const double d = (u - *v) / grid.voxel_size_m;
        sum += d * d;
        ++difference.voxels;
      }
  if (difference.voxels > 0)
    difference.rms_vox = std::sqrt (sum / static_cast<double> (difference.voxels));
  return difference;
}

} // namespace pcl::cosection::test
