// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/segmentation/motion_segmentation.h>

#include <pcl/common/point_tests.h>
#include <pcl/impl/pcl_base.hpp>
#include <pcl/point_types.h>

#include <limits>
#include <string>

namespace pcl::cosection
{

template <typename PointT>
void
MotionSegmentation<PointT>::setOptions (const MotionSegmentationOptions& options)
{
  finder_ = MovingBodyFinder (options);
}

template <typename PointT>
void
MotionSegmentation<PointT>::add ()
{
  if (!input_ || !initCompute ())
    throw InvalidArgument ("motion segmentation: there is no input cloud");
  MotionFrame frame;
  frame.points.assign (input_->size (), Eigen::Vector3f::Constant (std::numeric_limits<float>::quiet_NaN ()));
  for (const auto i : *indices_)
    if (pcl::isXYZFinite ((*input_)[i]))
      frame.points[i] = (*input_)[i].getVector3fMap ();
  deinitCompute ();
  if (!input_->isOrganized ())
    throw InvalidArgument ("motion segmentation: the input cloud is not organised: its height is " +
                           std::to_string (input_->height));
  const int width = static_cast<int> (input_->width), height = static_cast<int> (input_->height);
  const std::optional<PinholeCamera> camera = camera_ ? camera_ : fitPinholeCamera (frame.points, width, height);
  if (!camera)
    throw InvalidArgument (
        "motion segmentation: the input cloud has hardly any readings, or is not the image of a pinhole camera");
  frame.camera = *camera;
  if (T_world_sensor_)
    frame.T_world_sensor = *T_world_sensor_;
  else
  {
    frame.T_world_sensor.linear () = input_->sensor_orientation_.template cast<double> ().toRotationMatrix ();
    frame.T_world_sensor.translation () = input_->sensor_origin_.template head<3> ().template cast<double> ();
  }
  frame.bodies = bodies_;
  frame.T_world_body = T_world_body_;
  frame.expected_depth = expected_depth_;
  finder_.add (frame);
}

template <typename PointT>
void
MotionSegmentation<PointT>::segment (pcl::PointCloud<pcl::Label>& labels, std::vector<pcl::PointIndices>& label_indices)
{
  labels.clear ();
  label_indices.clear ();
  add ();
  const MotionSegments found = finder_.segment ();
  labels.header = input_->header;
  labels.resize (found.labels.size ());
  labels.width = input_->width;
  labels.height = input_->height;
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
    indices.header = input_->header;
}

} // namespace pcl::cosection

#define PCL_INSTANTIATE_CosectionMotionSegmentation(T) template class pcl::cosection::MotionSegmentation<T>;
