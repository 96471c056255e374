// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <algorithm>

namespace pcl::cosection {

/** \brief \throws InvalidArgument if a triangle refers to a vertex that is not there, or a
 * per-vertex array has another length than the vertices. */
inline void
checkMesh (const TriangleMesh& mesh)
{
  for (const auto& triangle : mesh.triangles)
    if (*std::max_element (triangle.begin (), triangle.end ()) >= mesh.vertices.size ())
      throw InvalidArgument ("mesh: a triangle refers to a vertex that does not exist");
  for (const std::size_t size : {mesh.normals.size (), mesh.colours.size (), mesh.intensity.size (),
                                 mesh.confidence.size (), mesh.sigma_m.size (), mesh.provenance.size ()})
    if (size != 0 && size != mesh.vertices.size ())
      throw InvalidArgument ("mesh: a vertex property must have one value per vertex");
}

} // namespace pcl::cosection
