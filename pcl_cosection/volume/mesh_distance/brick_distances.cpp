// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "brick_distances.h"

#include "pcl_cosection/common/multiversion.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

/** \brief Each byte or that before or behind it by \a stride; \a count of them, in lines of \a length. */
PCL_COSECTION_MULTIVERSION void
dilate (const std::uint8_t* __restrict bytes, std::size_t count, std::size_t length, std::size_t stride,
        std::uint8_t* __restrict dilated)
{
  const std::size_t line = length * stride;
  for (std::size_t begin = 0; begin < count; begin += line)
  {
    const std::uint8_t* from = bytes + begin;
    std::uint8_t* to = dilated + begin;
    std::copy_n (from, line, to);
    for (std::size_t i = stride; i < line; ++i)
      to[i] |= from[i - stride];
    for (std::size_t i = stride; i < line; ++i)
      to[i - stride] |= from[i];
  }
}

} // namespace

std::vector<std::uint8_t>
brickDistances (std::vector<std::uint8_t> marked, const Eigen::Vector3i& dims, int max_distance)
{
  const std::size_t nx = dims.x ();
  const std::size_t ny = dims.y ();
  const std::size_t nz = dims.z ();
  std::vector<std::uint8_t> distances (marked.size ());
  std::vector<std::uint8_t> other (marked.size ());
  for (int distance = 0;; ++distance)
  {
    for (std::size_t b = 0; b < marked.size (); ++b)
      distances[b] += !marked[b];
    if (distance + 1 == max_distance)
      return distances;
    dilate (marked.data (), marked.size (), nx, 1, other.data ());
    dilate (other.data (), marked.size (), ny, nx, marked.data ());
    dilate (marked.data (), marked.size (), nz, nx * ny, other.data ());
    marked.swap (other);
  }
}

} // namespace pcl::cosection
