// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "guesses.h"

#include "object_image.h"
#include "only_side.h"
#include "pcl_cosection/common/plane_height.h"
#include "pcl_cosection/common/quantile.h"
#include "resting_planes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace pcl::cosection {
namespace {

constexpr double near_voxels = 2.0;    // from a surface, or its far end: part of it
constexpr double outlier_share = 0.05; // of vertices, at either end

bool
isAtPlane (const Eigen::Vector3d& p, const std::vector<Eigen::Vector4d>& planes, double near_m)
{
  return std::any_of (planes.begin (), planes.end (),
                      [&] (const Eigen::Vector4d& plane) { return std::abs (heightOver (plane, p)) < near_m; });
}

} // namespace

double
hiddenOutline (const Observation& object, bool is_cut_out, const std::vector<Eigen::Vector4d>& planes,
               const SignedDistanceField& completed, double enough)
{
  const double near_m = near_voxels * completed.grid.voxel_size_m;
  const auto hidesNothing = [&] (const Eigen::Vector3d& p) {
    const auto distance_m = completed.sample (p);
    return (distance_m && *distance_m < near_m) || isAtPlane (p, planes, near_m);
  };
  if (object.virtual_view)
    return 0.0;
  std::optional<double> least;
  for (const auto& [view, T_object_sensor] : object.views)
  {
    const ObjectImage image (*view, T_object_sensor, *object.all_points, object.voxel_size_m);
    if (const std::optional<double> hidden = image.hiddenOutline (is_cut_out, hidesNothing))
      least = std::min (*hidden, least.value_or (*hidden));
    if (least && *least <= enough)
      break;
  }
  return least.value_or (0.0);
}

double
depthBehindOnlySide (const std::vector<OrientedPoint>& points, const std::vector<Eigen::Vector4d>& planes,
                     double voxel_size_m, const TriangleMesh& mesh)
{
  const SeenSide side = seenSide (points);
  if (side.normal.isZero () || mesh.vertices.empty ())
    return 0.0;
  std::vector<double> heights;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    heights.push_back (side.normal.dot (vertex.cast<double> ()));
  std::vector<double> sorted = heights;
  const double low = trimmedMin (sorted, outlier_share), extent = trimmedMax (sorted, outlier_share) - low;
  if (!side.isFlat (extent))
    return 0.0;
  const double near_m = near_voxels * voxel_size_m;
  std::size_t at_end = 0, at_others = 0;
  for (std::size_t v = 0; v < heights.size (); ++v)
    if (heights[v] < low + near_m)
    {
      const Eigen::Vector3d vertex = mesh.vertices[v].cast<double> ();
      ++at_end;
      at_others += isAtPlane (vertex, planes, near_m) ||
                           mesh.provenance[v] == static_cast<std::uint8_t> (Provenance::Intersection)
                       ? 1
                       : 0;
    }
  return 2 * at_others > at_end ? 0.0 : std::max (0.0, side.low_m - low);
}

double
depthDownToPlane (const Observation& object, const std::vector<Eigen::Vector4d>& planes, const TriangleMesh& mesh)
{
  double deepest_m = 0.0;
  for (const Eigen::Vector4d& plane : planes)
  {
    std::vector<double> heights;
    for (const OrientedPoint& point : object.points ())
      heights.push_back (heightOver (plane, point.position.cast<double> ()));
    const double lowest_m = trimmedMin (heights, lowest_share);
    const bool reaches_it = std::any_of (mesh.vertices.begin (), mesh.vertices.end (), [&] (const Eigen::Vector3f& v) {
      return heightOver (plane, v.cast<double> ()) < near_voxels * object.voxel_size_m;
    });
    if (reaches_it && lowest_m > object.extents_m[0])
      deepest_m = std::max (deepest_m, lowest_m);
  }
  return deepest_m;
}

} // namespace pcl::cosection
