// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <string>

namespace pcl::cosection {

/** \brief The bytes of a binary little-endian PLY file with all vertex properties of \a mesh. */
std::string encodePly (const TriangleMesh& mesh);

/** \brief Inverse of encodePly (); also reads text and the other byte order, properties of other types,
 * skips those it does not know, and takes any integer types for the indices.
 * \throws IoError, whose message is only the reason */
TriangleMesh decodePly (const std::string& bytes);

} // namespace pcl::cosection
