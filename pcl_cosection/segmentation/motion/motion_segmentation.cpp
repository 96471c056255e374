// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/segmentation/motion_segmentation.h>

#include "pcl_cosection/common/console_errors.h"

#include <pcl/impl/instantiate.hpp>
#include <pcl/impl/pcl_base.hpp>
#include <pcl/point_types.h>

#include <string>

namespace pcl::cosection {

bool
MotionSegmentationBase::setOptions (const MotionSegmentationOptions& options)
{
  return reportErrors ("cosection::MotionSegmentation::setOptions", [&] {
    finder_ = MovingBodyFinder (options);
    options_ = options;
  });
}

bool
MotionSegmentationBase::setNumberOfThreads (unsigned int threads)
{
  MotionSegmentationOptions options = options_;
  options.threads = static_cast<int> (threads);
  return setOptions (options);
}

void
MotionSegmentationBase::reportMissingInput () const
{
  PCL_ERROR ("[pcl::cosection::MotionSegmentation::add] There is no input cloud.\n");
}

bool
MotionSegmentationBase::addPoints (std::vector<Eigen::Vector3f> points, unsigned int width, unsigned int height,
                                   const Eigen::Isometry3d& T_world_sensor)
{
  return reportErrors ("cosection::MotionSegmentation::add", [&] {
    if (height <= 1)
      throw InvalidArgument ("the input cloud is not organised: its height is " + std::to_string (height));
    MotionFrame frame;
    const std::optional<PinholeCamera> camera = camera_ ? camera_
                                                        : fitPinholeCamera (points, static_cast<int> (width),
                                                                            static_cast<int> (height));
    if (!camera)
      throw InvalidArgument ("the input cloud has hardly any readings, or is not the image of a pinhole camera");
    frame.points = std::move (points);
    frame.camera = *camera;
    frame.T_world_sensor = T_world_sensor_ ? *T_world_sensor_ : T_world_sensor;
    frame.bodies = bodies_;
    frame.T_world_body = T_world_body_;
    frame.expected_depth = expected_depth_;
    finder_.add (frame);
  });
}

void
MotionSegmentationBase::segmentLast (const pcl::PCLHeader& header, unsigned int width, unsigned int height,
                                     pcl::PointCloud<pcl::Label>& labels, std::vector<pcl::PointIndices>& label_indices)
{
  const MotionSegments found = finder_.segment ();
  labels.header = header;
  labels.resize (found.labels.size ());
  labels.width = width;
  labels.height = height;
  for (std::size_t i = 0; i < found.labels.size (); ++i)
  {
    const std::uint32_t label = labels[i].label = found.labels[i];
    if (label == 0 || label == MotionSegments::unexplained)
      continue;
    if (label > label_indices.size ())
      label_indices.resize (label);
    label_indices[label - 1].indices.push_back (static_cast<pcl::index_t> (i));
  }
  for (pcl::PointIndices& indices : label_indices)
    indices.header = header;
}

} // namespace pcl::cosection

#define PCL_INSTANTIATE_CosectionMotionSegmentation(T) template class pcl::cosection::MotionSegmentation<T>;
PCL_INSTANTIATE (CosectionMotionSegmentation,
                 (pcl::PointXYZ) (pcl::PointXYZI) (pcl::PointXYZRGB) (pcl::PointXYZRGBA) (pcl::PointXYZRGBL) (
                     pcl::PointNormal) (pcl::PointXYZRGBNormal) (pcl::PointXYZINormal))
