// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>

#include <string>

namespace pcl::cosection
{

/** \brief What is wrong with the bytes of a PNG, JPEG or EXR file as far as its structure tells: cut short, checksums
 * that do not match, an absurd size. The libraries that decode them would write about it to the console.
 * \return a phrase for after the file's name; empty if nothing is wrong, or the bytes are of another kind */
PCL_COSECTION_EXPORT std::string imageDamage (const std::string& bytes);

} // namespace pcl::cosection
