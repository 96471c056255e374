// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "run_penetration.h"

#include <pcl/cosection/evaluation/penetration.h>

#include <algorithm>
#include <memory>

namespace pcl::cosection {
namespace {

/** \brief Where the second body is in the frame of the first, at a time. */
using RelativePoses = std::vector<StampedPose>;

/** \brief Moved by so little that nothing changes. */
bool
isSame (const Eigen::Isometry3d& a, const Eigen::Isometry3d& b)
{
  constexpr double nothing = 1e-5; // metres, and entries of rotations
  return (a.matrix () - b.matrix ()).cwiseAbs ().maxCoeff () < nothing;
}

PairPenetration
measure (int first_id, const PenetrationBody& first, int second_id, const PenetrationBody& second,
         const RelativePoses& poses, int volume_frames)
{
  PairPenetration result;
  result.first = first_id;
  result.second = second_id;
  result.frames = poses.size ();
  std::vector<std::pair<double, std::size_t>> deep; // depth and frame
  for (std::size_t n = 0; n < poses.size (); ++n)
  {
    if (n > 0 && isSame (poses[n].pose, poses[n - 1].pose))
      continue;
    const double depth_m = std::max (first.depthOf (second, poses[n].pose),
                                     second.depthOf (first, poses[n].pose.inverse ()));
    if (depth_m > 0.0)
      deep.emplace_back (-depth_m, n);
  }
  std::sort (deep.begin (), deep.end ());
  if (!deep.empty ())
  {
    result.depth_m = -deep.front ().first;
    result.stamp = poses[deep.front ().second].stamp;
  }
  // The deepest frame, and others all the way down to the least deep.
  const std::size_t count = std::min<std::size_t> (deep.size (), static_cast<std::size_t> (volume_frames));
  if (!poses.empty () && first.hasVolume () && second.hasVolume ())
    result.volume_m3 = 0.0;
  for (std::size_t n = 0; n < count; ++n)
  {
    const std::size_t place = count > 1 ? n * (deep.size () - 1) / (count - 1) : 0;
    if (const auto volume = first.sharedVolume (second, poses[deep[place].second].pose))
      result.volume_m3 = std::max (result.volume_m3.value_or (0.0), *volume);
  }
  return result;
}

} // namespace

std::vector<PairPenetration>
measurePenetrations (const SceneRecord& scene, double max_difference_s, const RunOptions& options)
{
  // An open object has no inside: a shell is not filled for a band behind it. The background is open, and is matter.
  PenetrationOptions background_options = options.penetration;
  background_options.threads = options.threads;
  PenetrationOptions body_options = background_options;
  body_options.open_parts = false;
  std::vector<const SceneRecord::Object*> objects;
  std::vector<PenetrationBody> bodies;
  for (const SceneRecord::Object& object : scene.objects)
    if (!object.mesh.empty () && !object.poses.empty ())
    {
      objects.push_back (&object);
      bodies.emplace_back (object.mesh, body_options);
    }

  std::vector<PairPenetration> result;
  for (std::size_t a = 0; a < objects.size (); ++a)
    for (std::size_t b = a + 1; b < objects.size (); ++b)
    {
      RelativePoses poses;
      for (const PosePair& pair : associatePoses (objects[a]->poses, objects[b]->poses, max_difference_s))
        poses.push_back ({objects[a]->poses[pair.truth].stamp,
                          objects[a]->poses[pair.truth].pose.inverse () * objects[b]->poses[pair.estimate].pose});
      result.push_back (measure (objects[a]->id, bodies[a], objects[b]->id, bodies[b], poses, options.volume_frames));
    }
  if (!scene.background.empty ())
  {
    const PenetrationBody background (scene.background, background_options);
    for (std::size_t n = 0; n < objects.size (); ++n)
    {
      RelativePoses poses;
      for (const StampedPose& pose : objects[n]->poses)
        poses.push_back ({pose.stamp, pose.pose.inverse ()});
      result.push_back (
          measure (objects[n]->id, bodies[n], PairPenetration::background, background, poses, options.volume_frames));
    }
  }
  return result;
}

} // namespace pcl::cosection
