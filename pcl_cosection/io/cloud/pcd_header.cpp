// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "cloud_decoders.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <istream>
#include <iterator>
#include <set>
#include <sstream>

namespace pcl::cosection {
namespace {

constexpr std::size_t max_elements = 1 << 12; ///< in one field; descriptors have some hundreds
constexpr std::uint64_t max_points = 0x7fffffff;
constexpr double max_viewpoint = 1e15;       ///< in any unit; beyond it sums of squares overflow a float
constexpr std::uint64_t max_lzf_ratio = 264; ///< longest match of LZF; bounds what a compressed block can hold

const std::string unknown_format = "is neither a PCD nor a PLY file; convert it to one of them, for example with "
                                   "CloudCompare or MeshLab";

using Tokens = std::vector<std::string>;

[[noreturn]] void
fail (const std::string& path, const std::string& reason)
{
  throw IoError (path + ": " + reason);
}

Tokens
split (const std::string& line)
{
  std::istringstream stream (line);
  return (Tokens (std::istream_iterator<std::string> (stream), {}));
}

std::uint64_t
parseCount (const std::string& path, const std::string& key, const std::string& token, std::uint64_t limit)
{
  const bool digits = !token.empty () && token.size () < 19 &&
                      std::all_of (token.begin (), token.end (), [] (char c) { return (c >= '0' && c <= '9'); });
  const std::uint64_t value = digits ? std::strtoull (token.c_str (), nullptr, 10) : limit + 1;
  if (value > limit)
    fail (path, key + " is " + printable (token) + ", it must be a whole number from 0 to " + std::to_string (limit));
  return (value);
}

class HeaderParser
{
public:
  explicit HeaderParser (const std::string& path) : path_ (path) {}

  CloudHeader parse (const std::string& text)
  {
    const std::string mark = "\xef\xbb\xbf"; // of UTF-8, as some editors write it
    std::size_t begin = text.compare (0, mark.size (), mark) == 0 ? mark.size () : 0;
    for (std::size_t end = text.find ('\n'); end != text.npos; end = text.find ('\n', begin))
    {
      const Tokens tokens = split (text.substr (begin, end - begin));
      begin = end + 1;
      if (tokens.empty () || tokens[0][0] == '#')
        continue;
      parseLine (tokens);
      if (tokens[0] == "DATA")
      {
        header_.data_offset = begin;
        check ();
        return (header_);
      }
    }
    fail (path_, known_lines_ == 0 ? unknown_format : "the PCD header has no DATA line");
  }

private:
  void parseLine (const Tokens& tokens)
  {
    const std::string& key = tokens[0];
    if (!seen_.insert (key == "COLUMNS" ? "FIELDS" : key).second)
      fail (path_, "the PCD header has two lines " + printable (key));
    if (key == "VERSION")
      ;
    else if (key == "FIELDS" || key == "COLUMNS")
      for (std::size_t i = 1; i < tokens.size (); ++i)
        header_.fields.push_back ({tokens[i], 0, 0, 1});
    else if (key == "SIZE")
      perField (tokens, [&] (CloudField& f, const std::string& t) { f.size = parseCount (path_, key, t, 8); });
    else if (key == "TYPE")
      perField (tokens, [] (CloudField& f, const std::string& t) { f.type = t[0]; });
    else if (key == "COUNT")
      perField (tokens,
                [&] (CloudField& f, const std::string& t) { f.count = parseCount (path_, key, t, max_elements); });
    else if (key == "WIDTH" || key == "HEIGHT" || key == "POINTS")
    {
      if (tokens.size () != 2)
        fail (path_, key + " in the PCD header must have one value");
      (key == "WIDTH"    ? header_.width
       : key == "HEIGHT" ? header_.height
                         : header_.points) = parseCount (path_, key, tokens[1], max_points);
    }
    else if (key == "VIEWPOINT")
      parseViewpoint (tokens);
    else if (key == "DATA")
      parseEncoding (tokens);
    else
      fail (path_,
            known_lines_ == 0 ? unknown_format : "the PCD header has an unknown line \"" + printable (key) + "\"");
    ++known_lines_;
  }

  template <typename Assign> void perField (const Tokens& tokens, Assign&& assign)
  {
    if (header_.fields.empty () || tokens.size () != header_.fields.size () + 1)
      fail (path_, tokens[0] + " in the PCD header must have one value for each of the " +
                       std::to_string (header_.fields.size ()) + " FIELDS");
    for (std::size_t i = 0; i < header_.fields.size (); ++i)
      assign (header_.fields[i], tokens[i + 1]);
  }

