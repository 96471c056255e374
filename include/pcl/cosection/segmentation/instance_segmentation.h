// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/image.h>
#include <pcl/cosection/common/point_types.h>
#include <pcl/cosection/segmentation/instance_detector.h>

#include <pcl/PointIndices.h>
#include <pcl/pcl_base.h>
#include <pcl/point_cloud.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace pcl {
struct Label;
}

namespace pcl::cosection {

/** \brief The network and last result of InstanceSegmentation, which do not depend on the type of its points.
 *
 * A setter that cannot use what it gets says why through PCL's console, changes nothing and returns false. */
class PCL_COSECTION_EXPORT InstanceSegmentationBase
{
public:
  /** \brief Read the network, and set what becomes of its classes.
   * \return false if an option or a role is not valid, or the file cannot be read as a network */
  bool setNetwork (const InstanceDetectorOptions& options, const ClassRoles& roles = {});

  /** \brief Set the number of threads that run the network, in place of InstanceDetectorOptions::threads; 0 (default):
   * all processors. With more than one, the network's last digits depend on how many. A network that is there is read
   * again.
   * \return false if that fails */
  bool setNumberOfThreads (unsigned int threads = 0);

  /** \brief Classes, scores and whole masks of the objects that the last segment () found: those of label n are at n
   * - 1. */
  const std::vector<DetectedInstance>& getInstances () const { return instances_; }

protected:
  InstanceSegmentationBase () = default;
  ~InstanceSegmentationBase () = default;

  /** \brief Whether there are a network and an organised cloud; says so if not. Forgets the last result. */
  bool begin (bool input, unsigned int height);

  /** \brief Run the network on the colours of a cloud where readings are not 0; empty outputs, with a message, if that
   * fails or all is black. */
  void segmentPicture (const Picture& picture, const Image<std::uint8_t>& readings, const pcl::PCLHeader& header,
                       pcl::PointCloud<pcl::Label>& labels, std::vector<pcl::PointIndices>& label_indices);

private:
  std::shared_ptr<InstanceDetector> detector_; // shared by copies
  ClassRoles roles_;
  std::optional<int> threads_;
  std::vector<DetectedInstance> instances_;
};

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
 * Compiled for pcl::PointXYZRGB, PointXYZRGBA, PointXYZRGBL and PointXYZRGBNormal; works for other types with colours
 * where pcl::PCLBase does (define PCL_NO_PRECOMPILE before the include). */
template <typename PointT>
class PCL_COSECTION_EXPORT InstanceSegmentation : public PCLBase<PointT>, public InstanceSegmentationBase
{
  using Base = PCLBase<PointT>;

public:
  /** \brief Shared pointer. */
  using Ptr = shared_ptr<InstanceSegmentation<PointT>>;
  /** \brief Shared pointer to what is constant. */
  using ConstPtr = shared_ptr<const InstanceSegmentation<PointT>>;
  /** \brief Cloud of the points. */
  using PointCloud = pcl::PointCloud<PointT>;

  /** \brief Find the objects.
   *
   * Without a network or an organised input cloud with colours, and if the network cannot be run, this says so on PCL's
   * console, and both outputs are empty. That nothing is found is no error: all labels are 0 then.
   * \param[out] labels one per point of the input cloud, of its width and height: 0 none, 1 ... objects, ignored_label
   * \param[out] label_indices points of each object, in their order; those of label n are label_indices[n - 1] */
  void segment (pcl::PointCloud<pcl::Label>& labels, std::vector<pcl::PointIndices>& label_indices);

protected:
  using Base::deinitCompute;
  using Base::indices_;
  using Base::initCompute;
  using Base::input_;
};

template <typename PointT>
void
InstanceSegmentation<PointT>::segment (pcl::PointCloud<pcl::Label>& labels,
                                       std::vector<pcl::PointIndices>& label_indices)
{
  labels.clear ();
  label_indices.clear ();
  if (!begin (input_ != nullptr, input_ ? input_->height : 0) || !initCompute ())
    return;
  Picture picture (static_cast<int> (input_->width), static_cast<int> (input_->height));
  for (std::size_t i = 0; i < input_->size (); ++i)
    picture.pixels[i] = {(*input_)[i].r, (*input_)[i].g, (*input_)[i].b};
  Image<std::uint8_t> readings (picture.width, picture.height, 0);
  for (const auto i : *indices_)
    readings.pixels[i] = (*input_)[i].getVector3fMap ().allFinite () ? 1 : 0;
  deinitCompute ();
  segmentPicture (picture, readings, input_->header, labels, label_indices);
}

BOOST_PP_SEQ_FOR_EACH (PCL_COSECTION_EXTERN_TEMPLATE, InstanceSegmentation, PCL_COSECTION_RGB_POINT_TYPES)

} // namespace pcl::cosection
