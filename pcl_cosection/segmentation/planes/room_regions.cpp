// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "room_regions.h"

#include "plane_labelling.h"
#include "plane_regions.h"

#include "pcl_cosection/common/convex_hull.h"

#include <algorithm>

namespace pcl::cosection {
namespace {

// Largest free share of the border of an enclosed region, relative to where it meets room.
constexpr float enclosed_share = 0.25f;
constexpr float hidden_share = 0.15f;    ///< or relative to all that is before it
constexpr float continued_share = 0.25f; ///< of the border of a remainder of the room, on the same plane
constexpr float edge_share = 0.25f;      ///< of the border of what begins at an edge of the room
constexpr int min_enclosed_px = 60;      ///< less does not show how it ends

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

} // namespace pcl::cosection
