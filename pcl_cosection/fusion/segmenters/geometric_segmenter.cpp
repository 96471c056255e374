// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/fusion/frame_segmenter.h>

#include "pcl_cosection/fusion/mapping/object_size_filter.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

/** \brief Points of the unfiltered depth: the segmentation models its noise. */
std::vector<Eigen::Vector3f>
rawPoints (const ObservedFrame& frame)
{
  std::vector<Eigen::Vector3f> points = frame.points;
  for (int v = 0; v < frame.camera.height; ++v)
    for (int u = 0; u < frame.camera.width; ++u)
      if (Eigen::Vector3f& p = points[static_cast<std::size_t> (v) * frame.camera.width + u]; std::isfinite (p.z ()))
        p = frame.camera.unproject (u, v, frame.images.depth.at (u, v)).cast<float> ();
  return points;
}

} // namespace

GeometricSegmenter::GeometricSegmenter (const ObjectSegmentationOptions& options)
    : options_ (options)
    , too_long_ (std::make_unique<ObjectSizeFilter> ())
{
  options.validate ();
}

GeometricSegmenter::~GeometricSegmenter () = default;

void
GeometricSegmenter::begin ()
{
  too_long_->clear ();
}

FrameInstances
GeometricSegmenter::segment (const ObservedFrame& frame)
try
{
  const std::vector<Eigen::Vector3f> points = rawPoints (frame);
  ObjectSegmentation found = segmentObjects (points, frame.camera.width, frame.camera.height, options_);
  too_long_->filter (points, frame.T_world_camera, found);
  FrameInstances instances;
  instances.mask = Image<std::uint16_t> (frame.camera.width, frame.camera.height, 0);
  std::transform (found.labels.begin (), found.labels.end (), instances.mask->pixels.begin (),
                  [] (std::uint32_t label) {
                    return static_cast<std::uint16_t> (std::min<std::uint32_t> (label, FrameSegmenter::ignored - 1));
                  });
  return instances;
}
catch (const DegenerateInput& error)
{
  return {std::nullopt, std::string ("no objects are searched for: ") + error.what ()};
}

} // namespace pcl::cosection
