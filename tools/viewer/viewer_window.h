// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viewer_command_line.h"

/** \brief Show a run in a window until that is closed, or what is followed. \throws pcl::cosection::Error, also if no
 * window can be opened */
void showWindow (const ViewerSettings& settings, Terminal& terminal);
