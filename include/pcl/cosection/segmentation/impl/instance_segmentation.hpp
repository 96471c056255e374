// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/segmentation/instance_segmentation.h>

#include <pcl/common/point_tests.h>
#include <pcl/console/print.h>
#include <pcl/impl/pcl_base.hpp>
#include <pcl/point_types.h>

#include <algorithm>
#include <array>

namespace pcl::cosection
{

template <typename PointT>
void
InstanceSegmentation<PointT>::setNetwork (const InstanceDetectorOptions& options, const ClassRoles& roles)
{
  roles.validate (options.detection.class_names);
  detector_ = std::make_shared<InstanceDetector> (options);
  roles_ = roles;
}

template <typename PointT>
void
InstanceSegmentation<PointT>::segment (pcl::PointCloud<pcl::Label>& labels,
                                       std::vector<pcl::PointIndices>& label_indices)
{
  const char* const name = "cosection::InstanceSegmentation::segment";
  labels.clear ();
  label_indices.clear ();
  instances_.clear ();
  if (!detector_)
  {
    PCL_ERROR ("[pcl::%s] There is no network.\n", name);
    return;
  }
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
  Picture picture (static_cast<int> (input_->width), static_cast<int> (input_->height));
  std::transform (input_->begin (), input_->end (), picture.pixels.begin (),
                  [] (const PointT& p) -> std::array<std::uint8_t, 3> {
                    return {p.r, p.g, p.b};
                  });
  if (std::all_of (picture.pixels.begin (), picture.pixels.end (),
                   [] (const auto& c) { return (c[0] == 0 && c[1] == 0 && c[2] == 0); }))
  {
    PCL_ERROR ("[pcl::%s] The input cloud has no colours: all of it is black.\n", name);
    return;
  }
  if (!initCompute ())
    return;
  Image<std::uint8_t> readings (picture.width, picture.height, 0);
  for (const auto i : *indices_)
    readings.pixels[i] = pcl::isXYZFinite ((*input_)[i]) ? 1 : 0;
  deinitCompute ();

  std::vector<DetectedInstance> found;
  try
  {
    found = detector_->detect (picture);
  }
  catch (const Error& error)
  {
    PCL_ERROR ("[pcl::%s] %s.\n", name, error.what ());
    return;
  }
  const InstanceLabels labelled = labelInstances (found, picture.width, picture.height, roles_, readings);
  for (const std::size_t n : labelled.instances)
    instances_.push_back (std::move (found[n]));
  labels.header = input_->header;
  labels.resize (input_->size ());
  labels.width = input_->width;
  labels.height = input_->height;
  label_indices.resize (instances_.size ());
  for (pcl::PointIndices& indices : label_indices)
    indices.header = input_->header;
  for (std::size_t i = 0; i < labels.size (); ++i)
  {
    const std::uint16_t label = labelled.labels.pixels[i];
    labels[i].label = label;
    if (label > 0 && label != ignored_label)
      label_indices[label - 1].indices.push_back (static_cast<pcl::index_t> (i));
  }
}

} // namespace pcl::cosection

#define PCL_INSTANTIATE_CosectionInstanceSegmentation(T) template class pcl::cosection::InstanceSegmentation<T>;
