// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion_cube.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/view/visibility/visibility.h"

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr double outer_share = 0.02; // of the points, beyond which outliers may be
constexpr double margin = 1.5;       // edge of the cube by the extent of what was seen: networks are trained with it
constexpr double before = 0.1;       // of the cube, which is before what was seen
constexpr double free_vox = 1.5;     // a reading is so much farther where a view looks through a voxel

/** \brief Which pixels of a view show the object. */
std::vector<std::uint8_t>
ownPixels (const DepthView& view, const Eigen::Isometry3d& T_sensor_object, const std::vector<OrientedPoint>& points,
           double tolerance_m)
{
  std::vector<std::uint8_t> own (view.depth.size ());
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d p = T_sensor_object * point.position.cast<double> ();
    const auto pixel = pixelOf (view.camera, p);
    if (pixel && std::abs (view.at (pixel->x (), pixel->y ()) - p.z ()) <= tolerance_m)
      own[static_cast<std::size_t> (pixel->y ()) * view.camera.width + pixel->x ()] = 1;
  }
  return own;
}

} // namespace

std::optional<CompletionCube>
completionCube (const std::vector<OrientedPoint>& points, const SensorViews& views, const Eigen::Vector4d& plane)
{
  if (points.empty () || views.empty ())
    return std::nullopt;
  const Eigen::Vector3d up = plane.head<3> ();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero ();
  for (const OrientedPoint& point : points)
    middle += point.position.cast<double> () / static_cast<double> (points.size ());
  Eigen::Vector3d away = Eigen::Vector3d::Zero ();
  for (const auto& [view, T_object_sensor] : views)
    away += (middle - T_object_sensor.translation ()).normalized ();
  away -= away.dot (up) * up;
  if (!(away.norm () > 1e-6)) // all straight above, or all around
    away = up.unitOrthogonal ();
  away.normalize ();
  Eigen::Matrix3d R; // cube to object
  R << away, up.cross (away), up;

  std::array<std::vector<double>, 3> along;
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d p = R.transpose () * point.position.cast<double> ();
    for (int axis = 0; axis < 3; ++axis)
      along[axis].push_back (p[axis]);
  }
  Eigen::Vector3d low, high;
  for (int axis = 0; axis < 3; ++axis)
  {
    low[axis] = quantile (along[axis], outer_share);
    high[axis] = quantile (along[axis], 1.0 - outer_share);
  }
  low.z () = -plane[3]; // the plane is at z = -d
  const double extent_m = (high - low).maxCoeff ();
  if (!(extent_m > 0.0) || !std::isfinite (extent_m))
    return std::nullopt;
  CompletionCube cube;
  const double edge_m = margin * extent_m;
  cube.voxel_size_m = edge_m / CompletionCube::size;
  const Eigen::Vector3d corner (low.x () - before * edge_m, 0.5 * (low.y () + high.y () - edge_m),
                                low.z () - CompletionCube::below_vox * cube.voxel_size_m);
  cube.T_object_cube.linear () = R;
  cube.T_object_cube.translation () = R * corner;
  return cube;
}

CompletionInputs
completionInputs (const CompletionCube& cube, const std::vector<OrientedPoint>& points, const SensorViews& views)
{
  CompletionInputs inputs;
  inputs.distance.assign (CompletionCube::voxels, 0.0f);
  inputs.is_free.assign (CompletionCube::voxels, 0);
  inputs.is_behind.assign (CompletionCube::voxels, 0);
  inputs.is_unknown.assign (CompletionCube::voxels, 0);
  const double free_m = free_vox * cube.voxel_size_m, truncation_m = CompletionCube::truncation_vox * cube.voxel_size_m;
  std::vector<std::vector<std::uint8_t>> own;
  std::vector<Eigen::Isometry3d> T_sensor_object;
  for (const auto& [view, T_object_sensor] : views)
  {
    T_sensor_object.push_back (T_object_sensor.inverse ());
    own.push_back (ownPixels (*view, T_sensor_object.back (), points, free_m));
  }
  for (int k = CompletionCube::below_vox; k < CompletionCube::size; ++k)
    for (int j = 0; j < CompletionCube::size; ++j)
      for (int i = 0; i < CompletionCube::size; ++i)
      {
        const std::size_t n = CompletionCube::index (i, j, k);
        bool is_free = false, is_own = false;
        double in_front = truncation_m, behind = -truncation_m; // the nearest own surface
        for (std::size_t v = 0; v < views.size (); ++v)
        {
          const DepthView& view = *views[v].first;
          const Eigen::Vector3d p = T_sensor_object[v] * cube.center (i, j, k);
          const auto pixel = pixelOf (view.camera, p);
          if (!pixel || !isReading (view.at (pixel->x (), pixel->y ())))
            continue;
          const double gap_m = view.at (pixel->x (), pixel->y ()) - p.z ();
          is_free |= gap_m > free_m;
          if (!own[v][static_cast<std::size_t> (pixel->y ()) * view.camera.width + pixel->x ()])
            continue;
          is_own = true;
          if (gap_m > 0.0)
            in_front = std::min (in_front, gap_m);
          else
            behind = std::max (behind, gap_m);
        }
        // In front of one surface is in front of the object, except where the noise of views differs.
        const bool is_outside = is_own && (in_front < truncation_m || (is_free && behind <= -truncation_m));
        const double gap_m = !is_own ? 0.0 : is_outside && (is_free || in_front < -behind) ? in_front : behind;
        inputs.distance[n] = static_cast<float> (gap_m / truncation_m);
        inputs.is_free[n] = is_free;
        inputs.is_behind[n] = !is_free && is_own && gap_m < 0.0;
        inputs.is_unknown[n] = !is_free && !is_own;
      }
  return inputs;
}

} // namespace pcl::cosection
