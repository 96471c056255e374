// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "imls_data_term.h"

#include "pcl_cosection/common/multiversion.h"
#include "splat_tile.h"

#include "pcl_cosection/common/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace pcl::cosection {
namespace {

constexpr int max_reach = 64; // values of the Gaussian along one axis: 2 * 3 sigma + 1, sigma <= 10

/** \brief A point in voxel coordinates. */
struct Splat
{
  float x, y, z;
  float nx, ny, nz;
  float weight;
};

/** \brief exp (-(n / sigma)^2) for whole n. */
struct GaussianTable
{
  std::array<float, max_reach> values;

  explicit GaussianTable (float inverse_sigma)
  {
    for (int n = 0; n < max_reach; ++n)
      values[n] = std::exp (-static_cast<float> (n * n) * inverse_sigma * inverse_sigma);
  }
};

constexpr int lanes = 8; // a row at the usual sigma of one voxel, padded
using Lanes = float __attribute__ ((vector_size (lanes * sizeof (float)), aligned (4), may_alias));
using IntegerLanes = std::int32_t __attribute__ ((vector_size (lanes * sizeof (std::int32_t)), aligned (4), may_alias));

/** \brief Replace x by exp (x), to about float precision; |x| is clamped to 87. With n the whole number next
 * to x / log 2, exp (x) = 2^n exp (x - n log 2), the latter by its Taylor series. */
PCL_COSECTION_INLINE void
exponentiate (Lanes& x)
{
  constexpr float largest = 87.0f;
  x = x < -largest ? x - x - largest : x;
  x = x > largest ? x - x + largest : x;
  constexpr float whole_bits = 12582912.0f;  // 1.5 * 2^23: adding it leaves the whole part in the last bits
  constexpr float log_2_high = 0.693359375f; // has few digits: its product with n is exact
  constexpr float log_2_low = static_cast<float> (0.69314718055994530942 - 0.693359375);
  const Lanes shifted = x * 1.44269504f + whole_bits;
  const Lanes n = shifted - whole_bits;
  const Lanes r = (x - n * log_2_high) - n * log_2_low;
  Lanes sum = r * (1.0f / 5040.0f) + 1.0f / 720.0f;
  sum = sum * r + 1.0f / 120.0f;
  sum = sum * r + 1.0f / 24.0f;
  sum = sum * r + 1.0f / 6.0f;
  sum = sum * r + 0.5f;
  sum = sum * r + 1.0f;
  sum = sum * r + 1.0f;
  const auto bits = reinterpret_cast<const IntegerLanes&> (shifted);
  const IntegerLanes power = (bits - 0x4b400000 + 127) << 23; // the bits of 2^n
  x = sum * reinterpret_cast<const Lanes&> (power);
}

/** \brief The voxels of one axis within the cutoff of a point, and the factors of its Gaussian there. */
struct Reach
{
  float position = 0.0f;
  int first = 0;
  int last = -1;
  int begin = 0;
  int size = 0;
  std::array<float, max_reach> distance;
  std::array<float, max_reach> gaussian;

  /** \brief Find the voxels within the cutoff, on an unbounded axis. */
  PCL_COSECTION_INLINE void find (float at, float radius)
  {
    position = at;
    first = static_cast<int> (std::ceil (position - radius));
    last = static_cast<int> (std::floor (position + radius));
  }

  /** \brief Compute the factors of the voxels in [low, high). With s = 1 / sigma,
   *     exp (-s^2 (d + n)^2) = exp (-s^2 d^2) exp (-2 s^2 d)^n exp (-s^2 n^2);
   * \a g and \a ratio are the first two exponentials for the first voxel. */
  PCL_COSECTION_INLINE void set (float g, float ratio, const GaussianTable& table, int low, int high)
  {
    begin = std::max (low, first);
    const int end = std::min (high, last + 1);
    size = std::max (0, end - begin);
    const float d = static_cast<float> (first) - position;
    for (int n = 0; n < end - first; ++n)
    {
      // The recursion includes clipped voxels, so that the values do not depend on the clipping.
      if (n >= begin - first)
      {
        distance[n - (begin - first)] = d + static_cast<float> (n);
        gaussian[n - (begin - first)] = g * table.values[n];
      }
      g *= ratio;
    }
  }

