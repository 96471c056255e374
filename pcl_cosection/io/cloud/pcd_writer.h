// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <string>

namespace pcl::cosection {

/** \brief The bytes of a binary PCD file of the vertices of a mesh, with the fields that toPolygonMesh () gives them.
 * \throws InvalidArgument as toPolygonMesh () */
std::string encodePcd (const TriangleMesh& points);

} // namespace pcl::cosection
