// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "piece_outline.h"

#include <utility>

namespace pcl::cosection {
namespace {

constexpr int shadow_share = 16;       ///< share of the image's width that the shadow beside a thing may have
constexpr float contact_sigmas = 3.0f; ///< height over a surface of what touches it ...
constexpr float contact_px = 1.5f;     ///< ... and the width of so many pixels

constexpr int least_run_px = 3; ///< readings of both in a row; where they alternate there is no outline

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
  const auto sideOf = [&] (int i) { return (std::make_pair (piece_of[i], piece_of[i] < 0 ? room.surface_of[i] : -1)); };
  const auto follow = [&] (int first, int stride, int steps, int) {
    int begin = -1, last = -1, length = 0, before = -1; // of the run; last of the run before, if it is long enough
    for (int k = 0; k < steps; ++k)
    {
      const int i = first + k * stride;
      if (!grid.valid (i))
        continue;
      if (last < 0 || sideOf (i) != sideOf (first + last * stride))
      {
        before = length >= least_run_px ? last : -1;
        begin = k;
        length = 0;
      }
      last = k;
      if (++length == least_run_px && before >= 0 && begin - before <= grid.width / shadow_share)
      {
        meet (first + begin * stride, first + before * stride);
        meet (first + before * stride, first + begin * stride);
      }
    }
  };
  forEachLine (grid, follow);
  return (outlines);
}

} // namespace pcl::cosection
