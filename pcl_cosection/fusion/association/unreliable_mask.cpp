// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "unreliable_mask.h"

#include "instance_matching.h"
#include "unassigned_components.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pcl::cosection {
namespace {

constexpr double half = 0.5;
constexpr double touching_share = 0.25; // of the root of a component's pixels
constexpr std::uint16_t unassigned_label = TrackedFrame::unassigned;

bool
isObject (std::uint16_t label)
{
  return label != 0 && label != unassigned_label;
}

/** \brief Numbers of pixels of instances and objects, and of those that both have. */
struct Counts
{
  std::map<std::uint16_t, std::size_t> of_instance, of_object;
  std::map<std::uint16_t, std::map<std::uint16_t, std::size_t>> common; // by instance and object
};

Counts
count (const Image<std::uint16_t>& mask, const Image<std::uint16_t>& labels, const FrameCloud& cloud)
{
  Counts counts;
  for (std::size_t n = 0; n < mask.pixels.size (); ++n)
  {
    if (!std::isfinite (cloud.depth.pixels[n]) || mask.pixels[n] == unassigned_label)
      continue;
    const std::uint16_t instance = mask.pixels[n];
    const std::uint16_t object = labels.pixels[n];
    if (instance != 0)
      ++counts.of_instance[instance];
    if (!isObject (object))
      continue;
    ++counts.of_object[object];
    if (instance != 0)
      ++counts.common[instance][object];
  }
  return counts;
}

/** \brief The objects that an instance shows. */
std::vector<std::uint16_t>
shownBy (std::uint16_t instance, const Counts& counts)
{
  std::vector<std::uint16_t> shown;
  const auto common = counts.common.find (instance);
  if (common == counts.common.end ())
    return shown;
  for (const auto& [object, pixels] : common->second)
    if (static_cast<double> (pixels) >= half * static_cast<double> (counts.of_object.at (object)))
      shown.push_back (object);
  if (shown.empty ())
    for (const auto& [object, pixels] : common->second)
      if (static_cast<double> (pixels) >= half * static_cast<double> (counts.of_instance.at (instance)))
        shown.push_back (object);
  return shown;
}

} // namespace

ReconciledMask
reconcile (const Image<std::uint16_t>& mask, const LabelImage& labels, const Image<std::uint8_t>& moving,
           const FrameCloud& cloud)
{
  const Counts counts = count (mask, labels, cloud);
  ReconciledMask result;
  LabelMap number;                                                // of instances; 0: it is divided
  std::map<std::uint16_t, std::size_t> of_parts, of_parts_common; // by object
  result.last_object = counts.of_object.empty () ? 0 : counts.of_object.rbegin ()->first;
  auto next = static_cast<std::uint16_t> (result.last_object + 1);
  for (const auto& [instance, pixels] : counts.of_instance)
  {
    const std::vector<std::uint16_t> shown = shownBy (instance, counts);
    if (shown.empty () && next < unassigned_label)
      number[instance] = next++;
    else
      number[instance] = shown.size () == 1 ? shown.front () : 0;
    if (shown.size () == 1)
    {
      of_parts[shown.front ()] += pixels;
      of_parts_common[shown.front ()] += counts.common.at (instance).at (shown.front ());
    }
    for (std::size_t a = 0; a < shown.size (); ++a)
      for (std::size_t b = a + 1; b < shown.size (); ++b)
        result.together.insert ({shown[a], shown[b]});
  }
  for (const auto& [object, pixels] : of_parts)
  {
    const std::size_t both = of_parts_common[object];
    result.shown_iou[object] = static_cast<double> (both) /
                               static_cast<double> (pixels + counts.of_object.at (object) - both);
  }
  result.mask = Image<std::uint16_t> (mask.width, mask.height, 0);
  for (std::size_t n = 0; n < mask.pixels.size (); ++n)
  {
    const std::uint16_t instance = mask.pixels[n];
    const std::uint16_t object = labels.pixels[n];
    std::uint16_t& pixel = result.mask.pixels[n];
    if (instance == unassigned_label)
      pixel = instance;
    else if (isObject (object) &&
             (instance == 0 || counts.of_object.count (number.at (instance)) > 0 || number.at (instance) == 0))
      pixel = object;
    else if (instance != 0 && std::isfinite (cloud.depth.pixels[n]))
    {
      const std::uint16_t part_of = number.at (instance);
      const bool of_object = counts.of_object.count (part_of) > 0;
      pixel = of_object && moving.pixels[n] ? 0 : part_of;
    }
  }
  forNeighbours (cloud, [&] (std::size_t a, std::size_t b) {
    const std::uint16_t first = labels.pixels[a], second = labels.pixels[b];
    const auto pair = std::make_pair<int, int> (std::min (first, second), std::max (first, second));
    if (first != second && isObject (first) && isObject (second) && of_parts.count (first) > 0 &&
        of_parts.count (second) > 0 && result.together.count (pair) == 0)
      result.apart.insert (pair);
  });
  return result;
}

