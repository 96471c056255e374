// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include <pcl/cosection/surface/imls_data_term.h>

#include "../common/multiversion.h"

#include <pcl/cosection/common/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pcl
{
namespace cosection
{

namespace
{

constexpr double cutoff_sigmas = 3.0;
constexpr int max_reach = 64; // values of the Gaussian along one axis: 2 * 3 sigma + 1, sigma <= 10

/** \brief Where the sums go, and the planes that the calling thread may touch. */
struct Target
{
  float* weight;
  float* weighted_target;
  float* count;
  int nx, ny;
  int first_plane, last_plane;
};

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

/** \brief The part of an axis that a point reaches. */
struct Reach
{
  int begin = 0;
  int size = 0;
  std::array<float, max_reach> distance;
  std::array<float, max_reach> gaussian;

  /** \brief With s = 1 / sigma, exp (-s^2 (d + n)^2) = exp (-s^2 d^2) exp (-2 s^2 d)^n exp (-s^2 n^2). */
  PCL_COSECTION_INLINE void
  set (float position, float radius, float inverse_sigma, const GaussianTable& table, int low, int high)
  {
    const int first = static_cast<int> (std::ceil (position - radius));
    begin = std::max (low, first);
    const int end = std::min (high, static_cast<int> (std::floor (position + radius)) + 1);
    size = std::max (0, end - begin);
    const float s2 = inverse_sigma * inverse_sigma;
    const float d = static_cast<float> (first) - position;
    const float ratio = std::exp (-2.0f * s2 * d);
    float g = std::exp (-s2 * d * d);
    for (int n = 0; n < end - first; ++n)
    {
      // Also through the part that is cut off, so that the values do not depend on where the cut is.
      if (n >= begin - first)
      {
        distance[n - (begin - first)] = d + static_cast<float> (n);
        gaussian[n - (begin - first)] = g * table.values[n];
      }
      g *= ratio;
    }
  }

  /** \brief Make it \a count long with entries that nothing reaches. */
  PCL_COSECTION_INLINE void
  pad (int count)
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

constexpr int lanes = 8; // a row at the usual sigma of one voxel, padded
using Lanes = float __attribute__ ((vector_size (lanes * sizeof (float)), aligned (4), may_alias));

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

  PCL_COSECTION_INLINE void
  add (float across, float offset, float limit, float* weight, float* target, float* count) const
  {
    const Lanes zero = distance - distance;
    const Lanes inside = squared <= limit ? zero + 1.0f : zero;
    const Lanes w = inside * gaussian * across;
    *reinterpret_cast<Lanes*> (weight) += w;
    *reinterpret_cast<Lanes*> (target) += w * (along_normal + offset);
    *reinterpret_cast<Lanes*> (count) += inside;
  }
};

PCL_COSECTION_MULTIVERSION void
splat (const Splat* points, const int* order, int number, float sigma, const Target& to, int nz)
{
  const float radius = static_cast<float> (cutoff_sigmas) * sigma;
  const float inverse_sigma = 1.0f / sigma;
  const int first = std::max (0, to.first_plane);
  const int last = std::min (nz, to.last_plane);
  const GaussianTable table (inverse_sigma);
  Reach x, y, z;
  for (int n = 0; n < number; ++n)
  {
    const Splat& p = points[order[n]];
    z.set (p.z, radius, inverse_sigma, table, first, last);
    if (z.size == 0)
      continue;
    x.set (p.x, radius, inverse_sigma, table, 0, to.nx);
    y.set (p.y, radius, inverse_sigma, table, 0, to.ny);
    const bool in_lanes = x.size <= lanes && x.begin + lanes <= to.nx;
    x.pad (lanes);
    const RowOfLanes row_of_lanes (p, x);
    for (int k = 0; k < z.size; ++k)
      for (int j = 0; j < y.size; ++j)
      {
        const float limit = radius * radius - z.distance[k] * z.distance[k] - y.distance[j] * y.distance[j];
        if (limit < 0.0f)
          continue;
        const float across = p.weight * z.gaussian[k] * y.gaussian[j];
        const float offset = p.ny * y.distance[j] + p.nz * z.distance[k];
        const std::size_t row = (static_cast<std::size_t> (z.begin + k) * to.ny + (y.begin + j)) * to.nx + x.begin;
        float* weight = to.weight + row;
        float* target = to.weighted_target + row;
        float* count = to.count + row;
        if (in_lanes)
          row_of_lanes.add (across, offset, limit, weight, target, count);
        else
          splatRow (p, x, across, offset, limit, x.size, weight, target, count);
      }
  }
}

} // namespace

void
ImlsDataTerm::add (const VoxelGrid& grid, const std::vector<OrientedPoint>& points, double sigma_vox, int threads)
{
  weight.resize (grid.size (), 0.0f);
  weighted_target.resize (grid.size (), 0.0f);
  count.resize (grid.size (), 0.0f);

  // Points sorted by plane, stably: each voxel then sees them in one order whoever adds them.
  const double radius = cutoff_sigmas * sigma_vox;
  const int reach = static_cast<int> (std::ceil (radius));
  const int planes = grid.dims.z () + 2 * reach;
  std::vector<Splat> splats;
  std::vector<int> plane_of;
  splats.reserve (points.size ());
  plane_of.reserve (points.size ());
  std::vector<int> begin (planes + 1, 0);
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d p = grid.toVoxel (point.position.cast<double> ());
    if (!p.allFinite () || !point.normal.allFinite () || !(point.weight > 0.0f))
      continue;
    if ((p.array () < -radius).any () || (p.array () > grid.dims.cast<double> ().array () - 1.0 + radius).any ())
      continue;
    splats.push_back ({static_cast<float> (p.x ()), static_cast<float> (p.y ()), static_cast<float> (p.z ()),
                       point.normal.x (), point.normal.y (), point.normal.z (), point.weight});
    plane_of.push_back (std::clamp (static_cast<int> (std::floor (p.z ())) + reach, 0, planes - 1));
    ++begin[plane_of.back () + 1];
  }
  for (int k = 0; k < planes; ++k)
    begin[k + 1] += begin[k];
  std::vector<int> order (splats.size ());
  std::vector<int> next (begin.begin (), begin.end () - 1);
  for (std::size_t n = 0; n < splats.size (); ++n)
    order[next[plane_of[n]]++] = static_cast<int> (n);

  parallelChunks (0, grid.dims.z (), threads, [&] (int first, int last) {
    const int low = begin[std::max (0, first - 1)]; // floor (z) >= first - reach - 1
    const int high = begin[std::min (planes, last + 2 * reach)];
    const Target target{weight.data (), weighted_target.data (), count.data (), grid.dims.x (), grid.dims.y (), first, last};
    splat (splats.data (), order.data () + low, high - low, static_cast<float> (sigma_vox), target, grid.dims.z ());
  });
}

void
ImlsDataTerm::finish (Weighting weighting)
{
  if (weighting == Weighting::Mean)
    for (std::size_t n = 0; n < count.size (); ++n)
      if (count[n] > 0.0f)
      {
        const float scale = 1.0f / count[n];
        weight[n] *= scale;
        weighted_target[n] *= scale;
      }
  count.clear ();
  count.shrink_to_fit ();
}

} // namespace cosection
} // namespace pcl
