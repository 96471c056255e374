// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "run_folder.h"

#include <pcl/cosection/common/image.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/** \brief A picture that need not fill its rectangle: red, green, blue, opacity. */
using TransparentPicture = pcl::cosection::Image<std::array<std::uint8_t, 4>>;

/** \brief Bytes as letters (RFC 4648). */
std::string toBase64 (const void* bytes, std::size_t size);

/** \brief "data:image/webp;base64,...": the picture in the place of its address. */
std::string dataUri (const TransparentPicture& picture);

/** \brief A picture that fills its rectangle, in the place of its address. */
std::string dataUri (const pcl::cosection::Picture& picture);

/** \brief The mesh with at most so many triangles, for display; as it is where it cannot be made smaller. */
pcl::cosection::TriangleMesh forDisplay (const pcl::cosection::TriangleMesh& mesh, std::size_t most_triangles);

/** \brief A mesh as letters, for the script of the report: `vertices`, `triangles`, `min` and `size` of its box in
 * metres, and little endian in base64 `positions` (three uint16 per vertex, 0 to 65535 in the box), `indices` (three
 * per triangle, of `index_bytes` 2 or 4), `colours` (red, green, blue), `provenance`, `confidence` (0 to 255) and
 * `error` (0 to 255 of \a error_max_m), where they are known.
 *
 * A position is off by at most half a 65535th of the box, as are confidence and error by half a 255th.
 * \param[in] errors_m one for each vertex, or empty
 * \throws std::invalid_argument if the mesh has triangles of vertices that are not there, or arrays of other lengths */
Json embedMesh (const pcl::cosection::TriangleMesh& mesh, const std::vector<double>& errors_m = {},
                double error_max_m = 1.0);
