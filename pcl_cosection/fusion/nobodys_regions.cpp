// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "nobodys_regions.h"

#include "../common/disjoint_sets.h"
#include "frame_segmentation.h"

namespace pcl
{
namespace cosection
{

namespace
{

constexpr double cut_share = 0.25; // of the root of its pixels
constexpr int cut_margin_px = 12;  // from the border of what is seen, where surfaces have no normals and belong to no instance

/** \brief Call f (pixels of a line, from one end on) for the ends of what is seen in all rows and columns. */
template <typename Function> void
forEnds (const FrameCloud& cloud, Function&& f)
{
  const int width = cloud.camera.width;
  const int height = cloud.camera.height;
  const auto ends = [&] (int lines, int length, auto&& pixelOf) {
    std::vector<std::size_t> end;
    for (int line = 0; line < lines; ++line)
      for (const bool forward : {true, false})
      {
        end.clear ();
        for (int n = 0; n < length && (end.empty () || static_cast<int> (end.size ()) < cut_margin_px); ++n)
        {
          const std::size_t pixel = pixelOf (line, forward ? n : length - 1 - n);
          if (!end.empty () || std::isfinite (cloud.depth.pixels[pixel]))
            end.push_back (pixel);
        }
        f (end);
      }
  };
  ends (height, width, [&] (int v, int u) { return static_cast<std::size_t> (v) * width + u; });
  ends (width, height, [&] (int u, int v) { return static_cast<std::size_t> (v) * width + u; });
}

bool
isCut (std::size_t ends, std::size_t pixels)
{
  return static_cast<double> (ends) > cut_share * std::sqrt (static_cast<double> (pixels));
}

} // namespace

NobodysRegions
findNobodysRegions (const std::vector<bool>& nobodys, const FrameCloud& cloud)
{
  DisjointSets sets (nobodys.size ());
  forNeighbours (cloud, [&] (std::size_t a, std::size_t b) {
    if (nobodys[a] && nobodys[b])
      sets.unite (a, b);
  });
  NobodysRegions regions;
  regions.of_pixel.assign (nobodys.size (), NobodysRegions::none);
  for (std::size_t n = 0; n < nobodys.size (); ++n)
  {
    if (!nobodys[n])
      continue;
    const std::size_t root = sets.find (n); // the first of its region
    if (root == n)
    {
      regions.of_pixel[n] = static_cast<int> (regions.pixels.size ());
      regions.pixels.push_back (0);
    }
    regions.of_pixel[n] = regions.of_pixel[root];
    ++regions.pixels[regions.of_pixel[n]];
  }
  std::vector<std::size_t> ends (regions.pixels.size (), 0);
  forEnds (cloud, [&] (const std::vector<std::size_t>& end) {
    for (const std::size_t pixel : end)
      if (regions.of_pixel[pixel] != NobodysRegions::none)
      {
        ++ends[regions.of_pixel[pixel]];
        return;
      }
  });
  for (std::size_t region = 0; region < ends.size (); ++region)
    regions.cut.push_back (isCut (ends[region], regions.pixels[region]));
  return regions;
}

std::set<std::uint16_t>
cutInstances (const Image<std::uint16_t>& mask, const FrameCloud& cloud)
{
  std::vector<std::size_t> pixels (FrameSegmentation::unassigned + 1, 0);
  for (const std::uint16_t instance : mask.pixels)
    ++pixels[instance];
  std::vector<std::size_t> ends (pixels.size (), 0);
  forEnds (cloud, [&] (const std::vector<std::size_t>& end) {
    for (const std::size_t pixel : end)
      if (const std::uint16_t instance = mask.pixels[pixel]; instance != 0 && instance != FrameSegmentation::unassigned)
      {
        ++ends[instance];
        return;
      }
  });
  std::set<std::uint16_t> cut;
  for (std::size_t instance = 1; instance < FrameSegmentation::unassigned; ++instance)
    if (isCut (ends[instance], pixels[instance]))
      cut.insert (static_cast<std::uint16_t> (instance));
  return cut;
}

} // namespace cosection
} // namespace pcl
