// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_merging.h"

#include "object_map.h"
#include "pcl_cosection/fusion/association/unreliable_mask.h"

#include <algorithm>
#include <iterator>
#include <vector>

namespace pcl::cosection {
namespace {

constexpr double tolerance_voxels = 2.0; // of the coarser volume: how exactly a pose is known
constexpr double least_tolerance_m = 0.01;
constexpr double travel_tolerances = 3.0;     // after which two that keep their places move as one
constexpr double drift_share = 0.2;           // of the travel; soft things bend
constexpr double most_drift_tolerances = 3.0; // beyond which two are two
constexpr int least_frames = 10;              // in which both were tracked
constexpr int least_together = 2;             // masks
constexpr int together_for_apart = 2;         // masks that outweigh one that shows two
constexpr double least_shown_iou = 0.5;       // of a second mask that confirms an object
constexpr int most_unshown = 2;               // masks

/** \brief Follow where all pairs of tracked objects are. */
void
followPairs (ObjectMap& objects)
{
  std::vector<const TrackedObject*> tracked;
  for (const auto& [id, object] : objects.by_id)
    if (object.isTracked ())
      tracked.push_back (&object);
  for (std::size_t a = 0; a < tracked.size (); ++a)
    for (std::size_t b = a + 1; b < tracked.size (); ++b)
    {
      const TrackedObject& first = *tracked[a];
      const TrackedObject& second = *tracked[b];
      const Eigen::Vector3d places[2] = {first.T_world_object.translation (), second.T_world_object.translation ()};
      const Eigen::Vector3d place = first.T_world_object.inverse () * places[1];
      ObjectPair& pair = objects.pairs[{first.id, second.id}];
      if (pair.frames++ == 0)
      {
        pair.place = place;
        pair.start[0] = places[0];
        pair.start[1] = places[1];
        pair.tolerance_m = std::max (
            least_tolerance_m,
            tolerance_voxels * std::max (first.volume->grid ().voxel_size_m, second.volume->grid ().voxel_size_m));
      }
      pair.travel_m = std::max (pair.travel_m,
                                std::min ((places[0] - pair.start[0]).norm (), (places[1] - pair.start[1]).norm ()));
      pair.drift_m = std::max (pair.drift_m, (place - pair.place).norm ());
      pair.two = pair.two ||
                 pair.drift_m > std::max (most_drift_tolerances * pair.tolerance_m, drift_share * pair.travel_m);
    }
}

std::size_t
countPixels (const LabelImage& labels, int id)
{
  return static_cast<std::size_t> (
      std::count (labels.pixels.begin (), labels.pixels.end (), static_cast<std::uint16_t> (id)));
}

} // namespace

bool
ObjectPair::isOne () const
{
  if (two || together + apart == 0 || frames < least_frames)
    return false;
  const bool as_one = travel_m > travel_tolerances * tolerance_m &&
                      drift_m < std::max (tolerance_m, drift_share * travel_m);
  return as_one || (drift_m < tolerance_m && together >= least_together && together > together_for_apart * apart);
}

void
forgetPairs (int id, ObjectPairs& pairs)
{
  for (auto i = pairs.begin (); i != pairs.end ();)
    i = i->first.first == id || i->first.second == id ? pairs.erase (i) : std::next (i);
}

void
confirmObjects (double stamp, const ReconciledMask& mask, const LabelImage& labels, const FusionSetup& setup,
                ObjectMap& objects, EventLog& log)
{
  for (const auto& ids : mask.together)
    ++objects.pairs[ids].together;
  for (const auto& ids : mask.apart)
    ++objects.pairs[ids].apart;
  std::vector<int> wrong;
  for (auto& [id, object] : objects.by_id)
  {
    if (object.confirmed)
      continue;
    const auto shown = mask.shown_iou.find (id);
    object.confirmed = shown != mask.shown_iou.end () && shown->second > least_shown_iou;
    if (object.confirmed)
      log.add (stamp, "object ", id, " is confirmed");
    else if (setup.isExpectedInMask (countPixels (labels, id)) && ++object.unshown >= most_unshown)
      wrong.push_back (id);
  }
  for (const int id : wrong)
  {
    log.add (stamp, "object ", id, " is given up: only one mask showed it");
    objects.erase (id);
  }
}

LabelMap
uniteParts (double stamp, const LabelImage& labels, ObjectMap& objects, EventLog& log)
{
  followPairs (objects);
  LabelMap whole_of;
  std::map<int, std::size_t> absorbed; // pixels
  const auto pixelsOf = [&] (int id) { return countPixels (labels, id) + absorbed[id]; };
  while (true)
  {
    const auto one = std::find_if (objects.pairs.begin (), objects.pairs.end (),
                                   [] (const auto& pair) { return pair.second.isOne (); });
    if (one == objects.pairs.end ())
      return whole_of;
    auto [whole, part] = one->first;
    if (pixelsOf (part) > pixelsOf (whole))
      std::swap (whole, part);
    log.add (stamp, "object ", part, " is a part of object ", whole);
    TrackedObject& remaining = objects.by_id.at (whole);
    const TrackedObject& erased = objects.by_id.at (part);
    remaining.confirmed = remaining.confirmed || erased.confirmed;
    remaining.classes.add (erased.classes);
    absorbed[whole] = pixelsOf (part) + absorbed[whole];
    objects.erase (part);
    for (auto& [label, of] : whole_of)
      if (of == part)
        of = static_cast<std::uint16_t> (whole);
    whole_of[static_cast<std::uint16_t> (part)] = static_cast<std::uint16_t> (whole);
  }
}

} // namespace pcl::cosection
