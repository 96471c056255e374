// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "command_line.h"

#include <pcl/cosection/surface/co_section.h>

#include <map>
#include <string>
#include <vector>

/** \brief Write the machine-readable summary of a run.
 * \param[in] timings_s all of the run, the library's included
 * \throws pcl::cosection::IoError */
void writeJsonSummary (const Settings& settings, const pcl::cosection::SceneResult& result,
                       const std::map<std::string, double>& timings_s, const std::vector<std::string>& warnings);

/** \brief The summary of a run that failed as a whole: no objects, and the field error. Does nothing if it cannot be
 * written. */
void writeJsonOfFailure (const Settings& settings, const std::string& error, const std::vector<std::string>& warnings);
