// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/fusion/co_section_backend.h>
#include <pcl/cosection/fusion/dynamic_fusion.h>
#include <pcl/cosection/fusion/keyframe.h>
#include <pcl/cosection/io/rgbd_sequence.h>
#include <pcl/cosection/io/trajectory.h>
#include <pcl/cosection/volume/tsdf_volume.h>

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief A sequence and what is known beside its images. */
struct PCL_COSECTION_EXPORT KnownSequence
{
  const RgbdSequence* images = nullptr; ///< must be set, and live as long as this is used
  const MaskSequence* masks = nullptr;  ///< a pixel is the id of an object, the same in all frames; null: no objects
  std::vector<StampedPose> camera;      ///< T_world_camera, by ascending stamps
  /** \brief T_world_object, by id and by ascending stamps. An object of the masks that is not among them is at rest. */
  std::map<int, std::vector<StampedPose>> objects;
};

/** \brief A sequence of which poses are not known. */
struct PCL_COSECTION_EXPORT TrackedSequence
{
  /** \brief A sequence. \param[in] images, masks must live as long as this is used */
  explicit TrackedSequence (const RgbdSequence& images, const MaskSequence* masks = nullptr)
      : images (&images)
      , masks (masks)
  {}

  const RgbdSequence* images; ///< never null
  /** \brief A pixel is the number of an instance, which may be another in the next mask; not every frame needs one.
   * Null: no objects. */
  const MaskSequence* masks;
  std::shared_ptr<FrameSegmenter> segmenter; ///< finds objects in frames without a mask; null: none
};

/** \brief Whether SequenceFusion completes everything at keyframes, too, not only at the end. The last result does not
 * depend on it. */
enum class KeyframeUpdates
{
  None,
  InStep, ///< each keyframe waits for its update: the same updates in every run
  Beside, ///< in a thread beside the front end; keyframes that come during an update are completed together in the next
};

/** \brief Where an object's TSDF volume lies. */
struct PCL_COSECTION_EXPORT ObjectTsdfOptions
{
  int resolution = 64;      ///< voxels along the longest side of what is seen first
  double margin = 0.25;     ///< of the volume beyond what was seen, as a fraction of its longest side
  int max_resolution = 256; ///< voxels along a side; what lies beyond is left out
  TsdfOptions tsdf;         ///< of the volume

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief How SequenceFusion goes through a sequence. */
struct PCL_COSECTION_EXPORT FusionOptions
{
  BackendOptions backend;         ///< of the completion
  KeyframeOptions keyframe;       ///< what keyframes take from frames
  ObjectTsdfOptions tsdf;         ///< of objects with given poses
  DynamicFusionOptions front_end; ///< where poses are not given
  FrameRange frames;              ///< which are used
  Image<std::uint8_t>
      ignored; ///< not 0: a pixel that is not read in any frame, as of something fixed to the camera; empty: all are
  int keyframe_every = 10;                         ///< frames; where one has no mask or no pose, the next that has
  KeyframeUpdates updates = KeyframeUpdates::None; ///< whether keyframes complete everything, too

  FusionOptions ();

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief One object of a sequence beside its completion. */
struct PCL_COSECTION_EXPORT FusedObject
{
  std::vector<StampedPose> trajectory;  ///< T_world_object at the frames at which it is known
  TriangleMesh tsdf;                    ///< open mesh of what was seen, object frame
  std::size_t points = 0;               ///< in all keyframes
  std::optional<ClassScore> best_class; ///< what it is, if a segmenter has named its class
};

/** \brief What SequenceFusion makes of a sequence. */
struct PCL_COSECTION_EXPORT FusionResult
{
  SceneResult scene;                  ///< everything that is completed
  std::vector<StampedPose> camera;    ///< at the frames that were used
  PinholeCamera intrinsics;           ///< of the images
  std::map<int, FusedObject> objects; ///< by id
  std::size_t frames = 0;             ///< that were used
  std::size_t frames_left_out = 0;    ///< that were not, as they have no pose or cannot be read
  std::size_t keyframes = 0;          ///< of them
  std::size_t kept_keyframes = 0;     ///< of them, in the result
  /** \brief read, tracking, raycast (0: models are projected, in tracking), segmentation, integration, keyframes,
   * updates (beside the others, unless in step), final_solve, and those of the scene. */
  std::map<std::string, double> timings_s;
  bool tracked = false;              ///< poses were not given
  std::vector<std::string> events;   ///< what tracking decided, and why
  std::vector<std::string> warnings; ///< one line each
  std::string why_no_object;         ///< if masks were given and no object came of them; else empty
};

/** \brief What is known after a keyframe. */
struct KeyframeReport
{
  double stamp;             ///< of the last keyframe in it
  const SceneResult& scene; ///< everything that is completed
};

/** \brief What is known after a frame. */
struct FrameReport
{
  const RgbdFrame& frame;                                 ///< as it was read
  const Eigen::Isometry3d& T_world_camera;                ///< metres
  const std::map<int, Eigen::Isometry3d>& T_world_object; ///< of the objects that are known in the frame
  const Image<std::uint16_t>* instances; ///< id of the object, 0: background; empty: all is; null: not known
  bool keyframe;                         ///< its points are used
  /** \brief What was seen of an object so far, its frame; empty if nothing. Takes some ten milliseconds; to be called
   * while the report is there. */
  std::function<TriangleMesh (int id)> seen;
};

/** \brief Goes through a sequence and completes the objects in it and the background. Poses and masks are known, or the
 * camera and the objects are tracked (DynamicFusion).
 *
 * Each frame gives free space, and distances for the objects' TSDF volumes; keyframes give oriented points as well.
 * Frames that cannot be read, or without the camera's pose, are left out, and so are objects of fewer than 100 points;
 * warnings name them.
 *
 * \code
 * KnownSequence known;
 * known.images = &images;
 * known.camera = loadTrajectory ("gt-cam-0.txt");
 * const FusionResult result = SequenceFusion (known).run ();
 * \endcode */
class PCL_COSECTION_EXPORT SequenceFusion
{
public:
  /** \brief Takes what is known after a keyframe. */
  using KeyframeCallback = std::function<void (const KeyframeReport&)>;
  /** \brief Takes what is known after a frame. */
  using FrameCallback = std::function<void (const FrameReport&)>;

