// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/point_types.h>

#include <pcl/PointIndices.h>
#include <pcl/pcl_base.h>
#include <pcl/point_cloud.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace pcl {
struct Label;
}

namespace pcl::cosection {

/** \brief Parameters of MovingBodyFinder. */
struct PCL_COSECTION_EXPORT MotionSegmentationOptions
{
  int window = 30;           ///< frames that a frame is compared with, at most: what moves less in them is at rest
  int min_pixels = 400;      ///< of an image of 640 x 480 that must show motion plainly; in proportion in others
  double significance = 3.0; ///< standard deviations of the depth's noise, from which on a reading is plainly elsewhere
  double max_object_size_m = 1.0;  ///< planes that are longer are the room's
  double concave_angle_rad = 0.45; ///< a crease that is concave by more than this joins nothing
  int threads = 0;                 ///< 0: all; no result depends on it

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief A frame of an organised depth sensor, and what is known of it. */
struct PCL_COSECTION_EXPORT MotionFrame
{
  PinholeCamera camera;                ///< of the frame
  std::vector<Eigen::Vector3f> points; ///< one per pixel, row by row, sensor frame, metres; not finite: no reading
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity (); ///< pose of the sensor, metres

  /** \brief One per pixel: the moving body whose model explains the reading, 0: none does, or the room's; empty: none
   * is known. */
  std::vector<std::uint32_t> bodies;
  std::map<std::uint32_t, Eigen::Isometry3d> T_world_body; ///< of those bodies that were tracked

  /** \brief One per pixel, metres: what a model of the room predicts, NaN: nothing; empty: there is no model. Motion
   * that is too slow for the window shows against it, as long as the model does not follow. */
  std::vector<float> expected_depth;

  /** \brief Check all values. \throws InvalidArgument naming what does not fit: sizes, a pose that is not a finite
   * rigid motion, no reading at all */
  void validate () const;
};

/** \brief What MovingBodyFinder finds in a frame. */
struct PCL_COSECTION_EXPORT MotionSegments
{
  /** \brief Neither at rest, nor moved as a whole by any motion that was found. */
  static constexpr std::uint32_t unexplained = 0xffffffffu;

  std::vector<std::uint32_t>
      labels; ///< one per pixel: 0 at rest, known bodies their number, others numbers that are free, or the above
};

/** \brief Finds rigid bodies in a stream of depth images by their motion: what begins to move, and what moves away from
 * what it touched.
 *
 * A frame is compared with some of the last ones, which need not show it from the same place. Readings where an earlier
 * frame has seen through, by more than the noise allows, have moved there. They begin hypotheses: the surface around
 * them, of patches that meet smoothly or at convex edges (see segmentObjects ()), is aligned with each of the earlier
 * frames, by its surface and by its outline, so that what slides in itself is found, too. Then each patch votes between
 * rest and this motion, by what either says its readings should have been; patches that both explain, such as the top
 * of a box on the floor, follow those they are smoothly or convexly joined to: the minimum of
 *
 *     sum_i a_i (x_i - y_i)^2 + lambda sum_ij w_ij (x_i - x_j)^2,   x_i > 1/2: moves
 *
 * with the votes y_i in {0, 1}, their strength a_i, and the length of common borders w_ij (after L. Grady, "Multilabel
 * Random Walker Image Segmentation Using Prior Models", CVPR 2005). The remaining points begin the next hypothesis.
 * Surface that comes in sight behind something that moves away is not moving: nothing was seen free where it is.
 *
 * Known bodies come first: what moves as one of them and touches it, is a part of it.
 *
 * A body counts as moving as long as it was elsewhere in some frame of the window. O (pixels) per frame; frames are
 * reduced to about 320 pixels a row, and those of the window are kept: some 80 MB.
 *
 * \code
 * MovingBodyFinder finder;
 * for (const MotionFrame& frame : frames)
 * {
 *   finder.add (frame);
 *   const MotionSegments segments = finder.segment (); // if wanted
 * }
 * \endcode */
class PCL_COSECTION_EXPORT MovingBodyFinder
{
public:
  /** \brief No frames yet. \throws InvalidArgument as MotionSegmentationOptions::validate () */
  explicit MovingBodyFinder (const MotionSegmentationOptions& options = {});
  ~MovingBodyFinder ();
  /** \brief Takes over what the other one has. */
  MovingBodyFinder (MovingBodyFinder&& other) noexcept;
  /** \brief Takes over what the other one has. */
  MovingBodyFinder& operator= (MovingBodyFinder&& other) noexcept;

  /** \brief Look at the next frame. \throws InvalidArgument as MotionFrame::validate (); the frame is left out then */
  void add (const MotionFrame& frame);

  /** \brief The moving bodies in the last frame; nothing but known ones if there is only one frame, or none. A body
   * that was found in the last call keeps its number. */
  MotionSegments segment ();

  /** \brief Forget all frames. */
  void reset ();

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/** \brief The parameters and frames of MotionSegmentation, which do not depend on the type of its points.
 *
 * A setter that cannot use what it gets says why through PCL's console, changes nothing and returns false. */
class PCL_COSECTION_EXPORT MotionSegmentationBase
{
public:
  /** \brief Set all parameters at once; what was seen is forgotten. */
  bool setOptions (const MotionSegmentationOptions& options);

  /** \brief The parameters, as setOptions () and setNumberOfThreads () left them. */
  const MotionSegmentationOptions& getOptions () const { return options_; }

  /** \brief Set the number of threads; 0 (default): all processors. The result does not depend on it. What was seen is
   * forgotten. */
  bool setNumberOfThreads (unsigned int threads = 0);

