// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

namespace pcl::cosection
{

/** \brief The same surface with normals that are smooth but for sharp edges, where vertices are there several times. */
TriangleMesh withCreasedNormals (const TriangleMesh& mesh);

} // namespace pcl::cosection
