// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Core>

#include <optional>
#include <string>

namespace pcl::cosection {

/** \brief A mesh, or a scan: the points of a file as vertices without triangles. */
struct SurfaceFile
{
  TriangleMesh mesh;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero (); ///< of its coordinates
};

/** \brief Read a mesh (loadMesh ()), or the points of a PCD file or of a PLY file without faces, in the world frame.
 * \param[in] origin nothing: zero, or near the surface if this is too far from zero for single precision
 * \throws IoError, DegenerateInput */
SurfaceFile loadSurface (const std::string& path, const std::optional<Eigen::Vector3d>& origin = {});

} // namespace pcl::cosection
