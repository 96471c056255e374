// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/image.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

/** \brief A picture that need not fill its rectangle: red, green, blue, opacity. */
using TransparentPicture = pcl::cosection::Image<std::array<std::uint8_t, 4>>;

/** \brief Bytes as letters (RFC 4648). */
std::string toBase64 (const void* bytes, std::size_t size);

/** \brief "data:image/webp;base64,...": the picture in the place of its address. */
std::string dataUri (const TransparentPicture& picture);

/** \brief A picture that fills its rectangle, in the place of its address. */
std::string dataUri (const pcl::cosection::Picture& picture);
