// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "run_folder.h"
#include "run_truth.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

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

/** \brief "1 frame", "2 frames". */
std::string counted (std::size_t count, const std::string& what);
