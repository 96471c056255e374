// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "help_text.h"

/** \brief What pcl_cosection says about itself. */
const ProgramText& completionText ();
