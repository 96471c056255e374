// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene_stability.h"

#include <functional>
#include <string>

/** \brief Load a scene and let it move, in a process that MuJoCo may end: an error of MuJoCo does not return.
 * \param[in] on_error is called before the process ends with status 1
 * \param[in] progress is given the share that is done; false: stop
 * \throws pcl::cosection::IoError, without the name of the file \throws pcl::cosection::Cancelled */
SceneStability simulateInThisProcess (const std::string& path, double duration_s,
                                      const std::function<void (const std::string& error)>& on_error,
                                      const std::function<bool (double share)>& progress);
