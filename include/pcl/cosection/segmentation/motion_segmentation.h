// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/segmentation/moving_body_finder.h>

#include <pcl/PointIndices.h>
#include <pcl/pcl_base.h>
#include <pcl/point_cloud.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace pcl
{
struct Label;

namespace cosection
{

/** \brief Finds rigid bodies in a stream of organised clouds by their motion, while the sensor may move, too.
 * MovingBodyFinder says how.
 *
 * \code
 * pcl::cosection::MotionSegmentation<pcl::PointXYZRGB> segmentation;
 * for (const auto& cloud : clouds) // organised, in the sensor's frame, metres
 * {
 *   segmentation.setInputCloud (cloud);
 *   segmentation.setSensorPose (T_world_sensor); // or the cloud's own sensor_origin_ and sensor_orientation_
 *   pcl::PointCloud<pcl::Label> labels;
 *   std::vector<pcl::PointIndices> label_indices;
 *   segmentation.segment (labels, label_indices); // label_indices[0] are the points of body 1
 * }
 * \endcode
 *
 * setIndices () works: other points count as no reading. Instantiated for pcl::PointXYZ, PointXYZI, PointXYZRGB,
 * PointXYZRGBA, PointXYZRGBL, PointNormal, PointXYZRGBNormal and PointXYZINormal; for other types define
 * PCL_NO_PRECOMPILE before the include. */
template <typename PointT> class PCL_COSECTION_EXPORT MotionSegmentation : public PCLBase<PointT>
{
  using Base = PCLBase<PointT>;

public:
  using Ptr = shared_ptr<MotionSegmentation<PointT>>;
  using ConstPtr = shared_ptr<const MotionSegmentation<PointT>>;
  using PointCloud = pcl::PointCloud<PointT>;

  /** \brief All parameters in one; what was seen is forgotten. \throws InvalidArgument */
  void setOptions (const MotionSegmentationOptions& options);

  /** \brief Where the sensor of the next cloud is; default: what the cloud says itself. */
  void setSensorPose (const Eigen::Isometry3d& T_world_sensor) { T_world_sensor_ = T_world_sensor; }

  /** \brief The sensor; default: that which fits the cloud best. It saves the fit. */
  void setCamera (const PinholeCamera& camera) { camera_ = camera; }

  /** \brief What is known of the next cloud: the body whose model explains a point, 0: none does; and where those
   * bodies are. */
  void setKnownBodies (const std::vector<std::uint32_t>& bodies,
                       const std::map<std::uint32_t, Eigen::Isometry3d>& T_world_body)
  {
    bodies_ = bodies;
    T_world_body_ = T_world_body;
  }

  /** \brief Depth of each point of the next cloud by a model of the room, metres; NaN: nothing. */
  void setExpectedDepth (const std::vector<float>& depth) { expected_depth_ = depth; }

  /** \brief Look at the cloud without looking for bodies in it: where that is wanted now and then only.
   * \throws InvalidArgument if there is no organised cloud, it has no readings or is no pinhole camera's image, sizes
   * do not agree, or a pose is not a finite rigid motion; the cloud is left out then */
  void add ();

  /** \brief Look at the cloud, and find the moving bodies in it.
   * \param[out] labels one per point of the input cloud, of its width and height: 0 at rest, 1 ... bodies,
   * MotionSegments::unexplained: what moves otherwise. A body keeps its label from call to call
   * \param[out] label_indices points of each body; those of label n are label_indices[n - 1]. Empty while nothing moves
   * \throws InvalidArgument as add () */
  void segment (pcl::PointCloud<pcl::Label>& labels, std::vector<pcl::PointIndices>& label_indices);

protected:
  using Base::deinitCompute;
  using Base::indices_;
  using Base::initCompute;
  using Base::input_;

private:
  MovingBodyFinder finder_;
  std::optional<Eigen::Isometry3d> T_world_sensor_; // these are of the next cloud
  std::optional<PinholeCamera> camera_;
  std::vector<std::uint32_t> bodies_;
  std::map<std::uint32_t, Eigen::Isometry3d> T_world_body_;
  std::vector<float> expected_depth_;

public:
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

} // namespace cosection
} // namespace pcl

#ifdef PCL_NO_PRECOMPILE
#include <pcl/cosection/segmentation/impl/motion_segmentation.hpp>
#else
namespace pcl
{
struct PointXYZ;
struct PointXYZI;
struct PointXYZRGB;
struct PointXYZRGBA;
struct PointXYZRGBL;
struct PointNormal;
struct PointXYZRGBNormal;
struct PointXYZINormal;
namespace cosection
{
extern template class PCL_COSECTION_EXPORT MotionSegmentation<pcl::PointXYZ>;
extern template class PCL_COSECTION_EXPORT MotionSegmentation<pcl::PointXYZI>;
extern template class PCL_COSECTION_EXPORT MotionSegmentation<pcl::PointXYZRGB>;
extern template class PCL_COSECTION_EXPORT MotionSegmentation<pcl::PointXYZRGBA>;
extern template class PCL_COSECTION_EXPORT MotionSegmentation<pcl::PointXYZRGBL>;
extern template class PCL_COSECTION_EXPORT MotionSegmentation<pcl::PointNormal>;
extern template class PCL_COSECTION_EXPORT MotionSegmentation<pcl::PointXYZRGBNormal>;
extern template class PCL_COSECTION_EXPORT MotionSegmentation<pcl::PointXYZINormal>;
} // namespace cosection
} // namespace pcl
#endif
