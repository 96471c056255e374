// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "value_reader.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection {

struct PlyProperty
{
  std::string name;
  ScalarType type = ScalarType::Float32;
  std::optional<ScalarType> count_type; ///< of lists
};

struct PlyElement
{
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader
{
  Encoding encoding = Encoding::Ascii;
  std::vector<PlyElement> elements;
};

/** \brief Read the header of a PLY file; \a scanner is behind it then. \throws IoError, whose message is only the
 * reason */
PlyHeader parsePlyHeader (TextScanner& scanner);

} // namespace pcl::cosection
