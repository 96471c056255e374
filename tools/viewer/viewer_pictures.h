// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viewer_command_line.h"

/** \brief Find out, before the work, whether what was asked for may and can be written. The run, and what else is read,
 * stays as it is.
 * \throws UsageError, pcl::cosection::IoError */
void checkPictures (const ViewerSettings& settings);

/** \brief Load the run, and its errors if the truth was given. \throws pcl::cosection::Error */
pcl::cosection::RunScene loadScene (const ViewerSettings& settings, Terminal& terminal);

/** \brief The viewpoint that was asked for; nothing: the camera of the run. \throws pcl::cosection::IoError */
std::optional<pcl::cosection::Viewpoint> chosenViewpoint (const ViewerSettings& settings,
                                                          const pcl::cosection::RunScene& scene);

/** \brief The frame that was asked for, else \a otherwise. \throws pcl::cosection::InvalidArgument if there is none */
std::size_t chosenFrame (const ViewerSettings& settings, const pcl::cosection::RunScene& scene, std::size_t otherwise);

/** \brief Write the screenshot, or record. \throws pcl::cosection::Error; Cancelled after an interruption */
void writePictures (const ViewerSettings& settings, const pcl::cosection::RunScene& scene, Terminal& terminal);
