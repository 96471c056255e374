// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/fusion/frame_segmenter.h>

#include "pcl_cosection/common/lattice_cells.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr double voxel_m = 0.05; // of ObjectSizeFilter: poses are known better

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

FrameInstances
instancesOf (const std::vector<std::uint32_t>& labels, const PinholeCamera& camera)
{
  FrameInstances instances;
  instances.mask = Image<std::uint16_t> (camera.width, camera.height);
  std::transform (labels.begin (), labels.end (), instances.mask->pixels.begin (), [] (std::uint32_t label) {
    constexpr std::uint32_t ignored = FrameSegmenter::ignored;
    return static_cast<std::uint16_t> (label == MotionSegments::unexplained ? ignored : std::min (label, ignored - 1));
  });
  return instances;
}

} // namespace

/** \brief Remembers where frames have shown things that are too long to be objects. One view shows less of a cupboard
 * than another one: a thing that was too long in most frames is no object, though a part of it could be one. */
class ObjectSizeFilter
{
public:
  void clear () { counts_.clear (); }

  /** \brief Remember the segmentation of a frame, and remove objects from it that were too long in more frames than
   * not.
   * \param[in] points sensor frame, metres */
  void filter (const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T_world_camera,
               ObjectSegmentation& found)
  {
    ++frame_;
    std::vector<std::size_t> pixels (found.objects + 1, 0), too_long (found.objects + 1, 0);
    for (std::size_t n = 0; n < points.size (); ++n)
    {
      const std::uint32_t label = found.labels[n];
      if (label == 0 && !found.too_long[n])
        continue;
      const Eigen::Array3d place = (T_world_camera * points[n].cast<double> ()).array () / voxel_m;
      const CellIndex voxel = place.round ().cast<std::int64_t> ();
      Frames& frames = counts_[keyOf (voxel)];
      if (frames.counted != frame_)
        ++(label == 0 ? frames.too_long : frames.object);
      frames.counted = frame_;
      ++pixels[label];
      too_long[label] += frames.too_long > frames.object;
    }
    for (std::uint32_t& label : found.labels)
      if (label != 0 && 2 * too_long[label] > pixels[label])
        label = 0;
  }

private:
  struct Frames
  {
    int too_long = 0; ///< in which a thing there was too long
    int object = 0;   ///< in which it was an object
    int counted = 0;  ///< number of the last one: each counts once
  };

  std::unordered_map<std::uint64_t, Frames> counts_; ///< by voxel of the world
  int frame_ = 0;
};

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
  return instancesOf (found.labels, frame.camera);
}
catch (const DegenerateInput& error)
{
  return {std::nullopt, std::string ("no objects are searched for: ") + error.what ()};
}

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
  return instancesOf (finder_.segment ().labels, frame.camera);
}

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