  /** \brief Use known poses. \throws InvalidArgument if an option is outside its domain, there are no images, the
   * ignored pixels are not of their size, or no pose of the camera is for any frame of the range */
  explicit SequenceFusion (KnownSequence sequence, const FusionOptions& options = {});

  /** \brief Track the camera and the objects. \throws InvalidArgument if an option is outside its domain, the ignored
   * pixels are not of the images' size, or there are no frames in the range */
  explicit SequenceFusion (const TrackedSequence& sequence, const FusionOptions& options = {});

  /** \brief Go through the sequence and complete everything.
   * \param[in] progress called now and then, may cancel
   * \param[in] keyframe called after every update, if those are asked for; from the calling thread
   * \param[in] frame called after every frame that is used, from the calling thread; without influence on the result
   * \throws IoError if no frame can be used, no mask, or no keyframe has a point; Cancelled */
  FusionResult run (const ProgressCallback& progress = {}, const KeyframeCallback& keyframe = {},
                    const FrameCallback& frame = {}) const;

private:
  KnownSequence sequence_;
  std::optional<TrackedSequence> tracked_; ///< instead
  FusionOptions options_;
};

/** \brief Tracks the camera and the objects of frames that come one by one, as from a camera, and completes what they
 * have shown: what SequenceFusion does with a tracked sequence.
 *
 * \code
 * OnlineFusion fusion (camera);
 * while (const auto frame = sensor.next ())
 *   fusion.add (*frame, maskOf (*frame));
 * const FusionResult result = fusion.complete ();
 * \endcode
 * Not for two threads at once. */
class PCL_COSECTION_EXPORT OnlineFusion
{
public:
  /** \brief Begin with nothing. \param[in] camera of all frames \param[in] options their frames and updates are not
   * used; DynamicFusionOptions::objects says whether there will be masks \param[in] segmenter finds objects in frames
   * without a mask; null: none \throws InvalidArgument if an option or the camera is not valid */
  explicit OnlineFusion (const PinholeCamera& camera, const FusionOptions& options = {},
                         std::shared_ptr<FrameSegmenter> segmenter = nullptr);
  ~OnlineFusion ();
  /** \brief Takes over what the other one has. */
  OnlineFusion (OnlineFusion&& other) noexcept;
  /** \brief Takes over what the other one has. */
  OnlineFusion& operator= (OnlineFusion&& other) noexcept;

  /** \brief Track, segment and map the next frame.
   * \param[in] frame of the camera's size, with a larger stamp than the one before; its index is not used
   * \param[in] mask a pixel is the number of an instance; null: the frame has none
   * \param[in] on_frame called if the frame is used
   * \return whether it is: false if the camera could not be tracked
   * \throws InvalidArgument if a size or the stamp is wrong; nothing is changed then */
  bool add (RgbdFrame frame, const Image<std::uint16_t>* mask = nullptr,
            const SequenceFusion::FrameCallback& on_frame = {});

  /** \brief Complete everything that was shown so far; further frames may follow.
   * \throws DegenerateInput if no frame could be tracked, or none shows a surface; Cancelled */
  FusionResult complete (const ProgressCallback& progress = {});

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace pcl::cosection
