// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "segmenter_choice.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/fusion/frame_segmenter.h>

using namespace pcl::cosection;

std::vector<std::string>
segmenterNames ()
{
  return {"geometric", "motion", "mask-rcnn"};
}

std::shared_ptr<FrameSegmenter>
makeSegmenter (const std::string& name, int threads, const std::optional<NetworkSettings>& network)
{
  if (name == "geometric")
  {
    ObjectSegmentationOptions options;
    options.threads = threads;
    return (std::make_shared<GeometricSegmenter> (options));
  }
  if (name == "motion")
  {
    MotionSegmentationOptions options;
    options.threads = threads;
    return (std::make_shared<MotionSegmenter> (options));
  }
  if (name == "mask-rcnn" && network)
  {
    NetworkSettings settings = *network;
    readClassNames (settings);
    return (std::make_shared<NetworkSegmenter> (settings.network, settings.roles));
  }
  throw InvalidArgument ("there is no segmentation of the name " + name);
}
