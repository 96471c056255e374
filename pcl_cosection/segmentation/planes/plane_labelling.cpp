// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "plane_labelling.h"

#include "planar_blocks.h"

#include "pcl_cosection/common/parallel.h"

#include <array>

namespace pcl::cosection {
namespace {

constexpr float own_block = 0.25f;  ///< weight of the distance from the plane that a block was found on
constexpr float far_sigmas = 7.0f;  ///< farther than any reading of a plane, with the sensor's distortion
constexpr float same_normal = 0.9f; ///< cosine between a plane's normal and those of pixels it spreads to
constexpr std::array<std::array<int, 2>, 4> neighbours{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

} // namespace

PlaneLabelling::PlaneLabelling (const DepthGrid& grid, float max_object_size_m, float min_area_m2, int threads)
    : grid_ (grid)
    , threads_ (threads)
    , surface_of_ (grid.points.size (), -1)
{
  const BlockImage image = findPlanarBlocks (grid, true);
  blocks_across_ = image.width;
  for (const PlaneProposal& plane : proposePlanes (image, max_object_size_m, min_area_m2))
  {
    surfaces_.push_back (makeSurface (grid, image, plane));
    large_.push_back (plane.large);
    near_.emplace_back (image.blocks.size (), 0);
    for (const int block : plane.blocks)
      for (int v = block / image.width - 1; v <= block / image.width + 1; ++v)
        for (int u = block % image.width - 1; u <= block % image.width + 1; ++u)
          if (u >= 0 && v >= 0 && u < image.width && v < image.height)
          {
            char& near = near_.back ()[v * image.width + u];
            near = std::max<char> (near, v * image.width + u == block ? 2 : 1);
          }
  }
}

void
PlaneLabelling::label (bool small)
{
  parallelFor (0, grid_.height, threads_, [&] (int v) {
    for (int u = 0; u < grid_.width; ++u)
    {
      const int i = v * grid_.width + u;
      if (!grid_.valid (i) || surface_of_[i] >= 0)
        continue;
      const int block = v / block_px * blocks_across_ + std::min (u / block_px, blocks_across_ - 1);
      float best = 1.0f;
      for (std::size_t k = 0; k < surfaces_.size (); ++k)
      {
        const int near = large_[k] ? 1 : small && block < static_cast<int> (near_[k].size ()) ? near_[k][block] : 0;
        if (near == 0 || std::abs (surfaces_[k].height (grid_.points[i])) > far_sigmas * grid_.sigma (i))
          continue;
        const float distance = surfaces_[k].distance (grid_, u, v);
        const float weighted = near > 1 && distance < 1.0f ? own_block * distance : distance;
        if (weighted < best)
        {
          best = weighted;
          surface_of_[i] = static_cast<int> (k);
        }
      }
    }
  });
  if (small)
    spread ();
}

void
PlaneLabelling::withdraw (const std::vector<char>& kept)
{
  for (std::size_t i = 0; i < surface_of_.size (); ++i)
    if (!kept[i])
      surface_of_[i] = -1;
}

void
PlaneLabelling::spread ()
{
  std::vector<int> front;
  for (int i = 0; i < static_cast<int> (surface_of_.size ()); ++i)
    if (surface_of_[i] >= 0 && !large_[surface_of_[i]])
      front.push_back (i);
  for (std::size_t n = 0; n < front.size (); ++n)
  {
    const int k = surface_of_[front[n]];
    for (const auto& [du, dv] : neighbours)
    {
      const int u = front[n] % grid_.width + du, v = front[n] / grid_.width + dv, j = v * grid_.width + u;
      if (u < 0 || v < 0 || u >= grid_.width || v >= grid_.height || surface_of_[j] >= 0 || !grid_.valid (j) ||
          (grid_.hasNormal (j) && grid_.normals[j].dot (surfaces_[k].normal) < same_normal) ||
          surfaces_[k].distance (grid_, u, v) >= 1.0f)
        continue;
      surface_of_[j] = k;
      front.push_back (j);
    }
  }
}

} // namespace pcl::cosection
