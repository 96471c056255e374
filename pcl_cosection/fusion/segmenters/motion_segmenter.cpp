// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/fusion/frame_segmenter.h>

#include <pcl/cosection/fusion/dynamic_fusion.h>

#include <algorithm>

namespace pcl::cosection {

MotionSegmenter::MotionSegmenter (const MotionSegmentationOptions& options) : finder_ (options) {}

void
MotionSegmenter::begin ()
{
  finder_.reset ();
}

void
MotionSegmenter::look (const ObservedFrame& frame)
{
  MotionFrame motion;
  motion.camera = frame.camera;
  motion.points = frame.points;
  motion.T_world_sensor = frame.T_world_camera;
  motion.bodies.assign (frame.labels.pixels.begin (), frame.labels.pixels.end ());
  std::replace<decltype (motion.bodies)::iterator, std::uint32_t> (motion.bodies.begin (), motion.bodies.end (),
                                                                   TrackedFrame::unassigned, 0);
  for (const auto& [id, T_world_object] : frame.T_world_object)
    motion.T_world_body[static_cast<std::uint32_t> (id)] = T_world_object;
  finder_.add (motion);
}

FrameInstances
MotionSegmenter::segment (const ObservedFrame& frame)
{
  look (frame);
  const MotionSegments found = finder_.segment ();
  FrameInstances instances;
  instances.mask = Image<std::uint16_t> (frame.camera.width, frame.camera.height, 0);
  std::transform (found.labels.begin (), found.labels.end (), instances.mask->pixels.begin (),
                  [] (std::uint32_t label) {
                    if (label == MotionSegments::unexplained)
                      return ignored;
                    return static_cast<std::uint16_t> (std::min<std::uint32_t> (label, ignored - 1));
                  });
  return instances;
}

} // namespace pcl::cosection
