// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/evaluation/penetration.h>
#include <pcl/cosection/evaluation/trajectory_error.h>
#include <pcl/cosection/io/trajectory.h>

#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief A scene of moving objects before a moving camera, true or estimated. */
struct PCL_COSECTION_EXPORT SceneRecord
{
  /** \brief A moving object. */
  struct Object
  {
    int id = 0;                     ///< unique, positive
    std::string name;               ///< for messages
    std::vector<StampedPose> poses; ///< T_world_object, by ascending stamps
    TriangleMesh mesh;              ///< the object's frame; empty: none
  };

  std::vector<StampedPose> camera;         ///< T_world_camera, by ascending stamps
  std::optional<PinholeCamera> intrinsics; ///< nothing: not known
  std::vector<Object> objects;             ///< in any order
  TriangleMesh background;                 ///< world frame; empty: none
};

/** \brief How far and how to refine. */
struct PCL_COSECTION_EXPORT RefinementOptions
{
  double max_distance_m = 0.02;    ///< farther points do not count
  double max_translation_m = 0.02; ///< of the centre of the points
  double max_rotation_rad = 0.1;   ///< angle of the whole motion
  int max_iterations = 50;         ///< Gauss-Newton steps
  int threads = 0;                 ///< 0: all

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief What a refinement did. */
struct PCL_COSECTION_EXPORT Refinement
{
  Eigen::Isometry3d correction = Eigen::Isometry3d::Identity (); ///< to be applied after the initial pose
  double translation_m = 0.0;                                    ///< of the centre of the points
  double rotation_rad = 0.0;                                     ///< angle of the motion
  double rmse_before_m = 0.0;                                    ///< of the points that are near enough, to the surface
  double rmse_after_m = 0.0;                                     ///< of the same points, after the motion
  bool limited = false; ///< a limit was reached; the last motion within it is the result
};

/** \brief How to evaluate a run. */
struct PCL_COSECTION_EXPORT RunOptions
{
  MeshComparisonOptions comparison;                          ///< of meshes
  TrajectoryOptions trajectory;                              ///< the alignment is that of the camera
  PenetrationOptions penetration = {2000, 3000, 0, 0.0, 64}; ///< of pairs of bodies
  RefinementOptions refinement;                              ///< of alignments
  bool measure_penetration = true;                           ///< of every pair of bodies, which takes longest
  bool refine = true;    ///< refine the alignment of each object on its observed surface
  int volume_frames = 5; ///< at most so many frames for the volume of each penetration
  int threads = 0;       ///< 0: all

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief How a mesh was brought into the frame of the truth. */
struct PCL_COSECTION_EXPORT FrameAlignment
{
  Eigen::Isometry3d T_truth_estimate = Eigen::Isometry3d::Identity (); ///< metres
  Refinement refinement;                                               ///< contained in the pose
  std::size_t frames = 0; ///< with poses of both, of which the median is the start
};

/** \brief An estimated mesh beside the true one. */
struct PCL_COSECTION_EXPORT MeshEvaluation
{
  FrameAlignment alignment;           ///< of the estimate
  MeshSummary truth;                  ///< the true mesh by itself
  MeshSummary estimate;               ///< the estimated mesh by itself
  MeshComparison comparison;          ///< in the frame of the truth
  std::optional<double> volume_error; ///< relative; if both are closed
};

/** \brief One object of a run beside the true one. */
struct PCL_COSECTION_EXPORT ObjectEvaluation
{
  int id = 0;                             ///< of the estimate
  int truth_id = 0;                       ///< of the true object
  std::string truth_name;                 ///< of the true object
  double overlap = 0.0;                   ///< of the match, in [0, 1]
  MeshEvaluation mesh;                    ///< its completed mesh
  TrajectoryError trajectory;             ///< in the camera's frame; the alignment is that of the mesh
  std::size_t frames_tracked = 0;         ///< with a pose of the estimate
  std::size_t frames_visible = 0;         ///< of the truth's frames
  std::size_t frames_tracked_visible = 0; ///< visible ones that were tracked
  double penetration_m = 0.0;             ///< deepest of all its pairs
  std::optional<double> penetration_m3; ///< largest of all its pairs; nothing if it is not known of one that penetrates
};

/** \brief Two estimated bodies. */
struct PCL_COSECTION_EXPORT PairPenetration
{
  static constexpr int background = -1; ///< stands for an id

