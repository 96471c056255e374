// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation_commands.h"

/** \brief The command "views", which compares the completed objects of many scenes with their true meshes. */
EvaluationCommand viewsCommand ();
