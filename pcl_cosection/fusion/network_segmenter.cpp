// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include <pcl/cosection/fusion/network_segmenter.h>

namespace pcl
{
namespace cosection
{

NetworkSegmenter::NetworkSegmenter (const InstanceDetectorOptions& options, const ClassRoles& roles)
: detector_ (options), roles_ (roles)
{
  roles.validate (options.detection.class_names);
}

FrameInstances
NetworkSegmenter::segment (const ObservedFrame& frame)
{
  const Picture& picture = frame.images.colour;
  if (picture.pixels.empty ())
    return {std::nullopt, "there are frames without colour, in which the network finds nothing"};
  return {labelInstances (detector_.detect (picture), picture.width, picture.height, roles_).labels, ""};
}

} // namespace cosection
} // namespace pcl
