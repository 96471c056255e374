// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "run_folder.h"

#include <pcl/cosection/evaluation/mesh_comparison.h>
#include <pcl/cosection/evaluation/run_evaluation.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

/** \brief A run beside the truth. */
struct RunTruth
{
  pcl::cosection::SceneRecord truth;
  pcl::cosection::RunEvaluation evaluation;
  std::map<int, pcl::cosection::MeshComparison>
      seen;                       ///< of the TSDF meshes, in the alignment of the completed ones, by objects' ids
  std::vector<std::string> notes; ///< what of the truth is missing
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

/** \brief The evaluation of the object \a id of the estimate; null if it has no counterpart. */
const pcl::cosection::ObjectEvaluation* evaluationOf (const pcl::cosection::RunEvaluation& run, int id);

/** \brief The distance of every vertex of a mesh in the frame of the estimated object to the true surface, metres;
 * empty if there is no counterpart. */
std::vector<double> errorsOf (const RunTruth& truth, int id, const pcl::cosection::TriangleMesh& mesh, int threads);
