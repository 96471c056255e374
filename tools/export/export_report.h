// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "export_scene.h"
#include "option_values.h"
#include "terminal.h"

#include <pcl/cosection/surface/co_section.h>

#include <string>
#include <vector>

/** \brief Say what was written, and how well parts fit. */
void report (const ExportReport& exported, const std::string& folder, Terminal& terminal);

/** \brief Declare --export, of programs that complete objects. */
void declareExport (OptionGroup& output, std::vector<std::string>& formats);

/** \brief Whether there is anything to export. */
bool anyCompleted (const pcl::cosection::SceneResult& scene);

/** \brief Write some formats of a result into its folder "export"; nothing if there are none.
 * \throws pcl::cosection::Error */
void exportBeside (const std::string& result, const std::vector<std::string>& formats, int threads, Terminal& terminal);
