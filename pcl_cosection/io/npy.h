// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief The bytes of a NumPy file (.npy), format version 1.0: little endian float32, the last index fastest.
 * \param[in] values as many as the product of \a shape \param[in] shape numbers of elements along the axes
 * \throws InvalidArgument if there are more or fewer */
std::string encodeNpy (const std::vector<float>& values, const std::vector<std::size_t>& shape);

} // namespace pcl::cosection
