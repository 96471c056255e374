// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/segmentation/geometric_segmentation.h>

#include <pcl/common/point_tests.h>
#include <pcl/console/print.h>
#include <pcl/impl/pcl_base.hpp>
#include <pcl/point_types.h>

#include <limits>

namespace pcl::cosection
{

template <typename PointT>
void
GeometricSegmentation<PointT>::setOptions (const ObjectSegmentationOptions& options)
{
  options.validate ();
  options_ = options;
}

template <typename PointT>
void
GeometricSegmentation<PointT>::setMaximumObjectSize (double size_m)
{
  ObjectSegmentationOptions options = options_;
  options.max_object_size_m = size_m;
  setOptions (options);
}

template <typename PointT>
void
GeometricSegmentation<PointT>::setMinimumObjectSize (double size_m)
{
  ObjectSegmentationOptions options = options_;
  options.min_object_size_m = size_m;
  setOptions (options);
}

template <typename PointT>
void
GeometricSegmentation<PointT>::setConcaveAngle (double angle_rad)
{
  ObjectSegmentationOptions options = options_;
  options.concave_angle_rad = angle_rad;
  setOptions (options);
}

template <typename PointT>
void
GeometricSegmentation<PointT>::setNumberOfThreads (unsigned int threads)
{
  options_.threads = static_cast<int> (threads);
}

template <typename PointT>
void
GeometricSegmentation<PointT>::segment (pcl::PointCloud<pcl::Label>& labels,
                                        std::vector<pcl::PointIndices>& label_indices)
{
  const char* const name = "cosection::GeometricSegmentation::segment";
  labels.clear ();
  label_indices.clear ();
  support_planes_.clear ();
  if (!input_)
  {
    PCL_ERROR ("[pcl::%s] There is no input cloud.\n", name);
    return;
  }
  if (!input_->isOrganized ())
  {
    PCL_ERROR ("[pcl::%s] The input cloud is not organised: its height is %u.\n", name, input_->height);
    return;
  }
  if (!initCompute ())
    return;
  std::vector<Eigen::Vector3f> points (input_->size (),
                                       Eigen::Vector3f::Constant (std::numeric_limits<float>::quiet_NaN ()));
  for (const auto i : *indices_)
    if (pcl::isXYZFinite ((*input_)[i]))
      points[i] = (*input_)[i].getVector3fMap ();
  deinitCompute ();

  ObjectSegmentation found;
  try
  {
    found = segmentObjects (points, static_cast<int> (input_->width), static_cast<int> (input_->height), options_);
  }
  catch (const DegenerateInput& error)
  {
    PCL_ERROR ("[pcl::%s] %s.\n", name, error.what ());
    return;
  }
  labels.header = input_->header;
  labels.resize (found.labels.size ());
  labels.width = input_->width;
  labels.height = input_->height;
  label_indices.resize (found.objects);
  for (pcl::PointIndices& indices : label_indices)
    indices.header = input_->header;
  for (std::size_t i = 0; i < found.labels.size (); ++i)
  {
    labels[i].label = found.labels[i];
    if (found.labels[i] > 0)
      label_indices[found.labels[i] - 1].indices.push_back (static_cast<pcl::index_t> (i));
  }
  for (const Eigen::Vector4f& plane : found.support_planes)
  {
    support_planes_.emplace_back ();
    support_planes_.back ().header = input_->header;
    support_planes_.back ().values.assign (plane.data (), plane.data () + 4);
  }
}

} // namespace pcl::cosection

#define PCL_INSTANTIATE_CosectionGeometricSegmentation(T) template class pcl::cosection::GeometricSegmentation<T>;
