// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

/** \brief Write three views of a box, a ball and a bottle on a table as organised PCD files with colours and labels, as
 * a depth camera would have recorded them: with noise, with mixed pixels at depth edges, and with something in the
 * second view that was gone in the others. The same files every time.
 * \param[in] folder exists
 * \return their paths */
std::vector<std::string> writeTableViews (const std::string& folder);
