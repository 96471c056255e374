// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/rendering/rasterizer.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief Light the surfaces of \a image with a head light and a little ambient light, on \a background. */
PCL_COSECTION_EXPORT Picture shade (const RasterImage& image, const PinholeCamera& camera,
                                    const std::array<std::uint8_t, 3>& background = {255, 255, 255});

/** \brief A camera whose square picture all vertices of some meshes fill, as far as is wanted.
 * \param[in] size_px of the picture \param[in] filled share of its longer side */
PCL_COSECTION_EXPORT PinholeCamera fittingCamera (const std::vector<const TriangleMesh*>& meshes,
                                                  const Eigen::Isometry3d& T_world_camera, int size_px, double filled);

/** \brief Per-vertex colours that show provenance: observed grey, inferred orange, hull blue,
 * intersection green. */
PCL_COSECTION_EXPORT std::vector<std::array<std::uint8_t, 3>> provenanceColours (const TriangleMesh& mesh);

/** \brief Set pictures of equal height beside each other, with \a gap_px white pixels between. */
Picture beside (const std::vector<Picture>& pictures, int gap_px = 8);

/** \brief Write a PNG, through a temporary name. \throws IoError */
PCL_COSECTION_EXPORT void writePng (const Picture& picture, const std::string& path);

} // namespace pcl::cosection
