// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation_commands.h"

/** \brief The command "stability", which simulates a scene and measures what stays where it is. */
EvaluationCommand stabilityCommand ();
