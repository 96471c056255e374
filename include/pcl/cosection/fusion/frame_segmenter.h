// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/fusion/dynamic_fusion.h>
#include <pcl/cosection/io/rgbd_sequence.h>
#include <pcl/cosection/segmentation/geometric_segmentation.h>
#include <pcl/cosection/segmentation/instance_detector.h>
#include <pcl/cosection/segmentation/motion_segmentation.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief What the front end knows of a frame when it asks for its objects; it refers to images that live as long as
 * the call. */
struct PCL_COSECTION_EXPORT ObservedFrame
{
  const RgbdFrame& images;                         ///< as they were read; colour may be empty
  const PinholeCamera& camera;                     ///< of the images
  const std::vector<Eigen::Vector3f>& points;      ///< row by row, sensor frame, metres, smoothed; NaN: no reading
  const Eigen::Isometry3d& T_world_camera;         ///< metres
  std::map<int, Eigen::Isometry3d> T_world_object; ///< of the objects that are tracked
  /** \brief What known models explain: id of the object, 0: background or no reading, TrackedFrame::unassigned:
   * nothing that is known. */
  const Image<std::uint16_t>& labels;
  /** \brief 1: it was found to move against the background and belongs to no object that is known; else 0. */
  const Image<std::uint8_t>& moving;
};

/** \brief What a FrameSegmenter says of a frame. */
struct PCL_COSECTION_EXPORT FrameInstances
{
  /** \brief Number of an instance, another one in each frame; 0: none, FrameSegmenter::ignored. It has the camera's
   * size; nothing: the frame says nothing of objects. */
  std::optional<Image<std::uint16_t>> mask;
  std::string note; ///< what the user should know; repeated ones are shown once
  /** \brief What an instance is, by its number, where that is known. */
  std::map<std::uint16_t, ClassScore> classes = {};
};

/** \brief Finds objects in frames while they are tracked, instead of masks from files. DynamicFusion calls it now and
 * then, after what is known was tracked, and uses what it returns as it does a mask: instances are matched with
 * objects, others begin. */
class PCL_COSECTION_EXPORT FrameSegmenter
{
public:
  /** \brief A pixel of something that is neither an object nor background, as a person: not tracked with, mapped or
   * completed. */
  static constexpr std::uint16_t ignored = ignored_label;

  virtual ~FrameSegmenter () = default;

  /** \brief A sequence begins: forget what was seen before. */
  virtual void begin () {}

  /** \brief Look at a frame in which objects are not asked for; it is called for each of those that is tracked. */
  virtual void look (const ObservedFrame&) {}

  /** \brief Find the objects in a frame. Errors are thrown: what is wrong with one frame only belongs into the note. */
  virtual FrameInstances segment (const ObservedFrame& frame) = 0;

  /** \brief Whether an object in view that a mask does not show is probably none: it is given up when that happens too
   * often. */
  virtual bool findsAll () const { return true; }

  /** \brief Whether an instance is one object. If not, it may be a part of one, several that touch, or none: what
   * frames have shown of an object goes before a mask; an object begins when two masks show it, and not from an
   * instance that the image's border cuts; objects that move as one, or that masks show as one, are united. */
  virtual bool isExact () const { return true; }
};

/** \brief Finds objects in frames by their geometry alone: segmentObjects (). What it misses in one, as things at the
 * image's border or flat ones, it may find in the next; what most frames have shown to be too long for an object is
 * none where another one shows but a part of it.
 *
 * \code
 * fusion.setSegmenter (std::make_shared<GeometricSegmenter> ());
 * \endcode */
class PCL_COSECTION_EXPORT GeometricSegmenter : public FrameSegmenter
{
public:
  /** \brief No frames yet. \throws InvalidArgument as ObjectSegmentationOptions::validate () */
  explicit GeometricSegmenter (const ObjectSegmentationOptions& options = {});

  ~GeometricSegmenter () override;

  void begin () override;

  /** \brief The objects of one frame; no mask where no plane is in view that objects could stand on. */
  FrameInstances segment (const ObservedFrame& frame) override;

  bool findsAll () const override { return false; }

  bool isExact () const override { return false; }

private:
  ObjectSegmentationOptions options_;
  std::unique_ptr<class ObjectSizeFilter> too_long_;
};

/** \brief Finds objects in frames when they begin to move: MovingBodyFinder. What the front end tracks already is known
 * to it; what moves with an object is a part of it. Things that move otherwise than as a whole are ignored.
 *
 * \code
 * fusion.setSegmenter (std::make_shared<MotionSegmenter> ());
 * \endcode */
class PCL_COSECTION_EXPORT MotionSegmenter : public FrameSegmenter
{
public:
  /** \brief No frames yet. \throws InvalidArgument as MotionSegmentationOptions::validate () */
  explicit MotionSegmenter (const MotionSegmentationOptions& options = {});

  void begin () override;

  void look (const ObservedFrame& frame) override;

  FrameInstances segment (const ObservedFrame& frame) override;

  /** \brief What rests is not found. */
  bool findsAll () const override { return false; }

private:
  MovingBodyFinder finder_;
};

/** \brief Finds objects in the colours of frames with an instance segmentation network: InstanceDetector.
 *
 * \code
 * InstanceDetectorOptions network;
 * network.model = "yolov5s-seg.onnx";
 * network.detection.class_names = loadClassNames ("coco.names");
 * fusion.setSegmenter (std::make_shared<NetworkSegmenter> (network, ClassRoles{{}, {"dining table", "tv"},
 * {"person"}}));
 * \endcode */
class PCL_COSECTION_EXPORT NetworkSegmenter : public FrameSegmenter
{
public:
  /** \brief Read the network. \throws InvalidArgument, IoError as InstanceDetector and ClassRoles::validate () */
  explicit NetworkSegmenter (const InstanceDetectorOptions& options, const ClassRoles& roles = {});

  /** \brief Instances with their classes; no mask for a frame without colour. \throws IoError if the network cannot
   * be run */
  FrameInstances segment (const ObservedFrame& frame) override;

private:
  InstanceDetector detector_;
  ClassRoles roles_;
};

} // namespace pcl::cosection
