// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace pcl::cosection {

/** \brief Pixels that the header of an image says. */
struct EncodedSize
{
  std::uint64_t width = 0, height = 0;
};

/** \brief The size that the header of an image says, without decoding it: PNG, JPEG, TIFF, BMP, OpenEXR, PNM. It is
 * that of a tile if tiles are larger than the image: a decoder takes memory for a whole one.
 * \param[in] bytes of the file
 * \return nothing if it is another kind of file, or cut short before it says so */
std::optional<EncodedSize> encodedSize (const std::string& bytes);

} // namespace pcl::cosection
