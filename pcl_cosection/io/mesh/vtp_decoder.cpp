// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors

// VTK's own reader believes every size in a file and takes as much memory, so only its decompression is used.

#include "mesh_decoders.h"
#include "vtp_bytes.h"
#include "vtp_document.h"

#include <pcl/cosection/common/error.h>

#include <limits>

namespace pcl::cosection
{
namespace
{

ScalarType
scalarType (std::string_view word)
{
  struct Name
  {
    const char* name;
    ScalarType type;
  };
  static constexpr Name names[] = {{"Int8", ScalarType::Int8},       {"UInt8", ScalarType::UInt8},
                                   {"Int16", ScalarType::Int16},     {"UInt16", ScalarType::UInt16},
                                   {"Int32", ScalarType::Int32},     {"UInt32", ScalarType::UInt32},
                                   {"Int64", ScalarType::Int64},     {"UInt64", ScalarType::UInt64},
                                   {"Float32", ScalarType::Float32}, {"Float64", ScalarType::Float64}};
  for (const Name& known : names)
    if (word == known.name)
      return known.type;
  throw IoError ("values of type " + quoted (word) + " in VTK files are not supported");
}

/** \brief How many there are of something; none if the file does not say. */
std::uint64_t
countOf (const XmlTag& tag, const char* what)
{
  const std::string_view word = tag.attribute (what);
  if (word.empty ())
    return 0;
  TextScanner scanner (word); // numbers may be padded with spaces
  const std::int64_t count = toInteger (scanner.word ());
  if (count < 0 || count > std::numeric_limits<std::uint32_t>::max ())
    throw IoError (std::string ("the VTK file has an impossible ") + what);
  return static_cast<std::uint64_t> (count);
}

class PieceReader
{
public:
  explicit PieceReader (const VtpDocument& document) : document_ (document), storage_ (document) {}

  void add (const VtpPiece& piece, PolygonSoup& soup) const
  {
    const auto first = static_cast<std::int64_t> (soup.points.size ());
    if (const std::uint64_t count = countOf (piece.tag, "NumberOfPoints"))
    {
      if (piece.points.empty ())
        throw IoError ("the VTK file has points without their array");
      forEachValue (piece.points.front (), 3 * count, [&soup, n = 0] (ValueReader& values, ScalarType type) mutable {
        if (n == 0)
          soup.points.emplace_back ();
        soup.points.back ()[n] = static_cast<float> (values.next (type));
        n = (n + 1) % 3;
      });
    }
    const auto count = static_cast<std::int64_t> (soup.points.size ()) - first;
    const auto shift = [&] (std::vector<std::int64_t> corners) {
      for (std::int64_t& corner : corners)
        corner = (corner >= 0 && corner < count ? first + corner : -1); // not of another piece
      return corners;
    };
    forEachCell (piece.polys, countOf (piece.tag, "NumberOfPolys"), [&] (const std::vector<std::int64_t>& cell) {
      const auto corners = shift (cell);
      soup.corners.insert (soup.corners.end (), corners.begin (), corners.end ());
      soup.endPolygon ();
    });
    forEachCell (piece.strips, countOf (piece.tag, "NumberOfStrips"),
                 [&] (const std::vector<std::int64_t>& cell) { soup.addStrip (shift (cell)); });
  }

private:
  /** \brief Calls \a take \a count times, each of which takes a value. */
  template <typename Take> void forEachValue (const VtpArray& array, std::uint64_t count, Take&& take) const
  {
    const ScalarType type = scalarType (array.tag.attribute ("type"));
    const std::string_view format = array.tag.attribute ("format");
    std::string decoded;
    std::string_view text = array.content;
    if (format == "binary" || format == "appended")
    {
      const bool base64 = format == "binary" || document_.appended_tag.attribute ("encoding") == "base64";
      decoded = decodeVtpBytes (storage_, format == "binary" ? text : appended (array), base64, count * sizeOf (type));
      text = decoded;
    }
    else if (format != "ascii")
      throw IoError ("the format " + quoted (format) + " of an array of the VTK file is not known");
    TextScanner scanner (text);
    ValueReader values (scanner, format == "ascii" ? Encoding::Ascii : storage_.order, "VTK");
    values.require (count, sizeOf (type), 1);
    for (std::uint64_t n = 0; n < count; ++n)
      take (values, type);
  }

  std::string_view appended (const VtpArray& array) const
  {
    const std::uint64_t offset = countOf (array.tag, "offset");
    if (offset > document_.appended.size ())
      throw IoError ("an array of the VTK file begins behind its end");
    return document_.appended.substr (offset);
  }

  std::vector<std::int64_t> indices (const std::vector<VtpArray>& arrays, const char* name, std::uint64_t count) const
  {
    std::vector<std::int64_t> result;
    if (count == 0)
      return result;
    for (const VtpArray& array : arrays)
      if (array.tag.attribute ("Name") == name)
      {
        forEachValue (array, count,
                      [&result] (ValueReader& values, ScalarType type) { result.push_back (values.nextIndex (type)); });
        return result;
      }
    throw IoError (std::string ("the VTK file has cells without their ") + name);
  }

  /** \brief Calls \a add with the indices of each cell; offsets are where each cell ends. */
  template <typename Add> void forEachCell (const std::vector<VtpArray>& arrays, std::uint64_t count, Add&& add) const
  {
    const auto ends = indices (arrays, "offsets", count);
    std::int64_t begin = 0;
    for (const std::int64_t end : ends)
    {
      if (end < begin || end > std::numeric_limits<std::uint32_t>::max ())
        throw IoError ("the offsets of the VTK file's cells do not fit their connectivity");
      begin = end;
    }
    const auto corners = indices (arrays, "connectivity", static_cast<std::uint64_t> (begin));
    begin = 0;
    for (const std::int64_t end : ends)
    {
      add (std::vector<std::int64_t> (corners.begin () + begin, corners.begin () + end));
      begin = end;
    }
  }

  const VtpDocument& document_;
  const VtpStorage storage_;
};

} // namespace

PolygonSoup
decodeVtp (const std::string& bytes)
{
  const VtpDocument document = parseVtp (bytes);
  const PieceReader reader (document);
  PolygonSoup soup;
  for (const VtpPiece& piece : document.pieces)
    reader.add (piece, soup);
  return soup;
}

} // namespace pcl::cosection
