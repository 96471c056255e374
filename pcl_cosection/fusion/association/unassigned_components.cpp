// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "unassigned_components.h"

#include "pcl_cosection/common/disjoint_sets.h"

#include <pcl/cosection/fusion/frame_segmenter.h>

namespace pcl::cosection {
namespace {

constexpr double cut_share = 0.25;    // pixels at the border, of the root of all pixels
constexpr double widest_margin = 0.1; // without readings, of the image: the sensor's own; a wider one is free space
constexpr double border_share = 0.25; // of a side, with readings
// From the border of the view, where surfaces have no normals and belong to no instance.
constexpr int cut_margin_px = 12;

/** \brief At how many pixels along the borders of the view each thing ends. Borders are sides of the smallest rectangle
 * with all readings, unless a side is that of things before a background without readings.
 * \param[in] thingOf (pixel): number of a thing, or a negative one; the first from the border inwards counts */
template <typename Number>
std::vector<std::size_t>
countEnds (const FrameCloud& cloud, std::size_t things, Number&& thingOf)
{
  std::vector<std::size_t> ends (things, 0);
  const int width = cloud.camera.width;
  const int height = cloud.camera.height;
  const auto isRead = [&] (int u, int v) { return std::isfinite (cloud.depth.at (u, v)); };
  Eigen::AlignedBox2i view; // with all readings
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      if (isRead (u, v))
        view.extend (Eigen::Vector2i (u, v));
  if (view.isEmpty () || view.sizes ().minCoeff () < 2 * cut_margin_px)
    return ends;
  const auto side = [&] (int from, int step, bool vertical) {
    const int size = vertical ? width : height;
    if ((step > 0 ? from : size - 1 - from) > widest_margin * size)
      return;
    const int first = view.min ()[vertical], last = view.max ()[vertical];
    int read = 0;
    for (int along = first; along <= last; ++along)
      read += vertical ? isRead (from + step * cut_margin_px / 2, along)
                       : isRead (along, from + step * cut_margin_px / 2);
    if (static_cast<double> (read) < border_share * (last - first + 1))
      return;
    for (int along = first; along <= last; ++along)
      for (int n = 0; n < cut_margin_px; ++n)
      {
        const int across = from + step * n;
        const int thing = thingOf (vertical ? along * width + across : across * width + along);
        if (thing < 0)
          continue;
        ++ends[thing];
        break;
      }
  };
  side (view.min ().x (), 1, true);
  side (view.max ().x (), -1, true);
  side (view.min ().y (), 1, false);
  side (view.max ().y (), -1, false);
  return ends;
}

bool
isCut (std::size_t ends, std::size_t pixels)
{
  return static_cast<double> (ends) > cut_share * std::sqrt (static_cast<double> (pixels));
}

} // namespace

UnassignedComponents
findUnassignedComponents (const std::vector<bool>& unassigned, const FrameCloud& cloud)
{
  DisjointSets sets (unassigned.size ());
  forNeighbours (cloud, [&] (std::size_t a, std::size_t b) {
    if (unassigned[a] && unassigned[b])
      sets.unite (a, b);
  });
  UnassignedComponents components;
  components.of_pixel = sets.numbers ([&] (std::size_t n) { return unassigned[n]; });
  for (const int component : components.of_pixel)
  {
    if (component == UnassignedComponents::none)
      continue;
    if (component == static_cast<int> (components.pixels.size ())) // its first pixel
      components.pixels.push_back (0);
    ++components.pixels[component];
  }
  const std::vector<std::size_t> ends = countEnds (cloud, components.pixels.size (),
                                                   [&] (int pixel) { return components.of_pixel[pixel]; });
  for (std::size_t component = 0; component < ends.size (); ++component)
    components.cut.push_back (isCut (ends[component], components.pixels[component]));
  return components;
}

std::set<std::uint16_t>
cutInstances (const Image<std::uint16_t>& mask, const FrameCloud& cloud)
{
  std::vector<std::size_t> pixels (FrameSegmenter::ignored + 1, 0);
  for (const std::uint16_t instance : mask.pixels)
    ++pixels[instance];
  const std::vector<std::size_t> ends = countEnds (cloud, pixels.size (), [&] (int pixel) {
    const std::uint16_t instance = mask.pixels[pixel];
    return instance == 0 || instance == FrameSegmenter::ignored ? -1 : static_cast<int> (instance);
  });
  std::set<std::uint16_t> cut;
  for (std::size_t instance = 1; instance < FrameSegmenter::ignored; ++instance)
    if (isCut (ends[instance], pixels[instance]))
      cut.insert (static_cast<std::uint16_t> (instance));
  return cut;
}

} // namespace pcl::cosection
