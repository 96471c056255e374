// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_map.h"

#include "pcl_cosection/fusion/association/unreliable_mask.h"

#include <algorithm>
#include <iterator>

namespace pcl::cosection {
namespace {

constexpr int frames_until_dormant = 60;
constexpr std::ptrdiff_t max_dormant = 16;
constexpr double uncounted_foreground = 0.5; // probability where no mask has counted yet
constexpr double tolerance_voxels = 2.0;     // of the coarser volume: how exactly a pose is known
constexpr double least_tolerance_m = 0.01;
constexpr double travel_tolerances = 3.0;     // after which two that keep their places move as one
constexpr double drift_share = 0.2;           // of the travel; soft things bend
constexpr double most_drift_tolerances = 3.0; // beyond which two are two
constexpr int least_frames = 10;              // in which both were tracked
constexpr int least_together = 2;             // masks
constexpr int together_for_apart = 2;         // masks that outweigh one that shows two
constexpr double least_shown_iou = 0.5;       // of a second mask that confirms an object
constexpr int most_unshown = 2;               // masks

/** \brief The object becomes dormant; if there are too many, the one that has been so for longest is retired. */
void
makeDormant (TrackedObject& object, ObjectMap& objects)
{
  object.state = ObjectState::Dormant;
  object.dormant_since = objects.next_dormant++;
  TrackedObject* oldest = &object;
  std::ptrdiff_t dormant = 0;
  for (auto& [id, other] : objects.by_id)
    if (other.state == ObjectState::Dormant)
    {
      ++dormant;
      if (other.dormant_since < oldest->dormant_since)
        oldest = &other;
    }
  if (dormant <= max_dormant)
    return;
  oldest->surface = oldest->volume->surfaceMesh ();
  oldest->volume.reset ();
  oldest->state = ObjectState::Retired;
}

/** \brief Follow where all pairs of tracked objects are. */
void
followPairs (ObjectMap& objects)
{
  for (auto a = objects.by_id.begin (); a != objects.by_id.end (); ++a)
    for (auto b = std::next (a); b != objects.by_id.end (); ++b)
    {
      const TrackedObject &first = a->second, &second = b->second;
      if (!first.isTracked () || !second.isTracked ())
        continue;
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

const TrackedObject*
ObjectMap::find (int id) const
{
  const auto object = by_id.find (id);
  return object == by_id.end () ? nullptr : &object->second;
}

void
ObjectMap::erase (int id)
{
  for (auto pair = pairs.begin (); pair != pairs.end ();)
    pair = pair->first.first == id || pair->first.second == id ? pairs.erase (pair) : std::next (pair);
  by_id.erase (id);
}

SceneModels
expectedModels (const TsdfVolume& background, const ObjectMap& objects, const Eigen::Isometry3d& T_world_camera)
{
  SceneModels scene{{{&background, T_world_camera, 1.0}}, {}};
  for (const auto& [id, object] : objects.by_id)
    if (object.isActive ())
    {
      scene.objects.push_back (&object);
      scene.models.push_back ({&*object.volume, object.predicted ().inverse () * T_world_camera, uncounted_foreground});
    }
  return scene;
}

SceneModels
trackedModels (const TsdfVolume& background, const ObjectMap& objects, const Eigen::Isometry3d& T_world_camera)
{
  SceneModels scene{{{&background, T_world_camera, 1.0}}, {}};
  for (const auto& [id, object] : objects.by_id)
    if (object.isTracked ())
    {
      scene.objects.push_back (&object);
      scene.models.push_back (
          {&*object.volume, object.T_world_object.inverse () * T_world_camera, uncounted_foreground});
    }
  return scene;
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

void
pruneObjects (double stamp, const std::map<std::uint16_t, double>& mean_probability,
              const DynamicFusionOptions& options, ObjectMap& objects, EventLog& log)
{
  std::vector<int> wrong;
  for (auto& [id, object] : objects.by_id)
  {
    if (!object.isActive ())
      continue;
    const auto mean = mean_probability.find (static_cast<std::uint16_t> (id));
    if (!object.confirmed && !object.isTracked ())
      wrong.push_back (id);
    else if (object.existence () < options.min_existence)
    {
      log.add (stamp, "object ", id, " is given up: it was in ", object.seen, " of ", object.seen + object.missed,
               " masks in which it should be");
      wrong.push_back (id);
    }
    else if (object.isTracked () && mean != mean_probability.end () && mean->second < options.min_association)
    {
      log.add (stamp, "object ", id, " is given up: its pixels belong to it with a probability of only ", mean->second);
      wrong.push_back (id);
    }
    else if (object.frames_not_tracked > frames_until_dormant)
    {
      log.add (stamp, "object ", id, " is no longer looked for: it was not seen for ", object.frames_not_tracked,
               " frames");
      makeDormant (object, objects);
    }
  }
  for (const int id : wrong)
    objects.erase (id);
}

} // namespace pcl::cosection
