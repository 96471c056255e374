// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "found_objects.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/image.h>

#include <algorithm>
#include <array>
#include <limits>

using namespace pcl::cosection;

namespace {

FoundObjects
findByGeometry (const SegmentSettings& settings, OrganizedCloud cloud, const Image<std::uint8_t>& ignored)
{
  for (std::size_t i = 0; i < cloud.points.size (); ++i)
    if (ignored.pixels[i] != 0)
      cloud.points[i].setConstant (std::numeric_limits<float>::quiet_NaN ());
  ObjectSegmentation found = segmentObjects (cloud.points, cloud.width, cloud.height, settings.segmentation);
  return {std::move (found.labels), std::vector<FoundObjects::Object> (found.objects),
          std::move (found.support_planes)};
}

FoundObjects
findByNetwork (InstanceDetector& detector, const ClassRoles& roles, const OrganizedCloud& cloud,
               const Image<std::uint8_t>& ignored)
{
  const std::vector<std::array<std::uint8_t, 3>>& pixels = cloud.picture.pixels;
  if (std::all_of (pixels.begin (), pixels.end (), [] (const auto& c) { return (c == std::array<std::uint8_t, 3>{}); }))
    throw DegenerateInput (pixels.empty () ? "has no colours (a field rgb or rgba), which --method mask-rcnn needs"
                                           : "all of it is black");
  Image<std::uint8_t> readings (cloud.width, cloud.height, 0);
  for (std::size_t i = 0; i < cloud.points.size (); ++i)
    readings.pixels[i] = cloud.points[i].allFinite () && ignored.pixels[i] == 0 ? 1 : 0;
  std::vector<DetectedInstance> instances = detector.detect (cloud.picture);
  const InstanceLabels labelled = labelInstances (instances, cloud.width, cloud.height, roles, readings);
  FoundObjects found;
  found.labels.assign (labelled.labels.pixels.begin (), labelled.labels.pixels.end ());
  for (const std::size_t n : labelled.instances)
    found.objects.push_back ({0, std::move (instances[n])});
  return (found);
}

} // namespace

FoundObjects
findObjects (const SegmentSettings& settings, const OrganizedCloud& cloud, InstanceDetector* detector)
{
  const Image<std::uint8_t> ignored = ignoredPixels (settings.ignored, cloud.width, cloud.height);
  FoundObjects found;
  try
  {
    found = detector != nullptr ? findByNetwork (*detector, settings.network->roles, cloud, ignored)
                                : findByGeometry (settings, cloud, ignored);
  }
  catch (const DegenerateInput& error)
  {
    throw DegenerateInput (settings.input + ": " + error.what ());
  }
  for (std::size_t i = 0; i < found.labels.size (); ++i)
  {
    if (ignored.pixels[i] != 0)
      found.labels[i] = ignored_label;
    if (found.labels[i] > 0 && found.labels[i] <= found.objects.size ())
      ++found.objects[found.labels[i] - 1].points;
  }
  return (found);
}
