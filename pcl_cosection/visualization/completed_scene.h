// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/evaluation/run_evaluation.h>

#include <nlohmann/json.hpp>

#include <string>

namespace pcl::cosection {

/** \brief Whether a folder has what pcl_cosection makes of views, which is no run. \param[in] summary of the folder */
PCL_COSECTION_EXPORT bool isCompletion (const std::string& folder, const nlohmann::json& summary);

/** \brief Read the completed objects of views, as a run of which each INPUT with a viewpoint is a frame; its stamp is
 * its number, from 0. If the summary does not say from where they were seen, there is one frame, before what was
 * observed. Coordinates are relative to the summary's origin_m.
 * \param[in] summary of the folder \param[out] notes what is missing or cannot be read */
PCL_COSECTION_EXPORT SceneRecord readCompletion (const std::string& folder, const nlohmann::json& summary,
                                                 ReadingNotes& notes);

} // namespace pcl::cosection