  /** \brief Pad it to \a count entries, with factors of 0. */
  PCL_COSECTION_INLINE void pad (int count)
  {
    for (int i = size; i < count; ++i)
    {
      distance[i] = 1e6f;
      gaussian[i] = 0.0f;
    }
  }
};

PCL_COSECTION_INLINE void
splatRow (const Splat& p, const Reach& along_x, float across, float offset, float limit, int size,
          float* __restrict weight, float* __restrict target, float* __restrict count)
{
  for (int i = 0; i < size; ++i)
  {
    const float dx = along_x.distance[i];
    const float inside = dx * dx <= limit ? 1.0f : 0.0f;
    const float w = inside * across * along_x.gaussian[i];
    weight[i] += w;
    target[i] += w * (p.nx * dx + offset);
    count[i] += inside;
  }
}

/** \brief splatRow () for rows of up to eight voxels, with the row's constants in registers. */
struct RowOfLanes
{
  Lanes distance;
  Lanes squared;
  Lanes gaussian;
  Lanes along_normal;

  PCL_COSECTION_INLINE
  RowOfLanes (const Splat& p, const Reach& along_x)
      : distance (*reinterpret_cast<const Lanes*> (along_x.distance.data ()))
      , squared (distance * distance)
      , gaussian (*reinterpret_cast<const Lanes*> (along_x.gaussian.data ()))
      , along_normal (distance * p.nx)
  {}

  PCL_COSECTION_INLINE void add (float across, float offset, float limit, float* weight, float* target,
                                 float* count) const
  {
    const Lanes zero = distance - distance;
    const Lanes inside = squared <= limit ? zero + 1.0f : zero;
    const Lanes w = inside * gaussian * across;
    *reinterpret_cast<Lanes*> (weight) += w;
    *reinterpret_cast<Lanes*> (target) += w * (along_normal + offset);
    *reinterpret_cast<Lanes*> (count) += inside;
  }
};

/** \brief Add the points of one strip of the volume, in order of their planes. */
PCL_COSECTION_MULTIVERSION void
splat (const Splat* points, int number, float sigma, const SplatTarget& to, SplatTile& tile)
{
  const float radius = static_cast<float> (cutoff_sigmas) * sigma;
  const float inverse_sigma = 1.0f / sigma;
  const float s2 = inverse_sigma * inverse_sigma;
  const int reach = static_cast<int> (std::ceil (radius));
  const GaussianTable table (inverse_sigma);
  const std::size_t row_stride = tile.rowStride ();
  const std::size_t array_stride = tile.arrayStride ();
  Reach x, y, z;
  for (int n = 0; n < number; ++n)
  {
    const Splat& p = points[n];
    x.find (p.x, radius);
    y.find (p.y, radius);
    z.find (p.z, radius);
    if (z.last < to.first_plane || z.first >= to.last_plane)
      continue;
    tile.finishBefore (static_cast<int> (std::floor (p.z)) - reach);
    const Lanes d{static_cast<float> (x.first) - p.x, static_cast<float> (y.first) - p.y,
                  static_cast<float> (z.first) - p.z};
    Lanes g = -s2 * d * d;
    Lanes ratio = -2.0f * s2 * d;
    exponentiate (g);
    exponentiate (ratio);
    x.set (g[0], ratio[0], table, 0, to.nx);
    y.set (g[1], ratio[1], table, 0, to.ny);
    z.set (g[2], ratio[2], table, to.first_plane, to.last_plane);
    if (x.size == 0 || y.size == 0)
      continue;
    const bool in_lanes = x.size <= lanes;
    x.pad (lanes);
    const RowOfLanes row_of_lanes (p, x);
    const std::uint16_t blocks = tile.blocks (x.begin, x.size);
    for (int k = 0; k < z.size; ++k)
    {
      tile.touch (z.begin + k, y.begin, y.size, blocks);
      float* weight = tile.plane (x.begin, z.begin + k) + y.begin * row_stride;
      for (int j = 0; j < y.size; ++j, weight += row_stride)
      {
        const float limit = radius * radius - z.distance[k] * z.distance[k] - y.distance[j] * y.distance[j];
        if (limit < 0.0f)
          continue;
        const float across = p.weight * z.gaussian[k] * y.gaussian[j];
        const float offset = p.ny * y.distance[j] + p.nz * z.distance[k];
        if (in_lanes)
          row_of_lanes.add (across, offset, limit, weight, weight + array_stride, weight + 2 * array_stride);
        else
          splatRow (p, x, across, offset, limit, x.size, weight, weight + array_stride, weight + 2 * array_stride);
      }
    }
  }
  tile.finishBefore (to.last_plane);
}

} // namespace

