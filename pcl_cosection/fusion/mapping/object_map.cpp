// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_map.h"

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr int frames_until_dormant = 60;
constexpr std::ptrdiff_t max_dormant = 16;
constexpr double uncounted_foreground = 0.5; // probability where no mask has counted yet

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
  if (dormant > max_dormant)
    oldest->retire ();
}

} // namespace

std::set<int>
ObjectMap::found () const
{
  std::set<int> ids;
  for (const auto& [id, object] : by_id)
    if (object.confirmed)
      ids.insert (id);
  return ids;
}

std::set<int>
ObjectMap::moved () const
{
  std::set<int> ids;
  for (const auto& [id, object] : by_id)
    if (object.isTracked () && object.hasMoved ())
      ids.insert (id);
  return ids;
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
  forgetPairs (id, pairs);
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

std::vector<Eigen::Vector3f>
pointsOf (const FrameCloud& cloud, const Image<std::uint16_t>& labels, std::uint16_t label)
{
  std::vector<Eigen::Vector3f> points;
  for (std::size_t n = 0; n < labels.pixels.size (); ++n)
    if (labels.pixels[n] == label && std::isfinite (cloud.reliable.pixels[n]))
      points.push_back (cloud.points[n]);
  return points;
}

std::vector<Eigen::Vector3f>
transformed (const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T)
{
  std::vector<Eigen::Vector3f> result (points.size ());
  std::transform (points.begin (), points.end (), result.begin (), [&T] (const Eigen::Vector3f& p) -> Eigen::Vector3f {
    return (T * p.cast<double> ()).cast<float> ();
  });
  return result;
}

void
growVolumes (const PosedFrame& frame, const Image<std::uint16_t>& labels, int max_resolution, ObjectMap& objects,
             EventLog& log)
{
  for (auto& [id, object] : objects.by_id)
  {
    if (!object.isTracked ())
      continue;
    const std::vector<Eigen::Vector3f> points = transformed (
        pointsOf (frame.cloud, labels, static_cast<std::uint16_t> (id)),
        object.T_world_object.inverse () * frame.T_world_camera);
    const Eigen::Vector3i before = object.volume->grid ().dims;
    if (!growObjectVolume (*object.volume, points, max_resolution) && !object.reached_max_size)
    {
      object.reached_max_size = true;
      log.add (frame.stamp, "object ", id, " is larger than ", max_resolution, " voxels: the rest is left out");
    }
    const Eigen::Vector3i& now = object.volume->grid ().dims;
    if (now != before)
      log.add (frame.stamp, "the volume of object ", id, " grows to ", now.x (), " x ", now.y (), " x ", now.z (),
               " voxels");
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
