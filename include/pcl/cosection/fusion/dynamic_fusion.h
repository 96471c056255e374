// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/io/rgbd_sequence.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace pcl::cosection {

class FrameSegmenter;

/** \brief A class of things, and how certain it is that something belongs to it. */
struct PCL_COSECTION_EXPORT ClassScore
{
  int class_id = 0;       ///< as the network counts
  std::string class_name; ///< its number where there are no names
  double score = 0.0;     ///< in [0, 1]
};

/** \brief How points are shared out among models. */
struct PCL_COSECTION_EXPORT AssociationOptions
{
  double sigma_m = 0.02; ///< scale of the Laplace distribution of distances; at least the noise of the reading's depth
  double inlier_share = 0.8;    ///< alpha: of readings that show a model at all
  double uniform = 1.0;         ///< density of the others, 1 / m
  double free_truncation = 0.9; ///< distances above this fraction of the truncation distance are seen free
  int threads = 0;              ///< 0: all; no result depends on it

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief How DynamicFusion follows a scene. */
struct PCL_COSECTION_EXPORT DynamicFusionOptions
{
  int background_resolution = 256;        ///< voxels along each axis
  double background_voxel_size_m = 0.0;   ///< 0: so that the volume holds the first frame, up to 0.02
  double background_truncation_vox = 5.0; ///< distances are cut off at this many voxels
  bool objects = true;    ///< there will be masks or a segmenter; without, the background takes less time and memory
  int segment_every = 10; ///< frames, from one in which the segmenter is asked for objects to the next
  int object_resolution = 64;         ///< voxels along each axis, at first
  int max_object_resolution = 160;    ///< to which volumes grow
  double object_truncation_vox = 5.0; ///< wider ones bias poses
  double max_weight = 64.0;           ///< of a voxel
  double max_depth_m = 10.0;          ///< readings beyond are left out
  bool smooth_depth = true;           ///< track with bilaterally filtered depth; what is mapped is not filtered
  int tracking_points = 80000;        ///< of a frame, at most
  bool persistent_ids = false;        ///< an instance has the same number in all masks, that of its object
  int min_object_pixels = 1600;       ///< of a new object, in an image of 640 x 480; in proportion in others
  double max_object_depth_m = 5.0;    ///< of a new object, mean
  double min_mask_iou = 0.2;          ///< from which on an instance shows an object
  double max_volume_iou = 0.5;        ///< from which on a new object would be one that is there
  double min_existence = 0.1;         ///< below, an object is given up
  double min_association = 0.1;       ///< mean over its pixels; below, an object is given up
  int max_objects = 64;               ///< at a time
  AssociationOptions association;     ///< of points to models
  Eigen::Isometry3d first_pose = Eigen::Isometry3d::Identity (); ///< T_world_camera of the first frame
  int threads = 0;                                               ///< 0: all; no result depends on it

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief What DynamicFusion knows of a frame. */
struct PCL_COSECTION_EXPORT TrackedFrame
{
  /** \brief A pixel that is neither the background's nor a known object's. */
  static constexpr std::uint16_t unassigned = std::numeric_limits<std::uint16_t>::max ();

  std::optional<Eigen::Isometry3d> T_world_camera; ///< nothing: tracking failed
  std::map<int, Eigen::Isometry3d> T_world_object; ///< of the objects that were tracked in this frame
  Image<std::uint16_t> instances;                  ///< id of the object, 0: background; empty if tracking failed
  bool masked = false;                             ///< a mask had a part in it
  bool only_objects = false; ///< nothing else has readings, so that the camera was taken to be at rest
  double inlier_share = 0.0; ///< of the points that the camera was tracked with
  int lost = 0;              ///< objects that should be in view and are not found
};

/** \brief The front end: tracks the camera and every object through RGB-D frames, and maps them, without given poses.
 *
 * Per frame: association likelihoods, tracking of the camera against the background, association again, tracking of
 * each object relative to the camera, segmentation by association; where there is a mask, instances are matched with
 * objects, new objects begin and existence probabilities change; then depth is integrated into the volumes. After M.
 * Strecke, J. Stueckler, "EM-Fusion: Dynamic Object-Level SLAM with Probabilistic Data Association", ICCV 2019.
 *
 * A pose is believed if enough points fit, and it is no jump; of an object, if readings confirm its surface as well.
 * What is lost is neither mapped, nor part of the background: it is looked for where it was, and among the instances of
 * masks that match nothing.
 *
 * \code
 * DynamicFusion fusion (images.camera ());
 * for (const auto& frame : frames)
 *   use (fusion.process (frame, mask_of (frame)));
 * \endcode
 * O (pixels + voxels in view) per frame. Not for two threads at once. */
class PCL_COSECTION_EXPORT DynamicFusion
{
public:
  /** \brief Begin with an empty map. \throws InvalidArgument as DynamicFusionOptions::validate () and
   * PinholeCamera::validate () */
  explicit DynamicFusion (const PinholeCamera& camera, const DynamicFusionOptions& options = {});
  ~DynamicFusion ();
  /** \brief Takes over what the other one has. */
  DynamicFusion (DynamicFusion&& other) noexcept;
  /** \brief Takes over what the other one has. */
  DynamicFusion& operator= (DynamicFusion&& other) noexcept;

  /** \brief Find objects in frames that come without a mask. What it notes is among the events. \param[in] segmenter
   * null: none */
  void setSegmenter (std::shared_ptr<FrameSegmenter> segmenter);

  /** \brief Track and map the next frame.
   * \param[in] frame in the order of time
   * \param[in] mask instances of the frame, 0: none, FrameSegmenter::ignored: neither objects nor background;
   * null: there is no mask
   * \return valid until the next call
   * \throws InvalidArgument if the depth or a mask is not of the camera's size; what the segmenter throws */
  const TrackedFrame& process (const RgbdFrame& frame, const Image<std::uint16_t>* mask = nullptr);

  /** \brief Numbers of the objects that are tracked or looked for. */
  std::set<int> objects () const;

  /** \brief Numbers of all objects that were found so far and not given up as wrong. */
  std::set<int> foundObjects () const;

  /** \brief Instances of given masks that have shown no object in any of them, and why they began none when they were
   * first seen. */
  std::map<std::uint16_t, std::string> refusedInstances () const;

  /** \brief Surface of an object as it was seen, object frame; empty without an object of that number. */
  TriangleMesh surfaceMesh (int id) const;

  /** \brief What an object is, by the detections of it; nothing if there is no object of that number, or no segmenter
   * has named its class. */
  std::optional<ClassScore> objectClass (int id) const;

  /** \brief What was seen of the background, world frame. */
  TriangleMesh backgroundMesh () const;

  /** \brief Lines about what was decided, with reasons: the first hundred, then how many more. */
  std::vector<std::string> events () const;

  /** \brief Seconds: tracking, segmentation, integration. */
  const std::map<std::string, double>& timings () const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace pcl::cosection
