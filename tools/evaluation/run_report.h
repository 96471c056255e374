// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation_json.h"
#include "run_command.h"
#include "terminal.h"

#include <pcl/cosection/evaluation/run_evaluation.h>

#include <string>

void print (const pcl::cosection::RunEvaluation& run, const pcl::cosection::SceneRecord& truth,
            const RunSettings& settings, Terminal& terminal);

Json runJson (const pcl::cosection::RunEvaluation& run, const pcl::cosection::SceneRecord& truth,
              const RunSettings& settings);

/** \brief A row for each object. */
std::string runCsv (const pcl::cosection::RunEvaluation& run);
