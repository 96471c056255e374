// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "cloud_decoders.h"

#include <pcl/cosection/common/error.h>

#include <pcl/io/lzf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>

namespace pcl::cosection {
namespace {

void
readBytes (const std::string& path, std::istream& file, void* bytes, std::size_t size)
{
  if (!file.read (static_cast<char*> (bytes), static_cast<std::streamsize> (size)))
    throw IoError (path + ": ends before its points do");
}

/** \brief Field after field instead of point after point, compressed by LZF. */
PCLPointCloud2
readCompressed (const std::string& path, const CloudHeader& header, std::istream& file)
{
  PCLPointCloud2 cloud = emptyCloud (header, CloudPadding::Excluded);
  std::array<std::uint32_t, 2> sizes{}; // compressed, uncompressed
  readBytes (path, file, sizes.data (), sizeof (sizes));
  std::vector<char> packed (sizes[0]), columns (cloud.data.size ());
  readBytes (path, file, packed.data (), packed.size ());
  if (packed.empty () || columns.size () != sizes[1] ||
      lzfDecompress (packed.data (), sizes[0], columns.data (), sizes[1]) != sizes[1])
    throw IoError (path + ": its points cannot be decoded; the file is damaged");
  const char* source = columns.data ();
  std::size_t offset = 0;
  for (const CloudField& field : header.fields)
  {
    if (field.isPadding ())
      continue;
    const std::size_t bytes = field.size * field.count;
    for (std::size_t i = 0; i < header.points; ++i, source += bytes)
      std::memcpy (&cloud.data[i * cloud.point_step + offset], source, bytes);
    offset += bytes;
  }
  return (cloud);
}

/** \brief One number of a point: where it goes. */
struct Element
{
  const CloudField* field;
  StoreNumber store;
  std::size_t offset;
};

std::vector<Element>
elementsOf (const CloudHeader& header)
{
  std::vector<Element> elements;
  std::size_t offset = 0;
  for (const CloudField& field : header.fields)
    for (std::size_t n = 0; n < field.count; ++n, offset += field.size)
      elements.push_back ({&field, storeFor (field), offset});
  return (elements);
}

/** \brief Reads the lines of an ASCII file, one point each. */
class AsciiDecoder
{
public:
  AsciiDecoder (const std::string& path, const CloudHeader& header)
      : path_ (path)
      , elements_ (elementsOf (header))
      , cloud_ (emptyCloud (header, CloudPadding::Included))
  {}

  PCLPointCloud2 decode (std::istream& file, CloudHeader& header)
  {
    const std::size_t points = header.points;
    std::string line;
    while (row_ < points && std::getline (file, line))
      decodeLine (line);
    if (row_ < points)
      throw IoError (path_ + ": is truncated: its header announces " + std::to_string (points) + " points, there are " +
                     std::to_string (row_));
    while (!header.has_more && std::getline (file, line))
    {
      const char* p = line.c_str ();
      header.has_more = skipWhite (p, p + line.size ());
    }
    return (std::move (cloud_));
  }

private:
  /** \brief The next number of a line, which moves \a p behind it. */
  double number (const char*& p, const char* end) const
  {
    const char* const token = p;
    while (p != end && !isWhite (*p))
      ++p;
    char* last = nullptr; // strtod reads "nan", "inf" and everything that PCL writes
    const double value = std::strtod (token, &last);
    if (last != p)
      fail (std::string (token, p), std::string ("which is not a number") +
                                        (std::find (token, p, ',') == p ? "" : " (a decimal point, not a comma)"));
    return (value);
  }

  void decodeLine (const std::string& line)
  {
    const char* p = line.c_str ();
    const char* const end = p + line.size ();
    std::uint8_t* const point = cloud_.data.data () + row_ * cloud_.point_step;
    std::size_t count = 0;
    for (; skipWhite (p, end); ++count)
    {
      const char* const token = p;
      const double value = number (p, end);
      if (count >= elements_.size ())
        continue;
      const Element& element = elements_[count];
      if (!element.store (value, point + element.offset) && !element.field->isPadding ())
        fail (std::string (token, p), "which field " + printable (element.field->name) + " cannot hold");
    }
    if (count == 0)
      return;
    if (count != elements_.size ())
      throw IoError (path_ + ": point " + std::to_string (row_) + " has " + std::to_string (count) +
                     " values, its header announces " + std::to_string (elements_.size ()));
    ++row_;
  }

  static bool isWhite (char c) { return (c == ' ' || c == '\t' || c == '\r'); }

  /** \return whether something else follows */
  static bool skipWhite (const char*& p, const char* end)
  {
    while (p != end && isWhite (*p))
      ++p;
    return (p != end);
  }

  [[noreturn]] void fail (const std::string& token, const std::string& reason) const
  {
    throw IoError (path_ + ": point " + std::to_string (row_) + " holds \"" + printable (token) + "\", " + reason);
  }

  const std::string path_;
  const std::vector<Element> elements_;
  PCLPointCloud2 cloud_;
  std::size_t row_ = 0;
};

} // namespace

PCLPointCloud2
readPcdPoints (const std::string& path, CloudHeader& header)
{
  std::ifstream file (path, std::ios::binary);
  file.seekg (static_cast<std::streamoff> (header.data_offset));
  if (!file)
    throw IoError (path + ": cannot be read");
  if (header.encoding == CloudEncoding::Ascii)
    return (AsciiDecoder (path, header).decode (file, header));
  if (header.encoding == CloudEncoding::BinaryCompressed)
    return (readCompressed (path, header, file));
  PCLPointCloud2 cloud = emptyCloud (header, CloudPadding::Included);
  readBytes (path, file, cloud.data.data (), cloud.data.size ());
  file.seekg (static_cast<std::streamoff> (cloud.point_step) - 1, std::ios::cur);
  header.has_more = file.get () != std::ifstream::traits_type::eof ();
  return (cloud);
}

} // namespace pcl::cosection
