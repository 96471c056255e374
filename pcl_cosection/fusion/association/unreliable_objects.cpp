// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors

// What ObjectMap makes of masks that are not exact.

#include "pcl_cosection/fusion/mapping/object_map.h"

#include <algorithm>
#include <set>
#include <utility>

namespace pcl::cosection
{

namespace
{

constexpr double least_shown_iou = 0.5; // with which a second mask confirms what one showed
constexpr int most_unshown = 2;         // masks that do not

} // namespace

void
ObjectMap::erase (int id)
{
  merging_.forget (id);
  active_.erase (
      std::find_if (active_.begin (), active_.end (), [id] (const auto& object) { return object->id == id; }));
}

void
ObjectMap::judge (double stamp, const ReconciledMask& mask, const Image<std::uint16_t>& labels, EventLog& log)
{
  merging_.count (mask);
  std::vector<int> wrong;
  for (const auto& object : active_)
  {
    if (object->confirmed)
      continue;
    const auto shown = mask.shown_iou.find (object->id);
    object->confirmed = shown != mask.shown_iou.end () && shown->second > least_shown_iou;
    if (object->confirmed)
    {
      log.add (stamp, "object ", object->id, " is confirmed");
      continue;
    }
    const auto pixels = std::count (labels.pixels.begin (), labels.pixels.end (),
                                    static_cast<std::uint16_t> (object->id));
    if (isExpectedInMask (static_cast<std::size_t> (pixels)) && ++object->unshown >= most_unshown)
      wrong.push_back (object->id);
  }
  for (const int id : wrong)
  {
    log.add (stamp, "object ", id, " is given up: only one mask showed it");
    erase (id);
  }
}

void
ObjectMap::uniteParts (double stamp, const FrameCloud& cloud, const Eigen::Isometry3d& T_world_camera,
                       Image<std::uint16_t>& labels, std::optional<Image<std::uint16_t>>& mask, EventLog& log)
{
  merging_.follow (active_);
  std::set<int> wholes;
  while (const std::optional<std::pair<int, int>> one = merging_.next ())
  {
    const auto find = [&] (int id) {
      return std::find_if (active_.begin (), active_.end (), [id] (const auto& object) { return object->id == id; })
          ->get ();
    };
    const auto pixelsOf = [&] (int id) {
      return std::count (labels.pixels.begin (), labels.pixels.end (), static_cast<std::uint16_t> (id));
    };
    const bool second_is_larger = pixelsOf (one->second) > pixelsOf (one->first);
    const int whole = second_is_larger ? one->second : one->first;
    const int part = second_is_larger ? one->first : one->second;
    log.add (stamp, "object ", part, " is a part of object ", whole);
    find (whole)->confirmed = find (whole)->confirmed || find (part)->confirmed;
    find (whole)->classes.add (find (part)->classes);
    for (Image<std::uint16_t>* image : {&labels, mask ? &*mask : nullptr})
      if (image)
        std::replace (image->pixels.begin (), image->pixels.end (), static_cast<std::uint16_t> (part),
                      static_cast<std::uint16_t> (whole));
    erase (part);
    wholes.erase (part);
    wholes.insert (whole);
  }
  if (wholes.empty () || mask)
    return; // a mask does the rest
  grow (stamp, cloud, T_world_camera, labels, log);
  for (const auto& object : active_) // masks before have only counted against what was another object's
    if (wholes.count (object->id) > 0)
      object->volume.countForeground (cloud.reliable, cloud.camera, object->T_world_object.inverse () * T_world_camera,
                                      labels, static_cast<std::uint16_t> (object->id));
}

} // namespace pcl::cosection
