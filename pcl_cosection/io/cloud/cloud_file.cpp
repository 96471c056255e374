// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "cloud_file.h"

#include "cloud_columns.h"
#include "cloud_decoders.h"
#include "pcl_cosection/io/lower_case.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr std::size_t max_header_bytes = 1 << 16;

[[noreturn]] void
fail (const std::string& path, const std::string& reason)
{
  throw IoError (path + ": " + reason);
}

/** \brief A name as programs vary it: scalar_Label is label, Normal_X and NormalX are normalx. */
std::string
plainName (const std::string& name)
{
  std::string plain = lowerCase (name);
  if (constexpr std::string_view prefix = "scalar_"; plain.compare (0, prefix.size (), prefix) == 0)
    plain.erase (0, prefix.size ());
  plain.erase (std::remove (plain.begin (), plain.end (), '_'), plain.end ());
  return plain;
}

template <typename T>
bool
store (double value, std::uint8_t* target)
{
  T typed = 0;
  if constexpr (std::numeric_limits<T>::is_integer)
  {
    const double rounded = std::isnan (value) ? 0.0 : std::trunc (value);
    const double end = std::ldexp (1.0, std::numeric_limits<T>::digits); // one more than the largest
    if (!(rounded < end && rounded >= (std::numeric_limits<T>::is_signed ? -end : 0.0)))
      return (false);
    typed = static_cast<T> (rounded);
  }
  else if (std::abs (value) > std::numeric_limits<T>::max ())
    typed = static_cast<T> (std::copysign (std::numeric_limits<T>::infinity (), value));
  else
    typed = static_cast<T> (value);
  std::memcpy (target, &typed, sizeof (T));
  return (true);
}

/** \brief Add a field rgb, made of red, green and blue. */
void
packColours (const std::string& path, CloudHeader& header, PCLPointCloud2& cloud)
{
  std::array<const CloudField*, 3> fields = {header.findAlike ({"red", "r", "diffuse_red"}),
                                             header.findAlike ({"green", "g", "diffuse_green"}),
                                             header.findAlike ({"blue", "b", "diffuse_blue"})};
  if (header.find ("rgb") || header.find ("rgba") ||
      !std::all_of (fields.begin (), fields.end (), [] (const CloudField* f) { return f && f->count == 1; }))
    return;
  const std::array<CloudColumn, 3> columns = {CloudColumn (path, cloud, *fields[0]),
                                              CloudColumn (path, cloud, *fields[1]),
                                              CloudColumn (path, cloud, *fields[2])};
  double largest = 0.0;
  for (std::size_t i = 0; i < header.points; ++i)
    for (const CloudColumn& column : columns)
      if (const double value = column.number (i); std::isfinite (value))
        largest = std::max (largest, value);
  const bool real = fields[0]->type == 'F';
  const double scale = real && largest <= 1.0 ? 255.0 : largest > 255.0 ? 1.0 / 257.0 : 1.0; // of reals, 8 or 16 bits
  const std::size_t old_step = cloud.point_step;
  const std::size_t step = old_step + sizeof (std::uint32_t);
  std::vector<std::uint8_t> data (header.points * step);
  for (std::size_t i = 0; i < header.points; ++i)
  {
    std::uint32_t packed = 0;
    for (const CloudColumn& column : columns)
    {
      const double value = scale * column.number (i);
      packed = packed << 8 | static_cast<std::uint32_t> (std::isnan (value) ? 0.0 : std::clamp (value, 0.0, 255.0));
    }
    std::memcpy (&data[i * step], &cloud.data[i * old_step], old_step);
    std::memcpy (&data[i * step + old_step], &packed, sizeof (packed));
  }
  cloud.data = std::move (data);
  cloud.point_step = static_cast<std::uint32_t> (step);
  PCLPointField described;
  described.name = "rgb";
  described.offset = static_cast<std::uint32_t> (old_step);
  described.count = 1;
  cloud.fields.push_back (described);
  header.fields.push_back ({"rgb", sizeof (std::uint32_t), 'U', 1});
}

} // namespace

