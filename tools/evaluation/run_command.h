// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation_commands.h"

/** \brief pcl_cosection_evaluate run. */
EvaluationCommand runCommand ();