  void parseViewpoint (const Tokens& tokens)
  {
    bool good = tokens.size () == 8;
    for (std::size_t i = 0; good && i < 7; ++i)
    {
      const std::string& token = tokens[i + 1];
      char* end = nullptr; // strtod reads "nan", "inf" and everything that PCL writes
      header_.viewpoint[i] = std::strtod (token.c_str (), &end);
      good = end == token.c_str () + token.size () && std::abs (header_.viewpoint[i]) <= max_viewpoint;
    }
    const auto& v = header_.viewpoint;
    if (!good || !(std::hypot (std::hypot (v[3], v[4]), std::hypot (v[5], v[6])) > 1e-6))
      fail (path_, "VIEWPOINT must be tx ty tz qw qx qy qz of finite numbers, with a quaternion that is not zero");
  }

  void parseEncoding (const Tokens& tokens)
  {
    const std::string name = tokens.size () == 2 ? tokens[1] : "";
    if (name == "ascii")
      header_.encoding = CloudEncoding::Ascii;
    else if (name == "binary")
      header_.encoding = CloudEncoding::Binary;
    else if (name == "binary_compressed")
      header_.encoding = CloudEncoding::BinaryCompressed;
    else
      fail (path_, "DATA is \"" + printable (name) + "\", it must be ascii, binary or binary_compressed");
  }

  void check ()
  {
    if (header_.fields.empty ())
      fail (path_, "the PCD header has no FIELDS");
    for (const CloudField& field : header_.fields)
    {
      const bool integer = field.type == 'I' || field.type == 'U';
      const bool good = (integer && (field.size == 1 || field.size == 2)) ||
                        ((integer || field.type == 'F') && (field.size == 4 || field.size == 8));
      if (!good || field.count == 0)
        fail (path_, "field " + printable (field.name) + " has an invalid SIZE, TYPE or COUNT");
    }
    if (seen_.count ("POINTS") == 0)
    {
      header_.points = header_.width * header_.height;
      if (header_.points > max_points)
        fail (path_, "WIDTH times HEIGHT must be at most " + std::to_string (max_points));
    }
    if (header_.points == 0)
      throw DegenerateInput (path_ + ": holds no points");
    if (header_.width == 0 && header_.height <= 1) // files older than version 0.6
    {
      header_.width = header_.points;
      header_.height = 1;
    }
    if (header_.width * header_.height != header_.points)
      fail (path_, "WIDTH " + std::to_string (header_.width) + " times HEIGHT " + std::to_string (header_.height) +
                       " is not POINTS " + std::to_string (header_.points));
  }

  const std::string path_;
  CloudHeader header_;
  int known_lines_ = 0;
  std::set<std::string> seen_;
};

[[noreturn]] void
failTruncated (const std::string& path, std::uint64_t needed, std::uint64_t found)
{
  fail (path, "is truncated: its header announces " + std::to_string (needed) + " bytes of points, there are " +
                  std::to_string (found));
}

void
checkCompressed (const std::string& path, const CloudHeader& header, std::istream& file, std::uint64_t found)
{
  std::array<std::uint32_t, 2> sizes{}; // compressed, uncompressed
  file.seekg (static_cast<std::streamoff> (header.data_offset));
  if (found < sizeof (sizes) || !file.read (reinterpret_cast<char*> (sizes.data ()), sizeof (sizes)))
    failTruncated (path, sizeof (sizes), found);
  if (sizes[0] > found - sizeof (sizes))
    failTruncated (path, sizes[0], found - sizeof (sizes));
  if (sizes[1] != header.points * header.pointBytes (CloudPadding::Excluded) || sizes[1] > sizes[0] * max_lzf_ratio)
    fail (path, "its compressed points do not have the size that its header announces");
}

} // namespace

CloudHeader
parsePcdHeader (const std::string& path, const std::string& text, std::istream& file, std::uint64_t size)
{
  CloudHeader header = HeaderParser (path).parse (text);
  const std::uint64_t found = size - header.data_offset;
  std::uint64_t shortest = header.points * header.pointBytes ();
  if (header.encoding == CloudEncoding::Ascii)
  {
    std::uint64_t values = 0;
    for (const CloudField& field : header.fields)
      values += field.count;
    shortest = 2 * values * header.points - 1; // a digit and a separator each
  }
  file.clear ();
  if (header.encoding == CloudEncoding::BinaryCompressed)
    checkCompressed (path, header, file, found);
  else if (found < shortest)
    failTruncated (path, shortest, found);
  return (header);
}

} // namespace pcl::cosection
