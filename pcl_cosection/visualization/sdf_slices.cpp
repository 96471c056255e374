// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "sdf_slices.h"

#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/volume/mesh_distance.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr double margin = 0.25;     ///< of the longest side, at each side
constexpr double limit_share = 0.2; ///< of the longest side
constexpr double line_px = 0.75;    ///< half the width of the line where the surface is cut
constexpr TriangleMesh::Colour line = {20, 20, 20};

} // namespace

TriangleMesh::Colour
distanceColour (double distance_m, double limit_m)
{
  constexpr TriangleMesh::Colour inside = {38, 84, 184}, outside = {206, 78, 44};
  const double share = std::isfinite (distance_m) ? std::clamp (distance_m / limit_m, -1.0, 1.0) : 1.0;
  const TriangleMesh::Colour& far = share < 0.0 ? inside : outside;
  TriangleMesh::Colour colour;
  for (int channel = 0; channel < 3; ++channel)
    colour[channel] = static_cast<std::uint8_t> (std::lround (255.0 + std::abs (share) * (far[channel] - 255.0)));
  return colour;
}

SdfSlices::SdfSlices (const TriangleMesh& mesh, int voxels, int threads)
{
  if (voxels < 8)
    throw InvalidArgument ("there must be at least 8 voxels along a side");
  const Eigen::AlignedBox3d box = vertexBox (mesh);
  if (box.isEmpty () || !(box.sizes ().maxCoeff () > 0.0))
    throw InvalidArgument ("a mesh without extent has no signed distance");
  const double side_m = box.sizes ().maxCoeff ();
  VoxelGrid grid;
  grid.voxel_size_m = (1.0 + 2.0 * margin) * side_m / voxels;
  grid.origin_m = box.min ().array () - margin * side_m;
  grid.dims = ((box.sizes ().array () + 2.0 * margin * side_m) / grid.voxel_size_m).ceil ().cast<int> () + 1;
  limit_m_ = limit_share * side_m;
  field_ = sampleSignedDistance (mesh, grid, limit_m_, threads);
}

SdfSlice
SdfSlices::slice (int axis, double share, int pixels) const
{
  const VoxelGrid& grid = field_.grid;
  const Eigen::Vector3d size = grid.voxel_size_m * (grid.dims.array () - 1).cast<double> ().matrix ();
  const int across = (axis + 1) % 3, down = (axis + 2) % 3;
  const double pixel_m = std::max (size[across], size[down]) / std::max (2, pixels);
  SdfSlice result;
  result.picture = Picture (std::max (2, static_cast<int> (size[across] / pixel_m)),
                            std::max (2, static_cast<int> (size[down] / pixel_m)));
  Eigen::Vector3d p = grid.origin_m;
  p[axis] += std::clamp (share, 0.0, 1.0) * size[axis];
  const Eigen::Vector3d first = p;
  for (int v = 0; v < result.picture.height; ++v)
    for (int u = 0; u < result.picture.width; ++u)
    {
      p[across] = first[across] + size[across] * (u + 0.5) / result.picture.width;
      p[down] = first[down] + size[down] * (v + 0.5) / result.picture.height;
      const double distance_m = field_.sample (p).value_or (limit_m_);
      result.picture.at (u, v) = std::abs (distance_m) < line_px * pixel_m ? line
                                                                           : distanceColour (distance_m, limit_m_);
    }
  Eigen::Vector3d along = Eigen::Vector3d::Zero (), downward = Eigen::Vector3d::Zero ();
  along[across] = size[across];
  downward[down] = size[down];
  result.corners = {first.cast<float> (), (first + along).cast<float> (), (first + along + downward).cast<float> (),
                    (first + downward).cast<float> ()};
  return result;
}

} // namespace pcl::cosection
