// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/visualization/scene_picture.h>

#include "pcl_cosection/sequence/stamp_matching.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace pcl::cosection {
namespace {

constexpr TriangleMesh::Colour no_colour = {200, 200, 200};

std::unique_ptr<RgbdSequence>
openImages (const RunScene& scene, const std::string& dataset)
{
  const std::string folder = dataset.empty () ? scene.dataset : dataset;
  if (folder.empty ())
    throw IoError (
        scene.folder +
        ": does not name the images that the run has read, so there are no points to show; name them with --dataset");
  std::error_code ignored;
  if (dataset.empty () && !std::filesystem::is_directory (folder, ignored))
    throw IoError (folder +
                   ": the images that the run has read are not there any more; name their folder with --dataset");
  return std::make_unique<RgbdSequence> (folder, scene.source);
}

} // namespace

FramePointReader::FramePointReader (const RunScene& scene, const std::string& dataset)
    : images_ (openImages (scene, dataset))
    , stamps_ (images_->stamps ())
{}

FramePointReader::~FramePointReader () = default;
FramePointReader::FramePointReader (FramePointReader&&) noexcept = default;
FramePointReader& FramePointReader::operator= (FramePointReader&&) noexcept = default;

FramePoints
FramePointReader::read (const RunScene& scene, double stamp, int every) const
{
  if (every < 1)
    throw InvalidArgument ("every must be at least 1 pixel");
  FramePoints result;
  const std::optional<Eigen::Isometry3d> T_world_camera = scene.cameraAt (stamp);
  const std::optional<std::size_t> index = nearestStamp (stamps_, stamp, 0.5 * images_->period ());
  if (!index || !T_world_camera)
    return result;
  std::vector<std::string> ignored;
  const RgbdFrame frame = images_->read (*index, ignored);
  const PinholeCamera& camera = images_->camera ();
  for (int v = 0; v < camera.height; v += every)
    for (int u = 0; u < camera.width; u += every)
    {
      const float z = frame.depth.at (u, v);
      if (!std::isfinite (z))
        continue;
      result.points.push_back ((*T_world_camera * camera.unproject (u, v, z)).cast<float> ());
      result.colours.push_back (frame.colour.pixels.empty () ? no_colour : frame.colour.at (u, v));
    }
  return result;
}

} // namespace pcl::cosection
