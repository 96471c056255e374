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

  /** \brief Bytes that one row takes at least, as lists may be empty. */
  std::size_t leastRowBytes () const;

  /** \brief Bytes (text: characters) that all rows take at least. */
  std::uint64_t leastSize (Encoding encoding) const;
};

struct PlyHeader
{
  Encoding encoding = Encoding::Ascii;
  std::vector<PlyElement> elements;
};

/** \brief Read the header of a PLY file; \a scanner is behind it then. \throws IoError, whose message is only the
 * reason */
PlyHeader parsePlyHeader (TextScanner& scanner);

/** \brief Reads the elements of a file one after the other; all functions throw IoError, whose message is only the
 * reason. */
class PlyElementReader
{
public:
  PlyElementReader (TextScanner& scanner, Encoding encoding) : values_ (scanner, encoding, "PLY") {}

  /** \brief Bounds what is allocated for an element, and how long it takes, by the size of the file. */
  void require (const PlyElement& element) const;

  /** \brief Read an element: calls use (row, index of the property, value) for all values that are in no list. */
  template <typename Use> void read (const PlyElement& element, Use&& use)
  {
    require (element);
    for (std::uint64_t row = 0; row < element.count && !element.properties.empty (); ++row)
      for (std::size_t n = 0; n < element.properties.size (); ++n)
        if (const PlyProperty& property = element.properties[n]; property.count_type)
          skip (property);
        else
          use (row, n, values_.next (property.type));
  }

  /** \brief The length of a list, which can follow. */
  std::uint64_t readCount (const PlyProperty& property);

  /** \brief The next value as an index; -1 if it cannot be one. */
  std::int64_t nextIndex (const PlyProperty& property) { return values_.nextIndex (property.type); }

  void skip (const PlyProperty& property);

private:
  ValueReader values_;
};

} // namespace pcl::cosection