  int first = 0;                   ///< id of the object
  int second = background;         ///< id of the other object, or the background
  double depth_m = 0.0;            ///< greatest over all frames of both
  double stamp = 0.0;              ///< when it was
  std::optional<double> volume_m3; ///< that both fill, the largest over some frames; nothing if one has no volume
  std::size_t frames = 0;          ///< in which both are known
};

/** \brief What evaluateRun () finds. */
struct PCL_COSECTION_EXPORT RunEvaluation
{
  TrajectoryError camera;                    ///< errors of the camera's trajectory
  std::vector<ObjectEvaluation> objects;     ///< in the order of the estimate
  std::optional<MeshEvaluation> background;  ///< nothing if one of the two has none
  std::vector<PairPenetration> penetrations; ///< of each pair of bodies that were measured
  std::vector<int> unmatched;                ///< ids of estimated objects that match no true one
  std::vector<int> missed;                   ///< ids of true objects that match no estimated one
  std::vector<std::string> warnings;         ///< one line each
};

/** \brief Evaluate estimated poses and meshes of a scene against the true ones.
 *
 * The world and the objects' frames of the estimate may be any. Objects are matched one to one by how much of their
 * surfaces coincides in the camera's frame (median over frames that have both, best pairs first). The pose of an
 * estimated mesh in the true object's frame is the median over these frames, refined on what was observed (vertices of
 * Provenance::Observed; all if the mesh has none). Objects' trajectories are compared in the camera's frame with this
 * pose as alignment, so that the camera's error has no part in theirs. Penetration is that of the estimate with itself.
 * \throws InvalidArgument if an option is outside its domain
 * \throws DegenerateInput if the cameras' trajectories do not match */
PCL_COSECTION_EXPORT RunEvaluation evaluateRun (const SceneRecord& truth, const SceneRecord& estimate,
                                                const RunOptions& options = {});

/** \brief What was odd about the files. */
struct PCL_COSECTION_EXPORT ReadingNotes
{
  std::vector<std::string> warnings; ///< one line each
  bool whole = true;                 ///< every file that is there could be read
};

/** \brief Read what a run wrote: trajectory/camera.txt, trajectory/object_ID.txt, mesh/object_ID.ply,
 * mesh/background.ply.
 * \param[in] folder path
 * \param[out] notes what is missing or cannot be read, beside the camera
 * \throws IoError if there is no such folder, or the camera cannot be read */
PCL_COSECTION_EXPORT SceneRecord readRun (const std::string& folder, ReadingNotes& notes);

/** \brief Read the truth of a dataset: gt-cam-0.txt, gt-NAME-ID.txt, gt-mesh/NAME.ply, gt-mesh/room.ply or
 * background.ply, calibration.txt.
 * \param[in] folder path
 * \param[out] notes what is missing or cannot be read, beside the camera
 * \throws IoError if there is no such folder, or the camera cannot be read */
PCL_COSECTION_EXPORT SceneRecord readTruth (const std::string& folder, ReadingNotes& notes);

/** \brief Read the truth of a dataset for what was completed from views of it: stamps are those of the views, which are
 * found among the frames, or among those of the dataset's folder views, by the poses of the camera.
 * \param[in] folder path
 * \param[in] completed camera poses of the views, as they were given with them
 * \param[out] notes what is missing or cannot be read, beside the camera
 * \throws IoError as readTruth (), and if a view is not there */
PCL_COSECTION_EXPORT SceneRecord readTruthOfViews (const std::string& folder, const std::vector<StampedPose>& completed,
                                                   ReadingNotes& notes);

} // namespace pcl::cosection
