// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "object_energies.h"

#include "pcl_cosection/priors/object_priors.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace pcl::cosection {
namespace {

/** \brief A query whether a place (object frame) may belong to another object: it is in the box of that one's points.
 */
std::function<bool (const Eigen::Vector3d&)>
placesOfOthers (const std::vector<SceneObject>& objects, std::size_t own, const CompletionLog& log)
{
  std::vector<std::pair<Eigen::AlignedBox3d, std::vector<Eigen::Isometry3d>>> others; // box, T_other_object
  for (std::size_t o = 0; o < objects.size (); ++o)
    if (o != own && !log.failed (objects[o].index))
      others.emplace_back (objects[o].observation->box,
                           relativePoses (*objects[own].input, objects[own].grid (), objects[o].input));
  return [others] (const Eigen::Vector3d& p) {
    return std::any_of (others.begin (), others.end (), [&p] (const auto& other) {
      return std::any_of (other.second.begin (), other.second.end (), [&] (const Eigen::Isometry3d& T_other_object) {
        return other.first.contains (T_other_object * p);
      });
    });
  };
}

} // namespace

std::vector<BodyEnergy>
objectEnergies (const Scene& scene, CompletionMode mode, const std::vector<SceneObject>& objects, CompletionLog& log)
{
  std::vector<BodyEnergy> energies (objects.size ());
  for (std::size_t o = 0; o < objects.size (); ++o)
  {
    const SceneObject& object = objects[o];
    if (log.failed (object.index))
      continue;
    BodyState& body = *object.body;
    log.guard (object.index, [&] {
      log.timed ("constraints", [&] {
        BodyEnergy energy = makeBodyEnergy (*body.evidence);
        if (mode == CompletionMode::Once)
          body.evidence.reset ();
        if (!energy.hasData ())
          throw DegenerateInput ("no usable measurements: all of its points lie in space that was seen free");
        ObjectSetting setting = settingOf (scene, *object.input, body);
        setting.is_of_other = placesOfOthers (objects, o, log);
        addPriors (*object.observation, setting, object.planes (), object.support->inferred, body.hidden, energy);
        if (mode == CompletionMode::Once || object.observation->virtual_view)
          body.hidden.clear ();
        energies[o] = std::move (energy);
      });
    });
  }
  return energies;
}

} // namespace pcl::cosection
