// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud_file.h"

#include <iosfwd>
#include <string>
#include <string_view>

namespace pcl::cosection {

/** \brief See readCloudHeader (). \param[in] text the file's first bytes, with the header \param[in] size of the file,
 * bytes */
CloudHeader parsePcdHeader (const std::string& path, const std::string& text, std::istream& file, std::uint64_t size);

/** \brief See readCloudHeader (). Properties have the names of PCD fields where PCL has one. */
CloudHeader parsePlyCloudHeader (const std::string& path, std::string_view text, std::uint64_t size);

/** \brief See readCloudPoints (). */
PCLPointCloud2 readPcdPoints (const std::string& path, CloudHeader& header);

/** \brief See readCloudPoints (). */
PCLPointCloud2 readPlyPoints (const std::string& path, CloudHeader& header);

/** \brief A cloud with the fields of the header and zeros for the points. */
PCLPointCloud2 emptyCloud (const CloudHeader& header, CloudPadding padding);

/** \brief Writes a number as an element of a field; false if the number does not fit. */
using StoreNumber = bool (*) (double value, std::uint8_t* target);

StoreNumber storeFor (const CloudField& field);

} // namespace pcl::cosection
