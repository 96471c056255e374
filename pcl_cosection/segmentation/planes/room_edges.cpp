// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "room_edges.h"

#include <cmath>
#include <set>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr int bridge_px = 4;           ///< from a patch to a surface that it touches
constexpr float edge_cosine = 0.7f;    ///< between the normals on both sides of an edge
constexpr float behind_sigmas = 1.0f;  ///< how far behind the surface the middle of such a patch is
constexpr float contact_share = 0.15f; ///< of the outline of a patch of that many pixels that is such an edge
constexpr int remainder_px = 60;       ///< a smaller patch on the same plane beside such an edge is a part of it

/** \brief Whether two patches are on one plane. */
bool
continues (const PatchImage& image, int i, int j)
{
  const SurfacePatch& a = image.patches[i];
  const SurfacePatch& b = image.patches[j];
  const auto sigma = static_cast<float> (depthNoiseSigma (a.centre.z ()));
  return (a.normal.dot (b.normal) > 0.9f && std::abs (a.normal.dot (b.centre - a.centre)) < 2.0f * sigma);
}

} // namespace

std::vector<char>
findRoomEdges (const DepthGrid& grid, const Room& room, const PatchImage& image)
{
  std::vector<int> behind (image.patches.size (), 0), before (image.patches.size (), 0);
  std::set<std::pair<int, int>> neighbours;
  const auto meet = [&] (int i, int j, int steps) {
    const SurfacePatch& patch = image.patches[image.patch_of[i]];
    const SupportSurface& surface = room.surfaces[room.surface_of[j]];
    if (!grid.continuous (i, j, steps))
      return;
    const float height = surface.height (patch.centre);
    const bool edge = patch.normal.squaredNorm () > 0.0f && patch.normal.dot (surface.normal) < edge_cosine;
    ++(edge && height < -behind_sigmas * grid.sigma (i) ? behind : before)[image.patch_of[i]];
  };
  const auto follow = [&] (int first, int stride, int steps, int) {
    int last = -1;
    for (int k = 0; k < steps; ++k)
    {
      const int i = first + k * stride;
      const bool patch = image.patch_of[i] >= 0, surface = room.surface_of[i] >= 0;
      if (!patch && !surface)
        continue;
      const int j = first + last * stride;
      if (last >= 0 && k - last <= bridge_px)
      {
        if (patch && image.patch_of[j] < 0)
          meet (i, j, k - last);
        else if (surface && image.patch_of[j] >= 0)
          meet (j, i, k - last);
        else if (patch && image.patch_of[i] != image.patch_of[j] &&
                 continues (image, image.patch_of[i], image.patch_of[j]))
          neighbours.insert (std::minmax (image.patch_of[i], image.patch_of[j]));
      }
      last = k;
    }
  };
  forEachLine (grid, follow);

  std::vector<char> edges (image.patches.size (), 0);
  for (std::size_t k = 0; k < edges.size (); ++k)
  {
    const float outline = 4.0f * std::sqrt (static_cast<float> (image.patches[k].pixels));
    edges[k] = behind[k] > before[k] && static_cast<float> (behind[k]) > contact_share * outline;
  }
  const std::vector<char> certain = edges;
  for (const auto& [a, b] : neighbours)
    for (const auto& [edge, other] : {std::make_pair (a, b), std::make_pair (b, a)})
      if (certain[edge] && before[other] == 0 && image.patches[other].pixels < remainder_px)
        edges[other] = 1;
  return (edges);
}

void
removePatches (PatchImage& image, const std::vector<char>& gone)
{
  std::vector<int> number (image.patches.size (), -1);
  std::vector<SurfacePatch> kept;
  for (std::size_t k = 0; k < gone.size (); ++k)
    if (!gone[k])
    {
      number[k] = static_cast<int> (kept.size ());
      kept.push_back (image.patches[k]);
    }
  for (int& patch : image.patch_of)
    patch = patch < 0 ? -1 : number[patch];
  image.patches = std::move (kept);
}

} // namespace pcl::cosection
