// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "ply_header.h"

#include <pcl/cosection/common/error.h>

#include <sstream>
#include <utility>

namespace pcl::cosection {
namespace {

ScalarType
scalarType (const std::string& name)
{
  static constexpr std::pair<const char*, ScalarType> names[] = {
      {"char", ScalarType::Int8},      {"int8", ScalarType::Int8},       {"uchar", ScalarType::UInt8},
      {"uint8", ScalarType::UInt8},    {"short", ScalarType::Int16},     {"int16", ScalarType::Int16},
      {"ushort", ScalarType::UInt16},  {"uint16", ScalarType::UInt16},   {"int", ScalarType::Int32},
      {"int32", ScalarType::Int32},    {"uint", ScalarType::UInt32},     {"uint32", ScalarType::UInt32},
      {"float", ScalarType::Float32},  {"float32", ScalarType::Float32}, {"double", ScalarType::Float64},
      {"float64", ScalarType::Float64}};
  for (const auto& [known, type] : names)
    if (name == known)
      return type;
  throw IoError ("a property of the PLY header has an unknown type");
}

Encoding
encodingOf (const std::string& format)
{
  if (format == "ascii")
    return Encoding::Ascii;
  if (format == "binary_little_endian")
    return Encoding::LittleEndian;
  if (format == "binary_big_endian")
    return Encoding::BigEndian;
  throw IoError ("PLY format " + quoted (format) +
                 " is not supported, only ascii, binary_little_endian and binary_big_endian");
}

PlyProperty
parseProperty (std::istringstream& words)
{
  PlyProperty property;
  std::string type;
  words >> type;
  if (type == "list")
  {
    words >> type;
    property.count_type = scalarType (type);
    type.clear ();
    words >> type;
  }
  property.type = scalarType (type);
  if (!(words >> property.name))
    throw IoError ("a property of the PLY header has no name");
  return property;
}

} // namespace

std::size_t
PlyElement::leastRowBytes () const
{
  std::size_t bytes = 0;
  for (const PlyProperty& property : properties)
    bytes += sizeOf (property.count_type.value_or (property.type));
  return bytes;
}

std::uint64_t
PlyElement::leastSize (Encoding encoding) const
{
  return count * (encoding == Encoding::Ascii ? 2 * properties.size () : leastRowBytes ());
}

PlyHeader
parsePlyHeader (TextScanner& scanner)
{
  PlyHeader header;
  bool has_format = false;
  for (int line_number = 0;; ++line_number)
  {
    if (scanner.left ().find ('\n') == std::string_view::npos)
      throw IoError (line_number == 0 ? "not a PLY file" : "the PLY header does not end");
    std::istringstream words{std::string (scanner.line ())};
    std::string keyword;
    words >> keyword;
    if (line_number == 0)
    {
      if (keyword != "ply")
        throw IoError ("not a PLY file");
      continue;
    }
    if (keyword == "end_header")
      break;
    if (keyword == "format")
    {
      std::string format;
      words >> format;
      header.encoding = encodingOf (format);
      has_format = true;
    }
    else if (keyword == "element")
    {
      PlyElement element;
      if (!(words >> element.name >> element.count))
        throw IoError ("an element of the PLY header has no count");
      header.elements.push_back (element);
    }
    else if (keyword == "property")
    {
      if (header.elements.empty ())
        throw IoError ("a property of the PLY header belongs to no element");
      header.elements.back ().properties.push_back (parseProperty (words));
    }
    else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty ())
      throw IoError ("unknown keyword in the PLY header");
  }
  if (!has_format)
    throw IoError ("the PLY header names no format");
  return header;
}

void
PlyElementReader::require (const PlyElement& element) const
{
  values_.require (element.count, element.leastRowBytes (), element.properties.size ());
}

std::uint64_t
PlyElementReader::readCount (const PlyProperty& property)
{
  const std::int64_t count = values_.nextIndex (*property.count_type);
  if (count < 0)
    throw IoError ("a list has an impossible length");
  values_.require (static_cast<std::uint64_t> (count), sizeOf (property.type), 1);
  return static_cast<std::uint64_t> (count);
}

void
PlyElementReader::skip (const PlyProperty& property)
{
  for (std::uint64_t left = (property.count_type ? readCount (property) : 1); left > 0; --left)
    values_.next (property.type);
}

} // namespace pcl::cosection
