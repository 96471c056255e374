// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "object_merging.h"

#include <algorithm>

namespace pcl::cosection
{

namespace
{

constexpr double tolerance_voxels = 2.0; // of the coarser volume: how exactly a pose is known
constexpr double least_tolerance_m = 0.01;
constexpr double travel_tolerances = 3.0;     // from which on two that keep their places move as one
constexpr double drift_share = 0.2;           // of the travel; what is soft bends
constexpr double most_drift_tolerances = 3.0; // from which on two are two
constexpr int least_frames = 10;              // in which both were tracked
constexpr int least_together = 2;             // masks
constexpr int together_for_apart = 2;         // masks that outweigh one that shows two

} // namespace

void
ObjectMerging::count (const ReconciledMask& mask)
{
  for (const auto& pair : mask.together)
    ++pairs_[pair].together;
  for (const auto& pair : mask.apart)
    ++pairs_[pair].apart;
}

void
ObjectMerging::follow (const Objects& objects)
{
  for (std::size_t a = 0; a < objects.size (); ++a)
    for (std::size_t b = a + 1; b < objects.size (); ++b)
    {
      const TrackedObject& first = *objects[a];
      const TrackedObject& second = *objects[b];
      if (first.state != ObjectState::Tracked || second.state != ObjectState::Tracked)
        continue;
      const Eigen::Vector3d places[2] = {first.T_world_object.translation (), second.T_world_object.translation ()};
      const Eigen::Vector3d place = first.T_world_object.inverse () * places[1];
      Pair& pair = pairs_[{first.id, second.id}];
      if (pair.frames++ == 0)
      {
        pair.place = place;
        pair.start[0] = places[0];
        pair.start[1] = places[1];
        pair.tolerance_m = std::max (
            least_tolerance_m,
            tolerance_voxels * std::max (first.volume.grid ().voxel_size_m, second.volume.grid ().voxel_size_m));
      }
      pair.travel_m = std::max (pair.travel_m,
                                std::min ((places[0] - pair.start[0]).norm (), (places[1] - pair.start[1]).norm ()));
      pair.drift_m = std::max (pair.drift_m, (place - pair.place).norm ());
      pair.two = pair.two ||
                 pair.drift_m > std::max (most_drift_tolerances * pair.tolerance_m, drift_share * pair.travel_m);
    }
}

bool
ObjectMerging::isOne (const Pair& pair)
{
  if (pair.two || !pair.touch () || pair.frames < least_frames)
    return false;
  const bool as_one = pair.travel_m > travel_tolerances * pair.tolerance_m &&
                      pair.drift_m < std::max (pair.tolerance_m, drift_share * pair.travel_m);
  return as_one || (pair.drift_m < pair.tolerance_m && pair.together >= least_together &&
                    pair.together > together_for_apart * pair.apart);
}

std::optional<std::pair<int, int>>
ObjectMerging::next () const
{
  for (const auto& [ids, pair] : pairs_)
    if (isOne (pair))
      return ids;
  return std::nullopt;
}

void
ObjectMerging::forget (int id)
{
  for (auto i = pairs_.begin (); i != pairs_.end ();)
    i = i->first.first == id || i->first.second == id ? pairs_.erase (i) : std::next (i);
}

} // namespace pcl::cosection
