// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/segmentation/instance_detector.h>
#include <pcl/cosection/segmentation/instance_labels.h>

#include <pcl/PointIndices.h>
#include <pcl/pcl_base.h>
#include <pcl/point_cloud.h>

#include <memory>
#include <vector>

namespace pcl
{
struct Label;

namespace cosection
{

/** \brief Finds the objects in an organised, coloured cloud with an instance segmentation network; InstanceDetector
 * says which.
 *
 * \code
 * pcl::cosection::InstanceDetectorOptions network;
 * network.model = "yolov5s-seg.onnx";
 * network.detection.class_names = pcl::cosection::loadClassNames ("coco.names");
 * pcl::cosection::InstanceSegmentation<pcl::PointXYZRGB> segmentation;
 * segmentation.setNetwork (network);
 * segmentation.setInputCloud (cloud); // organised, with colours
 * pcl::PointCloud<pcl::Label> labels;
 * std::vector<pcl::PointIndices> label_indices;
 * segmentation.segment (labels, label_indices); // label_indices[0] are the points of object 1
 * segmentation.getInstances ()[0].class_name;   // and this is what it is
 * \endcode
 *
 * setIndices () works: other points belong to nothing. The network sees all colours.
 *
 * Instantiated for pcl::PointXYZRGB, PointXYZRGBA, PointXYZRGBL and PointXYZRGBNormal; for other types with colours
 * define PCL_NO_PRECOMPILE before the include. */
template <typename PointT> class PCL_COSECTION_EXPORT InstanceSegmentation : public PCLBase<PointT>
{
  using Base = PCLBase<PointT>;

public:
  using Ptr = shared_ptr<InstanceSegmentation<PointT>>;
  using ConstPtr = shared_ptr<const InstanceSegmentation<PointT>>;
  using PointCloud = pcl::PointCloud<PointT>;

  /** \brief Read the network, and say what becomes of its classes. \throws InvalidArgument, IoError */
  void setNetwork (const InstanceDetectorOptions& options, const ClassRoles& roles = {});

  /** \brief Find the objects.
   * \param[out] labels one per point of the input cloud, of its width and height: 0 none, 1 ... objects, ignored_label
   * \param[out] label_indices points of each object, in their order; those of label n are label_indices[n - 1]
   *
   * Without a network or an organised input cloud with colours, and if the network cannot be run, this says so on PCL's
   * console, and both are empty. That nothing is found is no error: all labels are 0 then. */
  void segment (pcl::PointCloud<pcl::Label>& labels, std::vector<pcl::PointIndices>& label_indices);

  /** \brief Classes, scores and whole masks of the objects that the last segment () found: those of label n are at n
   * - 1. */
  const std::vector<DetectedInstance>& getInstances () const { return instances_; }

protected:
  using Base::deinitCompute;
  using Base::indices_;
  using Base::initCompute;
  using Base::input_;

private:
  std::shared_ptr<InstanceDetector> detector_; // shared by copies
  ClassRoles roles_;
  std::vector<DetectedInstance> instances_;
};

} // namespace cosection
} // namespace pcl

#ifdef PCL_NO_PRECOMPILE
#include <pcl/cosection/segmentation/impl/instance_segmentation.hpp>
#else
namespace pcl
{
struct PointXYZRGB;
struct PointXYZRGBA;
struct PointXYZRGBL;
struct PointXYZRGBNormal;
namespace cosection
{
extern template class PCL_COSECTION_EXPORT InstanceSegmentation<pcl::PointXYZRGB>;
extern template class PCL_COSECTION_EXPORT InstanceSegmentation<pcl::PointXYZRGBA>;
extern template class PCL_COSECTION_EXPORT InstanceSegmentation<pcl::PointXYZRGBL>;
extern template class PCL_COSECTION_EXPORT InstanceSegmentation<pcl::PointXYZRGBNormal>;
} // namespace cosection
} // namespace pcl
#endif
