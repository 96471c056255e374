// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/segmentation/instance_segmentation.h>

#include "pcl_cosection/common/console_errors.h"

#include <pcl/impl/pcl_base.hpp>
#include <pcl/point_types.h>

#include <algorithm>
#include <thread>

namespace pcl::cosection {

bool
InstanceSegmentationBase::setNetwork (const InstanceDetectorOptions& options, const ClassRoles& roles)
{
  return reportErrors ("cosection::InstanceSegmentation::setNetwork", [&] {
    InstanceDetectorOptions network = options;
    network.threads = threads_.value_or (options.threads);
    roles.validate (network.detection.class_names);
    detector_ = std::make_shared<InstanceDetector> (network);
    roles_ = roles;
  });
}

bool
InstanceSegmentationBase::setNumberOfThreads (unsigned int threads)
{
  threads_ = static_cast<int> (threads > 0 ? threads : std::max (1u, std::thread::hardware_concurrency ()));
  return !detector_ || setNetwork (detector_->options (), roles_);
}

bool
InstanceSegmentationBase::begin (bool input, unsigned int height)
{
  instances_.clear ();
  if (!detector_)
    PCL_ERROR ("[pcl::cosection::InstanceSegmentation::segment] There is no network.\n");
  else if (!input)
    PCL_ERROR ("[pcl::cosection::InstanceSegmentation::segment] There is no input cloud.\n");
  else if (height <= 1)
    PCL_ERROR ("[pcl::cosection::InstanceSegmentation::segment] The input cloud is not organised: its height is %u.\n",
               height);
  return detector_ && input && height > 1;
}

void
InstanceSegmentationBase::segmentPicture (const Picture& picture, const Image<std::uint8_t>& readings,
                                          const pcl::PCLHeader& header, pcl::PointCloud<pcl::Label>& labels,
                                          std::vector<pcl::PointIndices>& label_indices)
{
  std::vector<DetectedInstance> found;
  InstanceLabels labelled;
  if (!reportErrors ("cosection::InstanceSegmentation::segment", [&] {
        if (std::all_of (picture.pixels.begin (), picture.pixels.end (),
                         [] (const auto& c) { return (c[0] == 0 && c[1] == 0 && c[2] == 0); }))
          throw InvalidArgument ("The input cloud has no colours: all of it is black");
        found = detector_->detect (picture);
        labelled = labelInstances (found, picture.width, picture.height, roles_, readings);
      }))
    return;
  for (const std::size_t n : labelled.instances)
    instances_.push_back (std::move (found[n]));
  labels.header = header;
  labels.resize (picture.pixels.size ());
  labels.width = static_cast<std::uint32_t> (picture.width);
  labels.height = static_cast<std::uint32_t> (picture.height);
  label_indices.resize (instances_.size ());
  for (pcl::PointIndices& indices : label_indices)
    indices.header = header;
  for (std::size_t i = 0; i < labels.size (); ++i)
  {
    const std::uint16_t label = labelled.labels.pixels[i];
    labels[i].label = label;
    if (label > 0 && label != ignored_label)
      label_indices[label - 1].indices.push_back (static_cast<pcl::index_t> (i));
  }
}

} // namespace pcl::cosection

BOOST_PP_SEQ_FOR_EACH (PCL_COSECTION_TEMPLATE, pcl::cosection::InstanceSegmentation, PCL_COSECTION_RGB_POINT_TYPES)
