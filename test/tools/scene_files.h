// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

/** \brief Write one organised view, 160 x 120 with labels and colours, of a table (label 0) with a
 * ball of 6 cm radius (1) and a box of 8 cm edge (2) on it. The world's origin is on the table, z up. */
void writeTableScene (const std::string& path);

/** \brief Write an unorganised cloud with normals: \a count points of a sphere of 10 cm radius. */
void writeSphere (const std::string& path, int count);
