// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/evaluation/run_evaluation.h>

#include <Eigen/Core>

#include <regex>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief The files of a folder whose names match, by name: the path, and what the groups of the pattern are. */
std::vector<std::vector<std::string>> matchingFiles (const std::string& folder, const std::regex& pattern);

/** \brief A mesh with its provenance if it has one; empty if there is no file, or, with a warning, if it cannot be
 * read. \param[in] origin is subtracted from the vertices */
TriangleMesh readMeshIfThere (const std::string& path, ReadingNotes& notes,
                              const Eigen::Vector3d& origin = Eigen::Vector3d::Zero ());

/** \brief A trajectory; empty, with a warning, if it cannot be read. */
std::vector<StampedPose> readPosesOrWarn (const std::string& path, ReadingNotes& notes);

} // namespace pcl::cosection
