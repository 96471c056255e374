// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "arrays.h"

#include <pcl/cosection/common/triangle_mesh.h>

/** \brief A mesh of arrays, which are copied. \param[in] vertices n x 3, metres \param[in] faces m x 3 */
pcl::cosection::TriangleMesh toMesh (const DenseArray<float>& vertices, const DenseArray<std::uint32_t>& faces);
