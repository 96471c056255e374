// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

/** \brief A message of the programs with options as Python has them: "give --max-faces 100" becomes "give
 * max_faces=100". */
std::string inPython (const std::string& message);
