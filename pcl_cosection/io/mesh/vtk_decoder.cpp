// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Legacy VTK files are read by hand, because vtkPolyDataReader of VTK 9.1 follows lengths of cells beyond its buffers,
// and null pointers where a type or a number is not what it expects: what would make it safe is a reader.

#include "mesh_decoders.h"
#include "value_reader.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cctype>

namespace pcl::cosection {
namespace {

std::string
upperCase (std::string_view word)
{
  std::string upper (word);
  std::transform (upper.begin (), upper.end (), upper.begin (),
                  [] (unsigned char c) { return static_cast<char> (std::toupper (c)); });
  return upper;
}

ScalarType
scalarType (std::string_view word)
{
  static constexpr std::pair<const char*, ScalarType> names[] = {{"CHAR", ScalarType::Int8},
                                                                 {"SIGNED_CHAR", ScalarType::Int8},
                                                                 {"UNSIGNED_CHAR", ScalarType::UInt8},
                                                                 {"SHORT", ScalarType::Int16},
                                                                 {"UNSIGNED_SHORT", ScalarType::UInt16},
                                                                 {"INT", ScalarType::Int32},
                                                                 {"UNSIGNED_INT", ScalarType::UInt32},
                                                                 {"VTKIDTYPE", ScalarType::Int32}, // so in files
                                                                 {"LONG", ScalarType::Int64},
                                                                 {"UNSIGNED_LONG", ScalarType::UInt64},
                                                                 {"VTKTYPEINT64", ScalarType::Int64},
                                                                 {"VTKTYPEUINT64", ScalarType::UInt64},
                                                                 {"FLOAT", ScalarType::Float32},
                                                                 {"DOUBLE", ScalarType::Float64}};
  const std::string upper = upperCase (word);
  for (const auto& [known, type] : names)
    if (upper == known)
      return type;
  throw IoError ("values of type " + quoted (word) + " in VTK files are not supported");
}

/** \brief Reads the sections of a data set of polygons, as far as its surface. */
class PolyDataReader
{
public:
  explicit PolyDataReader (TextScanner& scanner, Encoding encoding)
      : scanner_ (scanner)
      , values_ (scanner, encoding, "VTK")
  {}

  PolygonSoup read ()
  {
    for (std::string_view word = scanner_.word (); !word.empty (); word = scanner_.word ())
    {
      const std::string keyword = upperCase (word);
      if (keyword == "POINT_DATA" || keyword == "CELL_DATA")
        break;
      if (keyword == "DATASET")
        checkDataSet (scanner_.word ());
      else if (keyword == "POINTS")
        readPoints ();
      else if (keyword == "VERTICES" || keyword == "LINES")
        readCells ([] (const std::vector<std::int64_t>&) {});
      else if (keyword == "POLYGONS")
        readCells ([this] (const std::vector<std::int64_t>& corners) { soup_.addPolygon (corners); });
      else if (keyword == "TRIANGLE_STRIPS")
        readCells ([this] (const std::vector<std::int64_t>& corners) { soup_.addStrip (corners); });
      else if (keyword == "FIELD")
        skipField ();
      else if (keyword == "METADATA")
        skipMetadata ();
      else
        throw IoError (quoted (word) + " is not a section of a VTK file of polygons");
    }
    return std::move (soup_);
  }

private:
  static void checkDataSet (std::string_view kind)
  {
    if (upperCase (kind) != "POLYDATA")
      throw IoError ("the VTK file holds " + quoted (kind) + ", not POLYDATA");
  }

  std::uint64_t count ()
  {
    const std::int64_t value = toInteger (scanner_.word ());
    if (value < 0)
      throw IoError ("a section of the VTK file has a negative size");
    return static_cast<std::uint64_t> (value);
  }

  /** \brief The type of the values that begin on the next line. */
  ScalarType type ()
  {
    const ScalarType type = scalarType (scanner_.word ());
    scanner_.line ();
    return type;
  }

  void readPoints ()
  {
    const std::uint64_t points = count ();
    const ScalarType scalar = type ();
    values_.require (points, 3 * sizeOf (scalar), 3);
    soup_.points.resize (points);
    for (Eigen::Vector3d& p : soup_.points)
      for (int axis = 0; axis < 3; ++axis)
        p[axis] = values_.next (scalar);
  }

