// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "pcl_cosection/io/cloud/value_reader.h"
#include "vtp_document.h"

#include <cstdint>
#include <string>

namespace pcl::cosection
{

/** \brief How binary arrays of a .vtp file are stored. */
struct VtpStorage
{
  Encoding order = Encoding::LittleEndian;
  ScalarType header = ScalarType::UInt32; ///< of the sizes before an array
  std::string_view compressor;            ///< empty: none

  /** \brief \throws IoError if the file says something unknown */
  explicit VtpStorage (const VtpDocument& document);
};

/** \brief The first \a size bytes of a binary array.
 * \param[in] stored where it begins in the file
 * \throws IoError if there are fewer, or they are damaged. Memory is bounded by what \a stored can hold, compressed,
 * whatever the sizes in it say. */
std::string decodeVtpBytes (const VtpStorage& storage, std::string_view stored, bool base64, std::uint64_t size);

} // namespace pcl::cosection
