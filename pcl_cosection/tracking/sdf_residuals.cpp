// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "sdf_residuals.h"

#include "pcl_cosection/common/multiversion.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/common/robust_weights.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace pcl::cosection {
namespace {

constexpr int block_points = 128; ///< what is known of a block fits into the first cache
constexpr int blocks_per_sum = 8; ///< sums of so many blocks are added up in order
constexpr float steepest = 1e6f;  ///< beside voxels that hold a largest number instead of a distance it is steeper

using Row = float[block_points];

/** \brief From the sensor's frame to voxels, and the cell's bounds. */
struct VoxelMap
{
  VoxelMap (const SampledVolume& volume, const Eigen::Isometry3d& T_grid_sensor)
  {
    const Eigen::Vector3d begin = (T_grid_sensor.translation () - volume.origin_m) / volume.voxel_size_m;
    const Eigen::Vector3d center = (volume.center () - volume.origin_m) / volume.voxel_size_m;
    for (int axis = 0; axis < 3; ++axis)
    {
      for (int column = 0; column < 3; ++column)
        linear[3 * axis + column] = static_cast<float> (T_grid_sensor (axis, column) / volume.voxel_size_m);
      shift[axis] = static_cast<float> (begin[axis]);
      last[axis] = volume.dims[axis] - 1;
      center_vox[axis] = static_cast<float> (center[axis]);
    }
    row = volume.dims.x ();
    slice = volume.dims.x () * volume.dims.y ();
    per_radius = static_cast<float> (volume.voxel_size_m / volume.radius ());
    per_voxel = static_cast<float> (1.0 / volume.voxel_size_m);
  }

