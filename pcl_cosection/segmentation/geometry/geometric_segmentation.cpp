// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/segmentation/geometric_segmentation.h>

#include "pcl_cosection/common/console_errors.h"

#include <pcl/impl/instantiate.hpp>
#include <pcl/impl/pcl_base.hpp>
#include <pcl/point_types.h>

namespace pcl::cosection {

bool
GeometricSegmentationBase::setOptions (const ObjectSegmentationOptions& options)
{
  return reportErrors ("cosection::GeometricSegmentation::setOptions", [&] {
    options.validate ();
    options_ = options;
  });
}

bool
GeometricSegmentationBase::setMaximumObjectSize (double size_m)
{
  ObjectSegmentationOptions options = options_;
  options.max_object_size_m = size_m;
  return setOptions (options);
}

bool
GeometricSegmentationBase::setMinimumObjectSize (double size_m)
{
  ObjectSegmentationOptions options = options_;
  options.min_object_size_m = size_m;
  return setOptions (options);
}

bool
GeometricSegmentationBase::setConcaveAngle (double angle_rad)
{
  ObjectSegmentationOptions options = options_;
  options.concave_angle_rad = angle_rad;
  return setOptions (options);
}

void
GeometricSegmentationBase::setNumberOfThreads (unsigned int threads)
{
  options_.threads = static_cast<int> (threads);
}

bool
GeometricSegmentationBase::begin (bool input, unsigned int width, unsigned int height)
{
  support_planes_.clear ();
  if (!input)
    PCL_ERROR ("[pcl::cosection::GeometricSegmentation::segment] There is no input cloud.\n");
  else if (height <= 1)
    PCL_ERROR ("[pcl::cosection::GeometricSegmentation::segment] The input cloud is not organised: its height is %u.\n",
               height);
  return input && height > 1 && width > 0;
}

void
GeometricSegmentationBase::segmentPoints (const std::vector<Eigen::Vector3f>& points, int width, int height,
                                          const pcl::PCLHeader& header, pcl::PointCloud<pcl::Label>& labels,
                                          std::vector<pcl::PointIndices>& label_indices)
{
  ObjectSegmentation found;
  if (!reportErrors ("cosection::GeometricSegmentation::segment",
                     [&] { found = segmentObjects (points, width, height, options_); }))
    return;
  labels.header = header;
  labels.resize (found.labels.size ());
  labels.width = static_cast<std::uint32_t> (width);
  labels.height = static_cast<std::uint32_t> (height);
  label_indices.resize (found.objects);
  for (pcl::PointIndices& indices : label_indices)
    indices.header = header;
  for (std::size_t i = 0; i < found.labels.size (); ++i)
  {
    labels[i].label = found.labels[i];
    if (found.labels[i] > 0)
      label_indices[found.labels[i] - 1].indices.push_back (static_cast<pcl::index_t> (i));
  }
  for (const Eigen::Vector4f& plane : found.support_planes)
  {
    support_planes_.emplace_back ();
    support_planes_.back ().header = header;
    support_planes_.back ().values.assign (plane.data (), plane.data () + 4);
  }
}

} // namespace pcl::cosection

#define PCL_INSTANTIATE_CosectionGeometricSegmentation(T) template class pcl::cosection::GeometricSegmentation<T>;
PCL_INSTANTIATE (CosectionGeometricSegmentation,
                 (pcl::PointXYZ) (pcl::PointXYZI) (pcl::PointXYZRGB) (pcl::PointXYZRGBA) (pcl::PointXYZRGBL) (
                     pcl::PointNormal) (pcl::PointXYZRGBNormal) (pcl::PointXYZINormal))
