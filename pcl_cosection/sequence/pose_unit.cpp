// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pose_unit.h"

#include "median_depth.h"
#include "stamp_matching.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <optional>
#include <sstream>

namespace pcl::cosection {
namespace {

/** \brief The median depth of the first image with readings; nothing if none of those at \a indices has any. */
std::optional<float>
firstMedianDepth (const RgbdSequence& images, const std::vector<std::size_t>& indices)
{
  std::vector<std::string> ignored;
  for (const std::size_t index : indices)
    try
    {
      if (const auto depth = medianDepth (images.read (index, ignored).depth))
        return depth;
    }
    catch (const Error&)
    {
      // It is said when the frame is used.
    }
  return std::nullopt;
}

} // namespace

std::string
unitFault (const std::vector<StampedPose>& trajectory, const RgbdSequence& images, const FrameRange& range)
{
  const auto poses = posesAtStamps (trajectory, images.stamps (), images.period ());
  std::vector<std::size_t> indices; // of frames with a pose
  const std::size_t last = std::min (range.last, poses.size ());
  for (std::size_t index = range.first; index < last; ++index)
    if (poses[index])
      indices.push_back (index);
  if (indices.size () < 2 || 2 * indices.size () < last - range.first) // the few may be far apart: stamps are wrong
    return {};
  std::vector<double> steps_m;
  for (std::size_t n = 1; n < indices.size (); ++n)
    steps_m.push_back ((poses[indices[n]]->translation () - poses[indices[n - 1]]->translation ()).norm ());
  const double step_m = upperMedian (steps_m);
  if (step_m == 0.0)
    return {};
  const std::optional<float> depth_m = firstMedianDepth (images, indices);
  if (!depth_m || step_m <= *depth_m)
    return {};
  std::ostringstream text;
  text.precision (3);
  text << "from frame to frame the camera would move " << step_m << " m, farther than what it sees is away, "
       << *depth_m << " m: its poses must be in metres; divide their positions by 1000 if they are in millimetres";
  return text.str ();
}

} // namespace pcl::cosection
