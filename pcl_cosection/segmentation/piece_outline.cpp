// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "piece_outline.h"

namespace pcl
{
namespace cosection
{

namespace
{

constexpr int shadow_share = 16;       ///< share of the image's width that the shadow beside a thing may have
constexpr float contact_sigmas = 3.0f; ///< height over a surface of what touches it ...
constexpr float contact_px = 1.5f;     ///< ... and the width of so many pixels

} // namespace

std::vector<PieceOutline>
outlinePieces (const DepthGrid& grid, const Room& room, const std::vector<int>& piece_of, std::size_t pieces)
{
  std::vector<PieceOutline> outlines (pieces);
  const auto meet = [&] (int i, int j) {
    if (piece_of[i] < 0 || piece_of[j] >= 0)
      return;
    PieceOutline& outline = outlines[piece_of[i]];
    const float z = grid.points[i].z ();
    const float contact_m = contact_sigmas * grid.sigma (i) + contact_px * grid.pitch * z;
    if (room.surface_of[j] < 0)
      outline.free += grid.points[j].z () - z > contact_m;
    else
    {
      const float height = room.surfaces[room.surface_of[j]].height (grid.points[i]);
      if (height > contact_m)
        ++outline.free;
      else if (std::abs (grid.points[j].z () - z) < 4.0f * contact_m)
      {
        ++outline.held;
        outline.edge += height < -0.3f * contact_m;
      }
    }
  };
  const auto follow = [&] (int first, int stride, int steps) {
    int last = -1;
    for (int k = 0; k < steps; ++k)
    {
      const int i = first + k * stride;
      if (!grid.valid (i))
        continue;
      if (last >= 0 && k - last <= grid.width / shadow_share)
      {
        meet (i, first + last * stride);
        meet (first + last * stride, i);
      }
      last = k;
    }
  };
  for (int v = 0; v < grid.height; ++v)
    follow (v * grid.width, 1, grid.width);
  for (int u = 0; u < grid.width; ++u)
    follow (u, grid.width, grid.height);
  return (outlines);
}

} // namespace cosection
} // namespace pcl
