// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_caption.h"

#include "pcl_cosection/sequence/stamp_matching.h"

#include <algorithm>
#include <sstream>

namespace pcl::cosection {

const std::vector<std::string>&
surfaceNames ()
{
  static const std::vector<std::string> names = {"completed", "tsdf", "points"};
  return names;
}

const std::vector<std::string>&
colourNames ()
{
  static const std::vector<std::string> names = {"real", "instance", "provenance", "confidence", "error"};
  return names;
}

std::string
sceneCaption (const RunScene& scene, double stamp, SurfaceMode surface, ColourMode colour)
{
  const std::vector<double> stamps = scene.stamps ();
  std::ostringstream text;
  text.precision (12);
  if (const auto frame = nearestStamp (stamps, stamp, stampPeriod (stamps)))
    text << "frame " << *frame + 1 << " of " << stamps.size () << ", stamp " << stamps[*frame];
  else
    text << "stamp " << stamp;
  const auto known = std::count_if (
      scene.run.objects.begin (), scene.run.objects.end (),
      [&] (const SceneRecord::Object& object) { return scene.poseAt (object, stamp).has_value (); });
  text << ", " << known << (known == 1 ? " object" : " objects");
  text << (surface == SurfaceMode::Completed ? ", completed"
           : surface == SurfaceMode::Tsdf    ? ", as seen"
                                             : ", points of this frame");
  if (surface != SurfaceMode::Points && colour != ColourMode::Real)
    text << ", colour: " << colourNames ()[static_cast<std::size_t> (colour)];
  return text.str ();
}

} // namespace pcl::cosection