void
ImlsDataTerm::add (const VoxelGrid& grid, const std::vector<OrientedPoint>& points, double sigma_vox, int threads)
{
  weight.resize (grid.size (), 0.0f);
  weighted_target.resize (grid.size (), 0.0f);
  count.resize (grid.size (), 0.0f);

  // Points are sorted stably by strip, plane and row: each voxel then sees them in the same order whichever thread adds
  // them, and points that touch the same voxels follow each other.
  const double radius = cutoff_sigmas * sigma_vox;
  const int reach = static_cast<int> (std::ceil (radius));
  const int planes = grid.dims.z () + 2 * reach;
  const int rows = grid.dims.y () + 2 * reach;
  const int strips = (grid.dims.x () + 2 * reach - 1) / SplatTile::width + 1;
  std::vector<Splat> splats;
  std::vector<std::size_t> bin_of;
  splats.reserve (points.size ());
  bin_of.reserve (points.size ());
  const auto bin = [&] (int strip, int plane, int row) {
    return (static_cast<std::size_t> (strip) * planes + plane) * rows + row;
  };
  std::vector<int> begin (bin (strips, 0, 0) + 1, 0);
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d p = grid.toVoxel (point.position.cast<double> ());
    if (!p.allFinite () || !point.normal.allFinite () || !(point.weight > 0.0f))
      continue;
    if ((p.array () < -radius).any () || (p.array () > grid.dims.cast<double> ().array () - 1.0 + radius).any ())
      continue;
    splats.push_back ({static_cast<float> (p.x ()), static_cast<float> (p.y ()), static_cast<float> (p.z ()),
                       point.normal.x (), point.normal.y (), point.normal.z (), point.weight});
    const auto place = [&] (float position, int places) {
      return std::clamp (static_cast<int> (std::floor (position)) + reach, 0, places - 1);
    };
    const Splat& s = splats.back ();
    const int strip = place (s.x, grid.dims.x () + 2 * reach) / SplatTile::width;
    bin_of.push_back (bin (strip, place (s.z, planes), place (s.y, rows)));
    ++begin[bin_of.back () + 1];
  }
  std::partial_sum (begin.begin (), begin.end (), begin.begin ());
  std::vector<Splat> sorted (splats.size ());
  std::vector<int> next (begin.begin (), begin.end () - 1);
  for (std::size_t n = 0; n < splats.size (); ++n)
    sorted[next[bin_of[n]]++] = splats[n];

  parallelChunks (0, grid.dims.z (), threads, [&] (int first, int last) {
    const SplatTarget target{
        weight.data (), weighted_target.data (), count.data (), grid.dims.x (), grid.dims.y (), first, last};
    SplatTile tile (target, reach);
    for (int strip = 0; strip < strips; ++strip)
    {
      const int low = begin[bin (strip, std::max (0, first - 1), 0)]; // floor (z) >= first - reach - 1
      const int high = begin[bin (strip, std::min (planes, last + 2 * reach), 0)];
      if (low == high)
        continue;
      tile.start (strip);
      splat (sorted.data () + low, high - low, static_cast<float> (sigma_vox), target, tile);
    }
  });
}

void
ImlsDataTerm::average (Weighting weighting, std::vector<float>& averaged_weight, std::vector<float>& averaged_target,
                       int threads) const
{
  averaged_weight.resize (weight.size ());
  averaged_target.resize (weight.size ());
  constexpr std::size_t block = 4096;
  parallelFor (0, static_cast<int> ((weight.size () + block - 1) / block), threads, [&] (int b) {
    for (std::size_t n = b * block; n < std::min (weight.size (), (b + 1) * block); ++n)
    {
      const float scale = weighting == Weighting::Mean && count[n] > 0.0f ? 1.0f / count[n] : 1.0f;
      averaged_weight[n] = scale * weight[n];
      averaged_target[n] = scale * weighted_target[n];
    }
  });
}

void
ImlsDataTerm::finish (Weighting weighting)
{
  average (weighting, weight, weighted_target);
  count.clear ();
  count.shrink_to_fit ();
}

} // namespace pcl::cosection