  float linear[9];
  float shift[3];
  int last[3];
  float center_vox[3];
  int row;
  int slice;
  float per_radius; ///< voxels to q
  float per_voxel;  ///< 1 / m
};

/** \brief A block of points on its way through the stages below. */
struct Block
{
  Row lever[3];    // q
  Row fraction[3]; // within the cell
  int cell[block_points];
  int nearest[block_points];
  float inside[block_points];         // 1 or 0
  float corners[4][2 * block_points]; // pairs along x
  Row voxel_weight;
  Row distance;
  Row jacobian[6];
  Row weighted[6]; // w h J
  Row weight;      // w
  Row robust;      // w h
  Row inlier;      // w or 0
  Row squared_lever;
  Row known; // 1 or 0
};

/** \brief One component of the cell that \a v is in; anything that is not within [0, last] ends up at its border. */
PCL_COSECTION_INLINE int
cellOf (float v, int last, float& fraction)
{
  const auto end = static_cast<float> (last);
  const float above = v > 0.0f ? v : 0.0f; // 0 for NaN
  const float within = above < end ? above : end;
  const auto below = static_cast<int> (within);
  const int cell = below < last ? below : last - 1;
  fraction = within - static_cast<float> (cell);
  return cell;
}

PCL_COSECTION_MULTIVERSION void
locate (const VoxelMap& map, const float* __restrict x, const float* __restrict y, const float* __restrict z, Block& b)
{
  const VoxelMap m = map;
  for (int n = 0; n < block_points; ++n)
  {
    const float vx = m.linear[0] * x[n] + m.linear[1] * y[n] + m.linear[2] * z[n] + m.shift[0];
    const float vy = m.linear[3] * x[n] + m.linear[4] * y[n] + m.linear[5] * z[n] + m.shift[1];
    const float vz = m.linear[6] * x[n] + m.linear[7] * y[n] + m.linear[8] * z[n] + m.shift[2];
    const bool inside = (vx >= 0.0f) & (vx <= static_cast<float> (m.last[0])) & (vy >= 0.0f) &
                        (vy <= static_cast<float> (m.last[1])) & (vz >= 0.0f) & (vz <= static_cast<float> (m.last[2]));
    float fx, fy, fz;
    const int i = cellOf (vx, m.last[0], fx);
    const int j = cellOf (vy, m.last[1], fy);
    const int k = cellOf (vz, m.last[2], fz);
    b.inside[n] = inside ? 1.0f : 0.0f;
    b.cell[n] = k * m.slice + j * m.row + i;
    b.nearest[n] = b.cell[n] + (fz >= 0.5f ? m.slice : 0) + (fy >= 0.5f ? m.row : 0) + (fx >= 0.5f ? 1 : 0);
    b.fraction[0][n] = fx;
    b.fraction[1][n] = fy;
    b.fraction[2][n] = fz;
    b.lever[0][n] = inside ? (vx - m.center_vox[0]) * m.per_radius : 0.0f;
    b.lever[1][n] = inside ? (vy - m.center_vox[1]) * m.per_radius : 0.0f;
    b.lever[2][n] = inside ? (vz - m.center_vox[2]) * m.per_radius : 0.0f;
  }
}

/** \brief Reads what is scattered in memory. */
void
fetch (const SampledVolume& volume, const VoxelMap& map, Block& b)
{
  for (int n = 0; n < block_points; ++n)
  {
    const float* corner = volume.values + b.cell[n];
    std::memcpy (&b.corners[0][2 * n], corner, 2 * sizeof (float));
    std::memcpy (&b.corners[1][2 * n], corner + map.row, 2 * sizeof (float));
    std::memcpy (&b.corners[2][2 * n], corner + map.slice, 2 * sizeof (float));
    std::memcpy (&b.corners[3][2 * n], corner + map.slice + map.row, 2 * sizeof (float));
  }
  if (volume.weights)
    for (int n = 0; n < block_points; ++n)
      b.voxel_weight[n] = volume.weights[b.nearest[n]] * volume.weight_scale;
  else
    std::fill (std::begin (b.voxel_weight), std::end (b.voxel_weight), 1.0f);
}

PCL_COSECTION_MULTIVERSION void
linearise (const VoxelMap& map, const RobustWeights& robust, const float* __restrict point_weight, Block& b)
{
  const float per_voxel = map.per_voxel;
  const float huber = robust.huber_m;
  const float farthest = robust.max_distance_m;
  for (int n = 0; n < block_points; ++n)
  {
    const float fx = b.fraction[0][n];
    const float fy = b.fraction[1][n];
    const float fz = b.fraction[2][n];
    const float step_00 = b.corners[0][2 * n + 1] - b.corners[0][2 * n];
    const float step_10 = b.corners[1][2 * n + 1] - b.corners[1][2 * n];
    const float step_01 = b.corners[2][2 * n + 1] - b.corners[2][2 * n];
    const float step_11 = b.corners[3][2 * n + 1] - b.corners[3][2 * n];
    const float edge_00 = b.corners[0][2 * n] + fx * step_00;
    const float edge_10 = b.corners[1][2 * n] + fx * step_10;
    const float edge_01 = b.corners[2][2 * n] + fx * step_01;
    const float edge_11 = b.corners[3][2 * n] + fx * step_11;
    const float low = edge_00 + fy * (edge_10 - edge_00);
    const float high = edge_01 + fy * (edge_11 - edge_01);
    const float step_low = step_00 + fy * (step_10 - step_00);
    const float step_high = step_01 + fy * (step_11 - step_01);
    const float dy_low = edge_10 - edge_00;
    const float dy_high = edge_11 - edge_01;
    const float d = low + fz * (high - low);
    const float gx = (step_low + fz * (step_high - step_low)) * per_voxel;
    const float gy = (dy_low + fz * (dy_high - dy_low)) * per_voxel;
    const float gz = (high - low) * per_voxel;

    const float w = point_weight[n] * b.voxel_weight[n] * b.inside[n];
    const float slope = std::abs (gx) + std::abs (gy) + std::abs (gz);
    const bool known = (w > 0.0f) & (std::abs (d) <= farthest) & (slope <= steepest); // not for NaN
    const float distance = known ? d : 0.0f;
    const float x = known ? gx : 0.0f;
    const float y = known ? gy : 0.0f;
    const float z = known ? gz : 0.0f;
    const float weight = known ? w : 0.0f;
    const float size = std::abs (distance);
    const bool inlier = size <= huber;
    const float robust_weight = weight * huberWeight (size, huber);
    const float qx = b.lever[0][n];
    const float qy = b.lever[1][n];
    const float qz = b.lever[2][n];
    const float rx = qy * z - qz * y;
    const float ry = qz * x - qx * z;
    const float rz = qx * y - qy * x;
    b.distance[n] = distance;
    b.known[n] = known ? 1.0f : 0.0f;
    b.weight[n] = weight;
    b.robust[n] = robust_weight;
    b.inlier[n] = inlier ? weight : 0.0f;
    b.squared_lever[n] = qx * qx + qy * qy + qz * qz;
    b.jacobian[0][n] = x;
    b.jacobian[1][n] = y;
    b.jacobian[2][n] = z;
    b.jacobian[3][n] = rx;
    b.jacobian[4][n] = ry;
    b.jacobian[5][n] = rz;
    b.weighted[0][n] = robust_weight * x;
    b.weighted[1][n] = robust_weight * y;
    b.weighted[2][n] = robust_weight * z;
    b.weighted[3][n] = robust_weight * rx;
    b.weighted[4][n] = robust_weight * ry;
    b.weighted[5][n] = robust_weight * rz;
  }
}

/** \brief Partial sums, one per lane, so that the compiler need not reorder additions. */
struct Lanes
{
  static constexpr int count = 8;

  PCL_COSECTION_INLINE void add (const float* __restrict a, const float* __restrict b)
  {
    for (int n = 0; n < block_points; n += count)
      for (int lane = 0; lane < count; ++lane)
        sums[lane] += a[n + lane] * b[n + lane];
  }

  PCL_COSECTION_INLINE void add (const float* __restrict a)
  {
    for (int n = 0; n < block_points; n += count)
      for (int lane = 0; lane < count; ++lane)
        sums[lane] += a[n + lane];
  }

