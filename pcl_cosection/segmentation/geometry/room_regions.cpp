// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "room_regions.h"

#include "pcl_cosection/common/convex_hull.h"
#include "pcl_cosection/common/parallel.h"
#include "plane_regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

namespace pcl::cosection {
namespace {

// Largest free share of the border of an enclosed region, relative to where it meets room.
constexpr float enclosed_share = 0.25f;
constexpr float hidden_share = 0.15f;    ///< or relative to all that is before it
constexpr float continued_share = 0.25f; ///< of the border of a remainder of the room, on the same plane
constexpr float edge_share = 0.25f;      ///< of the border of what begins at an edge of the room
constexpr int min_enclosed_px = 60;      ///< less does not show how it ends

constexpr float own_block = 0.25f;  ///< weight of the distance from the plane that a block was found on
constexpr float far_sigmas = 7.0f;  ///< farther than any reading of a plane, with the sensor's distortion
constexpr float same_normal = 0.9f; ///< cosine between a plane's normal and those of pixels it spreads to
constexpr std::array<std::array<int, 2>, 4> neighbours{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

constexpr int bridge_px = 4;           ///< from a patch to a surface that it touches
constexpr float edge_cosine = 0.7f;    ///< between the normals on both sides of an edge
constexpr float behind_sigmas = 1.0f;  ///< how far behind the surface the middle of such a patch is
constexpr float contact_share = 0.15f; ///< of the outline of a patch of that many pixels that is such an edge
constexpr int remainder_px = 60;       ///< a smaller patch on the same plane beside such an edge is a part of it

/** \brief Which of the planes of a view each pixel lies on. */
class PlaneLabelling
{
public:
  PlaneLabelling (const DepthGrid& grid, float max_object_size_m, float min_area_m2, int threads)
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

  /** \brief Give the pixels without a plane to the one that fits them best: of those with blocks that are together
   * longer than an object, which go on through the whole image; with \a small also of the others, which go on only as
   * far as they are connected to where they were found. */
  void label (bool small)
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

  /** \brief Take away the pixels that are not \a kept. */
  void withdraw (const std::vector<char>& kept)
  {
    for (std::size_t i = 0; i < surface_of_.size (); ++i)
      if (!kept[i])
        surface_of_[i] = -1;
  }

  const std::vector<SupportSurface>& surfaces () const { return (surfaces_); }

  /** \brief One per pixel: its plane, -1 for none. */
  const std::vector<int>& surfaceOf () const { return (surface_of_); }

private:
  void spread ()
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

  const DepthGrid& grid_;
  const int threads_;
  int blocks_across_ = 0;
  std::vector<SupportSurface> surfaces_;
  std::vector<char> large_;
  std::vector<std::vector<char>> near_; ///< one per block, of small planes: 2 its own, 1 beside one
  std::vector<int> surface_of_;
};

/** \brief Whether a region is a remainder of the room, or enclosed by it. */
bool
isEnclosed (const PlaneRegion& region, const std::vector<char>& is_room)
{
  float by_room = 0.0f, before = 0.0f, continued = 0.0f, edge = 0.0f;
  for (const auto& [other, length] : region.before_m)
  {
    before += length;
    by_room += other >= 0 && is_room[other] ? length : 0.0f;
  }
  for (const auto& [other, length] : region.continued_m)
    continued += is_room[other] ? length : 0.0f;
  for (const auto& [other, length] : region.edge_m)
    edge += is_room[other] ? length : 0.0f;
  by_room += continued;
  before += continued;
  if (edge > edge_share * region.border_m ||
      (continued > continued_share * region.border_m && region.free_m <= by_room))
    return (true);
  return (region.pixels >= min_enclosed_px && (region.free_m < enclosed_share * (region.free_m + by_room) ||
                                               region.free_m < hidden_share * (region.free_m + before)));
}

/** \brief Add regions that the others enclose, until there are none. */
void
enclose (const std::vector<PlaneRegion>& regions, std::vector<char>& is_room)
{
  for (bool more = true; more;)
  {
    const std::vector<char> before = is_room;
    for (std::size_t k = 0; k < regions.size (); ++k)
      if (!before[k] && isEnclosed (regions[k], before))
        is_room[k] = 1;
    more = is_room != before;
  }
}

/** \brief The surfaces that have room, best seen first, as far as it reaches. */
Room
describeRoom (const DepthGrid& grid, const PlaneLabelling& labelling, const PlaneRegions& planes,
              const std::vector<char>& is_room)
{
  Room room;
  room.surface_of.assign (grid.points.size (), -1);
  std::vector<std::vector<Eigen::Vector2f>> feet (labelling.surfaces ().size ());
  std::vector<float> area (feet.size (), 0.0f);
  for (std::size_t k = 0; k < is_room.size (); ++k)
    area[planes.regions[k].surface] += is_room[k] ? planes.regions[k].area_m2 : 0.0f;
  for (std::size_t i = 0; i < grid.points.size (); ++i)
    if (planes.region_of[i] >= 0 && is_room[planes.region_of[i]])
    {
      room.surface_of[i] = labelling.surfaceOf ()[i];
      feet[room.surface_of[i]].push_back (labelling.surfaces ()[room.surface_of[i]].place (grid.points[i]));
    }
  std::vector<int> order;
  for (std::size_t k = 0; k < feet.size (); ++k)
    if (feet[k].size () >= 3)
      order.push_back (static_cast<int> (k));
  std::stable_sort (order.begin (), order.end (), [&] (int a, int b) { return (area[a] > area[b]); });
  std::vector<int> number (feet.size (), -1);
  for (const int k : order)
  {
    number[k] = static_cast<int> (room.surfaces.size ());
    room.surfaces.push_back (labelling.surfaces ()[k]);
    room.surfaces.back ().area_m2 = area[k];
    room.surfaces.back ().outline = convexHull (std::move (feet[k]));
  }
  for (int& surface : room.surface_of)
    surface = surface < 0 ? -1 : number[surface];
  return (room);
}

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

Room
findRoom (const DepthGrid& grid, float max_object_size_m, float min_area_m2, int threads)
{
  if (findSupportSurfaces (grid, max_object_size_m, min_area_m2).empty ())
    return {{}, std::vector<int> (grid.points.size (), -1)};
  PlaneLabelling labelling (grid, max_object_size_m, min_area_m2, threads);
  labelling.label (false);
  PlaneRegions planes = dividePlanes (grid, labelling.surfaces (), labelling.surfaceOf (), max_object_size_m);
  std::vector<char> kept (grid.points.size (), 0);
  for (std::size_t i = 0; i < kept.size (); ++i)
    kept[i] = planes.region_of[i] >= 0 && planes.regions[planes.region_of[i]].length_m > max_object_size_m;
  labelling.withdraw (kept);

  labelling.label (true);
  planes = dividePlanes (grid, labelling.surfaces (), labelling.surfaceOf (), max_object_size_m);
  std::vector<int> long_px (planes.regions.size (), 0);
  for (std::size_t i = 0; i < kept.size (); ++i)
    if (kept[i] && planes.region_of[i] >= 0)
      ++long_px[planes.region_of[i]];
  std::vector<char> is_room (planes.regions.size (), 0);
  std::size_t largest = 0;
  for (std::size_t k = 0; k < is_room.size (); ++k)
  {
    is_room[k] = planes.regions[k].length_m > max_object_size_m || 2 * long_px[k] > planes.regions[k].pixels;
    largest = planes.regions[k].area_m2 > planes.regions[largest].area_m2 ? k : largest;
  }
  if (!is_room.empty () && planes.regions[largest].area_m2 >= min_area_m2)
    is_room[largest] = 1;
  enclose (planes.regions, is_room);
  return (describeRoom (grid, labelling, planes, is_room));
}

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
  forEachLine (grid, [&] (int first, int stride, int steps, int) {
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
  });

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

} // namespace pcl::cosection
