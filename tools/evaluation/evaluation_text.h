// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "help_text.h"

/** \brief What pcl_cosection_evaluate says about itself, and about each of its commands. */
const ProgramText& evaluationText ();

const ProgramText& meshText ();

const ProgramText& trajectoryText ();

const ProgramText& runText ();