Image<std::uint16_t>
attachToMoved (const ReconciledMask& reconciled, const std::set<int>& moved, const LabelImage& labels,
               const FrameCloud& cloud)
{
  Image<std::uint16_t> mask = reconciled.mask;
  std::vector<bool> unassigned (mask.pixels.size ());
  std::map<std::uint16_t, std::size_t> object_pixels;
  for (std::size_t n = 0; n < unassigned.size (); ++n)
  {
    const bool of_object = isObject (mask.pixels[n]) && mask.pixels[n] <= reconciled.last_object;
    unassigned[n] = labels.pixels[n] == unassigned_label && !of_object;
    if (of_object)
      ++object_pixels[mask.pixels[n]];
  }
  const UnassignedComponents components = findUnassignedComponents (unassigned, cloud);
  std::map<std::pair<int, std::uint16_t>, std::size_t> borders; // pixels along which both touch
  forNeighbours (cloud, [&] (std::size_t a, std::size_t b) {
    for (const auto& [pixel, object] : {std::pair (a, b), std::pair (b, a)})
      if (unassigned[pixel] && !unassigned[object] && moved.count (mask.pixels[object]) > 0)
        ++borders[{components.of_pixel[pixel], mask.pixels[object]}];
  });
  std::vector<std::uint16_t> attached_to (components.pixels.size (), 0);
  std::vector<std::size_t> longest (components.pixels.size (), 0);
  for (const auto& [pair, border] : borders)
  {
    const auto& [component, object] = pair;
    if (border <= longest[component] || !components.mayBelongTo (component, object_pixels[object]) ||
        static_cast<double> (border) < touching_share * std::sqrt (static_cast<double> (components.pixels[component])))
      continue;
    longest[component] = border;
    attached_to[component] = object;
  }
  for (std::size_t n = 0; n < unassigned.size (); ++n)
    if (unassigned[n] && mask.pixels[n] != 0 && attached_to[components.of_pixel[n]] != 0)
      mask.pixels[n] = attached_to[components.of_pixel[n]];
  return mask;
}

std::map<std::uint16_t, ClassScore>
carriedClasses (const FrameInstances& found, const Image<std::uint16_t>& reconciled, const FrameCloud& cloud)
{
  std::map<std::uint16_t, ClassScore> classes;
  if (found.classes.empty ())
    return classes;
  for (const auto& [instance, remaining] : matchMasks (*found.mask, reconciled, cloud.depth, half).object_of)
    if (const auto detected = found.classes.find (instance); detected != found.classes.end ())
      classes[remaining] = detected->second;
  return classes;
}

Image<std::uint16_t>
dropIsolated (Image<std::uint16_t> mask, const LabelMap& object_of, const FrameCloud& cloud)
{
  std::set<std::uint16_t> touching;
  forNeighbours (cloud, [&] (std::size_t a, std::size_t b) {
    const std::uint16_t first = mask.pixels[a], second = mask.pixels[b];
    if (first == second || !isObject (first) || !isObject (second))
      return;
    if (object_of.count (first) > 0)
      touching.insert (second);
    if (object_of.count (second) > 0)
      touching.insert (first);
  });
  for (std::uint16_t& pixel : mask.pixels)
    if (isObject (pixel) && object_of.count (pixel) == 0 && touching.count (pixel) == 0)
      pixel = 0;
  return mask;
}

} // namespace pcl::cosection