  PCL_COSECTION_INLINE double total () const
  {
    double total = 0.0;
    for (const float sum : sums)
      total += sum;
    return total;
  }

  float sums[count] = {};
};

PCL_COSECTION_INLINE double
dot (const float* a, const float* b)
{
  Lanes lanes;
  lanes.add (a, b);
  return lanes.total ();
}

PCL_COSECTION_INLINE double
sum (const float* a)
{
  Lanes lanes;
  lanes.add (a);
  return lanes.total ();
}

PCL_COSECTION_MULTIVERSION void
accumulate (const Block& b, ResidualSums& sums)
{
  int entry = 0;
  for (int row = 0; row < 6; ++row)
  {
    for (int column = row; column < 6; ++column)
      sums.squares[entry++] += dot (b.weighted[row], b.jacobian[column]);
    sums.gradient[row] += dot (b.weighted[row], b.distance);
  }
  for (int axis = 0; axis < 3; ++axis)
    sums.lever[axis] += dot (b.robust, b.lever[axis]);
  sums.squared_lever += dot (b.robust, b.squared_lever);
  sums.robust_weight += sum (b.robust);
  sums.weight += sum (b.weight);
  sums.inlier_weight += sum (b.inlier);
  sums.points += sum (b.known);
  Row squares;
  for (int n = 0; n < block_points; ++n)
    squares[n] = b.distance[n] * b.distance[n];
  sums.squared_distance += dot (b.weight, squares);
}

/** \brief What \a count points cost, and how much that is for those that had a distance before. */
PCL_COSECTION_MULTIVERSION void
compare (const Block& b, float huber, int count, const float* __restrict weight_before,
         const float* __restrict cost_before, float* __restrict weight_now, float* __restrict cost_now,
         ResidualSums& sums)
{
  Row weight = {}, before = {}, now = {};
  for (int n = 0; n < count; ++n)
  {
    const float size = std::abs (b.distance[n]);
    const float cost = huberCost (size, huber);
    weight[n] = weight_before[n] * b.known[n];
    before[n] = cost_before[n];
    now[n] = cost;
    weight_now[n] = b.weight[n];
    cost_now[n] = cost;
  }
  sums.common_weight += sum (weight);
  sums.cost_before += dot (weight, before);
  sums.cost += dot (weight, now);
}

} // namespace

ResidualSums&
ResidualSums::operator+= (const ResidualSums& other)
{
  for (std::size_t n = 0; n < squares.size (); ++n)
    squares[n] += other.squares[n];
  for (std::size_t n = 0; n < gradient.size (); ++n)
    gradient[n] += other.gradient[n];
  for (std::size_t n = 0; n < lever.size (); ++n)
    lever[n] += other.lever[n];
  squared_lever += other.squared_lever;
  robust_weight += other.robust_weight;
  weight += other.weight;
  squared_distance += other.squared_distance;
  inlier_weight += other.inlier_weight;
  points += other.points;
  common_weight += other.common_weight;
  cost_before += other.cost_before;
  cost += other.cost;
  return *this;
}

ResidualSums
SdfResiduals::evaluate (const PointLevels& points, std::size_t count, const SampledVolume& volume,
                        const Eigen::Isometry3d& T_grid_sensor, const RobustWeights& robust, int threads,
                        const PointCosts& before, PointCosts& now)
{
  constexpr std::size_t stride = static_cast<std::size_t> (block_points) * blocks_per_sum;
  const VoxelMap map (volume, T_grid_sensor);
  blocks_.assign ((count + stride - 1) / stride, ResidualSums ());
  parallelChunks (0, static_cast<int> (blocks_.size ()), threadsForVoxels (threads, count), [&] (int first, int last) {
    Block block;
    Row x, y, z, weight;
    for (int s = first; s < last; ++s)
      for (std::size_t begin = s * stride; begin < std::min (count, (s + 1) * stride); begin += block_points)
      {
        const int size = static_cast<int> (std::min<std::size_t> (block_points, count - begin));
        const auto padded = [&] (const std::vector<float>& from, Row& row) -> const float* {
          if (size == block_points)
            return from.data () + begin;
          std::copy_n (from.data () + begin, size, row);
          std::fill (row + size, row + block_points, 0.0f);
          return row;
        };
        const float* of_points = padded (points.weight, weight);
        locate (map, padded (points.x, x), padded (points.y, y), padded (points.z, z), block);
        fetch (volume, map, block);
        linearise (map, robust, of_points, block);
        accumulate (block, blocks_[s]);
        compare (block, robust.huber_m, size, before.weight.data () + begin, before.cost.data () + begin,
                 now.weight.data () + begin, now.cost.data () + begin, blocks_[s]);
      }
  });
  ResidualSums total;
  for (const ResidualSums& sums : blocks_)
    total += sums;
  return total;
}

} // namespace pcl::cosection
