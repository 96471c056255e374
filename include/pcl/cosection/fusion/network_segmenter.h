// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/fusion/frame_segmenter.h>
#include <pcl/cosection/segmentation/instance_detector.h>
#include <pcl/cosection/segmentation/instance_labels.h>

namespace pcl::cosection
{

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
  /** \throws InvalidArgument, IoError as InstanceDetector and ClassRoles::validate () */
  explicit NetworkSegmenter (const InstanceDetectorOptions& options, const ClassRoles& roles = {});

  /** \brief Instances with their classes. A frame without colour tells nothing. \throws IoError if the network cannot
   * be run */
  FrameInstances segment (const ObservedFrame& frame) override;

private:
  InstanceDetector detector_;
  ClassRoles roles_;
};

} // namespace pcl::cosection
