// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/fusion/frame_segmenter.h>

#include <cstddef>
#include <utility>
#include <vector>

namespace pcl::cosection {

NetworkSegmenter::NetworkSegmenter (const InstanceDetectorOptions& options, const ClassRoles& roles)
    : detector_ (options)
    , roles_ (roles)
{
  roles.validate (options.detection.class_names);
}

FrameInstances
NetworkSegmenter::segment (const ObservedFrame& frame)
{
  const Picture& picture = frame.images.colour;
  if (picture.pixels.empty ())
    return {std::nullopt, "frames without colour: the network finds no objects in them"};
  const std::vector<DetectedInstance> detected = detector_.detect (picture);
  InstanceLabels labelled = labelInstances (detected, picture.width, picture.height, roles_);
  FrameInstances found;
  for (std::size_t n = 0; n < labelled.instances.size (); ++n)
  {
    const DetectedInstance& instance = detected[labelled.instances[n]];
    found.classes[static_cast<std::uint16_t> (n + 1)] = {instance.class_id, instance.class_name, instance.score};
  }
  found.mask = std::move (labelled.labels);
  return found;
}

} // namespace pcl::cosection
