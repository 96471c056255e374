// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

namespace pcl::cosection {

/** \brief Gives a surface normals that are smooth but for sharp edges, where vertices are repeated. */
TriangleMesh withCreasedNormals (const TriangleMesh& mesh);

} // namespace pcl::cosection
