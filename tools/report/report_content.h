// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "run_folder.h"

#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/evaluation/run_evaluation.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

/** \brief The object of a number; null if there is no such object. */
template <typename Object>
const Object*
withId (const std::vector<Object>& objects, int id)
{
  const auto found = std::find_if (objects.begin (), objects.end (), [id] (const Object& o) { return (o.id == id); });
  return (found == objects.end () ? nullptr : &*found);
}

/** \brief A run beside the truth. */
struct RunTruth
{
  pcl::cosection::SceneRecord truth;
  pcl::cosection::RunEvaluation evaluation;
  /** \brief Of the TSDF meshes, in the alignment of the completed ones, by objects' ids. */
  std::map<int, pcl::cosection::MeshComparison> seen;
  std::vector<std::string> notes; ///< what of the truth is missing, and the warnings of the evaluation
};

/** \brief Compare a run with the truth of a dataset.
 * \throws pcl::cosection::IoError if the dataset has no truth
 * \throws pcl::cosection::DegenerateInput if the run has no camera that matches */
RunTruth compareWithTruth (const pcl::cosection::RunScene& run, const std::string& dataset, int threads);

/** \brief Another run, beside the one that a report is about. */
struct ComparedRun
{
  std::string name; ///< its folder
  RunFolder run;
  std::optional<pcl::cosection::RunEvaluation> evaluation; ///< against the same truth
};

/** \brief All that a report is made of. */
struct ReportContent
{
  RunFolder run;
  pcl::cosection::RunScene scene; ///< of the run, to draw; with the errors of its vertices, if there is a truth
  std::optional<RunTruth> truth;
  std::string truth_folder; ///< empty: not given
  std::vector<ComparedRun> others;
  std::vector<std::string> warnings; ///< about what was read
  int threads = 0;                   ///< 0: all
};

/** \brief "truck" if the truth has a name for it; else "cup 1" if the run has found out its class; else "object 1". */
std::string nameOf (const RunObject& object, const ReportContent& content);

/** \brief The upward direction in the world of the run, unit; z if it is not known. */
Eigen::Vector3d upOf (const ReportContent& content);

/** \brief What the run was made from: the last part of the dataset's name, or of the run's. */
std::string titleOf (const ReportContent& content);

/** \brief The last part of a path, whatever slashes it ends in. */
std::string lastPartOf (const std::string& path);

/** \brief The distance of every vertex of a mesh in the frame of the estimated object to the true surface, metres;
 * empty if there is no counterpart. */
std::vector<double> errorsOf (const RunTruth& truth, int id, const pcl::cosection::TriangleMesh& mesh, int threads);

/** \brief How an object was seen, in its own frame. */
struct ObjectDirections
{
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ ();
  Eigen::Vector3d front = Eigen::Vector3d (0.8, -1.0, 0.75).normalized (); ///< to the camera, in the mean
};

/** \brief Unit vectors, not along each other; the defaults where poses are missing. */
ObjectDirections directionsOf (const RunObject& object, const RunFolder& run, const Eigen::Vector3d& up);

/** \brief The pose at a stamp, to a millionth; null if there is no such pose. */
const Eigen::Isometry3d* poseAt (const std::vector<pcl::cosection::StampedPose>& poses, double stamp);

/** \brief Length, width and height (metres) of the smallest box around a mesh that stands vertical; zero without
 * vertices.
 * \param[in] up in the frame of the mesh, unit */
Eigen::Vector3d standingSize (const pcl::cosection::TriangleMesh& mesh, const Eigen::Vector3d& up);

/** \brief The middle of the box around the mesh of an object, in its frame. */
Eigen::Vector3d middleOf (const RunObject& object);