  /** \brief Set where the sensor of the next cloud is, metres; default: what the cloud says itself. */
  void setSensorPose (const Eigen::Isometry3d& T_world_sensor) { T_world_sensor_ = T_world_sensor; }

  /** \brief Set the sensor; default: the one that fits the cloud best. It saves the fit. */
  void setCamera (const PinholeCamera& camera) { camera_ = camera; }

  /** \brief Set what is known of the next cloud.
   * \param[in] bodies one per point: the body whose model explains it, 0: none does
   * \param[in] T_world_body where these bodies are, metres, by their numbers */
  void setKnownBodies (const std::vector<std::uint32_t>& bodies,
                       const std::map<std::uint32_t, Eigen::Isometry3d>& T_world_body)
  {
    bodies_ = bodies;
    T_world_body_ = T_world_body;
  }

  /** \brief Set the depth of each point of the next cloud by a model of the room, metres; NaN: nothing. */
  void setExpectedDepth (const std::vector<float>& depth) { expected_depth_ = depth; }

protected:
  MotionSegmentationBase () = default;
  ~MotionSegmentationBase () = default;

  /** \brief MovingBodyFinder::add (), with the pose that the cloud itself gives unless another one was set.
   * \return false, with a message, if the frame is not valid */
  bool addPoints (std::vector<Eigen::Vector3f> points, unsigned int width, unsigned int height,
                  const Eigen::Isometry3d& T_world_sensor);

  /** \brief Say that there is no cloud. */
  void reportMissingInput () const;

  /** \brief MovingBodyFinder::segment () in PCL's types. */
  void segmentLast (const pcl::PCLHeader& header, unsigned int width, unsigned int height,
                    pcl::PointCloud<pcl::Label>& labels, std::vector<pcl::PointIndices>& label_indices);

private:
  MotionSegmentationOptions options_;
  MovingBodyFinder finder_;

  std::optional<Eigen::Isometry3d> T_world_sensor_; // these are of the next cloud
  std::optional<PinholeCamera> camera_;
  std::vector<std::uint32_t> bodies_;
  std::map<std::uint32_t, Eigen::Isometry3d> T_world_body_;
  std::vector<float> expected_depth_;
};

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
 * setIndices () works: other points count as no reading. A cloud that cannot be used is left out, and PCL's console
 * says why: it is missing or not organised, it has no readings or is no pinhole camera's image, sizes do not agree, or
 * a pose is not a finite rigid motion.
 *
 * Compiled for pcl::PointXYZ, PointXYZI, PointXYZRGB, PointXYZRGBA, PointXYZRGBL, PointNormal, PointXYZRGBNormal and
 * PointXYZINormal; works for others where pcl::PCLBase does (define PCL_NO_PRECOMPILE before the include). */
template <typename PointT>
class PCL_COSECTION_EXPORT MotionSegmentation : public PCLBase<PointT>, public MotionSegmentationBase
{
  using Base = PCLBase<PointT>;

public:
  /** \brief Shared pointer. */
  using Ptr = shared_ptr<MotionSegmentation<PointT>>;
  /** \brief Shared pointer to what is constant. */
  using ConstPtr = shared_ptr<const MotionSegmentation<PointT>>;
  /** \brief Cloud of the points. */
  using PointCloud = pcl::PointCloud<PointT>;

  /** \brief Look at the cloud without looking for bodies in it: where that is wanted now and then only.
   * \return false if the cloud is left out */
  bool add ();

  /** \brief Look at the cloud, and find the moving bodies in it.
   * \param[out] labels one per point of the input cloud, of its width and height: 0 at rest, 1 ... bodies,
   * MotionSegments::unexplained: what moves otherwise. A body keeps its label from call to call. Empty if the cloud is
   * left out
   * \param[out] label_indices points of each body; those of label n are label_indices[n - 1]. Empty while nothing moves
   */
  void segment (pcl::PointCloud<pcl::Label>& labels, std::vector<pcl::PointIndices>& label_indices);

protected:
  using Base::deinitCompute;
  using Base::indices_;
  using Base::initCompute;
  using Base::input_;

public:
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

template <typename PointT>
bool
MotionSegmentation<PointT>::add ()
{
  if (!input_ || !initCompute ())
  {
    reportMissingInput ();
    return false;
  }
  std::vector<Eigen::Vector3f> points (input_->size (),
                                       Eigen::Vector3f::Constant (std::numeric_limits<float>::quiet_NaN ()));
  for (const auto i : *indices_)
    if ((*input_)[i].getVector3fMap ().allFinite ())
      points[i] = (*input_)[i].getVector3fMap ();
  deinitCompute ();
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity ();
  T_world_sensor.linear () = input_->sensor_orientation_.template cast<double> ().toRotationMatrix ();
  T_world_sensor.translation () = input_->sensor_origin_.template head<3> ().template cast<double> ();
  return addPoints (std::move (points), input_->width, input_->height, T_world_sensor);
}

template <typename PointT>
void
MotionSegmentation<PointT>::segment (pcl::PointCloud<pcl::Label>& labels, std::vector<pcl::PointIndices>& label_indices)
{
  labels.clear ();
  label_indices.clear ();
  if (add ())
    segmentLast (input_->header, input_->width, input_->height, labels, label_indices);
}

BOOST_PP_SEQ_FOR_EACH (PCL_COSECTION_EXTERN_TEMPLATE, MotionSegmentation, PCL_COSECTION_XYZ_POINT_TYPES)

} // namespace pcl::cosection