const CloudField*
CloudHeader::find (const std::string& name) const
{
  const auto found = std::find_if (fields.begin (), fields.end (),
                                   [&] (const CloudField& f) { return (f.name == name); });
  return (found == fields.end () ? nullptr : &*found);
}

const CloudField*
CloudHeader::findAlike (const std::vector<std::string>& names) const
{
  for (const std::string& name : names)
    for (const CloudField& field : fields)
      if (plainName (field.name) == plainName (name))
        return &field;
  return nullptr;
}

std::uint64_t
CloudHeader::pointBytes (CloudPadding padding) const
{
  std::uint64_t bytes = 0;
  for (const CloudField& field : fields)
    if (padding == CloudPadding::Included || !field.isPadding ())
      bytes += field.size * field.count;
  return (bytes);
}

std::string
printable (const std::string& text)
{
  std::string result;
  for (const char c : text.substr (0, 60))
    result += (c >= ' ' && c <= '~') ? c : '?';
  return (result);
}

CloudHeader
readCloudHeader (const std::string& path)
{
  std::error_code failure;
  const auto status = std::filesystem::status (path, failure);
  if (status.type () == std::filesystem::file_type::not_found)
    fail (path, "no such file");
  if (std::filesystem::is_directory (status))
    fail (path, "is a directory, not a PCD or PLY file");
  if (failure || !std::filesystem::is_regular_file (status))
    fail (path, "is not a regular file");
  std::ifstream file (path, std::ios::binary);
  if (!file)
    fail (path, std::string ("cannot be read: ") + std::strerror (errno));
  const std::uint64_t size = std::filesystem::file_size (path, failure);
  if (failure)
    fail (path, "cannot be read: " + failure.message ());
  if (size == 0)
    fail (path, "is empty, not a PCD or PLY file");

  std::string text (std::min<std::uint64_t> (size, max_header_bytes), '\0');
  if (!file.read (&text[0], static_cast<std::streamsize> (text.size ())))
    fail (path, "cannot be read");
  const bool is_ply = text.compare (0, 4, "ply\n") == 0 || text.compare (0, 4, "ply\r") == 0;
  return is_ply ? parsePlyCloudHeader (path, text, size) : parsePcdHeader (path, text, file, size);
}

PCLPointCloud2
readCloudPoints (const std::string& path, CloudHeader& header)
{
  PCLPointCloud2 cloud = header.encoding == CloudEncoding::Ply ? readPlyPoints (path, header)
                                                               : readPcdPoints (path, header);
  packColours (path, header, cloud);
  return cloud;
}

PCLPointCloud2
emptyCloud (const CloudHeader& header, CloudPadding padding)
{
  PCLPointCloud2 cloud;
  std::uint32_t offset = 0;
  for (const CloudField& field : header.fields)
  {
    if (padding == CloudPadding::Excluded && field.isPadding ())
      continue;
    PCLPointField described;
    described.name = field.name;
    described.offset = offset;
    described.count = static_cast<std::uint32_t> (field.count);
    cloud.fields.push_back (described);
    offset += static_cast<std::uint32_t> (field.size * field.count);
  }
  cloud.point_step = offset;
  cloud.data.resize (header.points * offset);
  return (cloud);
}

StoreNumber
storeFor (const CloudField& field)
{
  const bool is_signed = field.type == 'I';
  if (field.type == 'F')
    return (field.size == 4 ? store<float> : store<double>);
  switch (field.size)
  {
  case 1:
    return (is_signed ? store<std::int8_t> : store<std::uint8_t>);
  case 2:
    return (is_signed ? store<std::int16_t> : store<std::uint16_t>);
  case 4:
    return (is_signed ? store<std::int32_t> : store<std::uint32_t>);
  default:
    return (is_signed ? store<std::int64_t> : store<std::uint64_t>);
  }
}

} // namespace pcl::cosection
