// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <string>

namespace pcl::cosection
{

/** \brief Write a signed distance field as VTK image data (`.vti`): point arrays
 * `signed_distance` (float, metres) and, if present, `supported` (unsigned char); the origin is the
 * first voxel's centre. Through a temporary name. \throws IoError */
PCL_COSECTION_EXPORT void saveSignedDistance (const SignedDistanceField& field, const std::string& path);

} // namespace pcl::cosection
