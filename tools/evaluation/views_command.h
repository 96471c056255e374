// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation_commands.h"

#include <string>
#include <vector>

/** \brief A true object of a scene, and the file of what was made of it. */
struct ViewedFiles
{
  std::string scene, label, name;
  std::string truth, result; ///< files; the second one need not be there
};

/** \brief The objects of TRUTH/SCENE/truth_LABEL.ply or truth_LABEL_NAME.ply, with RESULT/SCENE/object_LABEL.ply, .stl
 * or .obj. \throws pcl::cosection::IoError if there are none, or none of them has a result */
std::vector<ViewedFiles> findViewedFiles (const std::string& truth, const std::string& result);

/** \brief The command "views", which compares the completed objects of many scenes with their true meshes. */
EvaluationCommand viewsCommand ();
