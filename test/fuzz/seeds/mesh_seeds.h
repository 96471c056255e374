// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace fuzz {

struct MeshSeed
{
  std::string extension; ///< ".ply" ...
  std::string bytes;
};

/** \brief Small mesh files of every format and encoding, as the library, VTK and others write them: polygons, strips,
 * bodies in each other, repeated and flat triangles, survey coordinates. */
std::vector<MeshSeed> meshSeeds ();

} // namespace fuzz