  /** \brief Calls \a add with the indices of each cell. */
  template <typename Add> void readCells (Add&& add)
  {
    const std::uint64_t first = count ();
    const std::uint64_t second = count ();
    scanner_.line ();
    TextScanner ahead = scanner_;
    if (upperCase (ahead.bytes (std::string_view ("OFFSETS").size ())) == "OFFSETS")
      readOffsets (first, second, add);
    else
      readLists (first, second, add);
  }

  /** \brief The format before version 5: each cell is its size and its indices. */
  template <typename Add> void readLists (std::uint64_t cells, std::uint64_t size, Add&& add)
  {
    values_.require (size, sizeOf (ScalarType::Int32), 1);
    std::vector<std::int64_t> corners;
    for (std::uint64_t n = 0; n < cells; ++n)
    {
      const std::int64_t corner_count = (size > 0 ? values_.nextIndex (ScalarType::Int32) : -1);
      if (corner_count < 0 || static_cast<std::uint64_t> (corner_count) >= size)
        throw IoError ("a cell of the VTK file has an impossible number of corners");
      size -= static_cast<std::uint64_t> (corner_count) + 1;
      readIndices (static_cast<std::uint64_t> (corner_count), ScalarType::Int32, corners);
      add (corners);
    }
  }

  /** \brief The format since version 5: where the indices of each cell begin, and all of them. */
  template <typename Add> void readOffsets (std::uint64_t offset_count, std::uint64_t index_count, Add&& add)
  {
    scanner_.word ();
    std::vector<std::int64_t> offsets, indices, corners;
    readIndices (offset_count, type (), offsets);
    if (upperCase (scanner_.word ()) != "CONNECTIVITY")
      throw IoError ("the VTK file has offsets of cells without their connectivity");
    readIndices (index_count, type (), indices);
    for (std::size_t n = 1; n < offsets.size (); ++n)
    {
      if (offsets[n - 1] < 0 || offsets[n] < offsets[n - 1] || offsets[n] > static_cast<std::int64_t> (indices.size ()))
        throw IoError ("the offsets of the VTK file's cells do not fit their connectivity");
      corners.assign (indices.begin () + offsets[n - 1], indices.begin () + offsets[n]);
      add (corners);
    }
  }

  void readIndices (std::uint64_t size, ScalarType scalar, std::vector<std::int64_t>& indices)
  {
    values_.require (size, sizeOf (scalar), 1);
    indices.resize (size);
    for (std::int64_t& index : indices)
      index = values_.nextIndex (scalar);
  }

  /** \brief A number of arrays: name, components, tuples, type, values. */
  void skipField ()
  {
    scanner_.word (); // its name
    for (std::uint64_t arrays = count (); arrays > 0; --arrays)
    {
      if (upperCase (scanner_.word ()) == "METADATA") // of the array before
      {
        skipMetadata ();
        scanner_.word ();
      }
      const std::uint64_t components = count ();
      const std::uint64_t tuples = count ();
      const ScalarType scalar = type ();
      values_.require (components, sizeOf (scalar), 1);
      values_.require (tuples, static_cast<std::size_t> (components) * sizeOf (scalar),
                       static_cast<std::size_t> (components));
      for (std::uint64_t n = components * tuples; n > 0; --n)
        values_.next (scalar);
    }
  }

  /** \brief Skips lines up to an empty one. */
  void skipMetadata ()
  {
    scanner_.line ();
    while (!scanner_.left ().empty ())
    {
      TextScanner line (scanner_.line ());
      if (line.word ().empty ())
        return;
    }
  }

  TextScanner& scanner_;
  ValueReader values_;
  PolygonSoup soup_;
};

} // namespace

PolygonSoup
decodeVtk (const std::string& bytes)
{
  TextScanner scanner (bytes);
  scanner.line (); // the version: keywords show what differs between versions
  scanner.line (); // the title
  const std::string encoding = upperCase (scanner.word ());
  if (encoding != "ASCII" && encoding != "BINARY")
    throw IoError ("the VTK file must say ASCII or BINARY in its third line");
  return PolyDataReader (scanner, encoding == "ASCII" ? Encoding::Ascii : Encoding::BigEndian).read ();
}

} // namespace pcl::cosection
