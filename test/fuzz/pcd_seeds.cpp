// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "pcd_seeds.h"

#include <pcl/io/lzf.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <stdexcept>

namespace fuzz
{

namespace
{

struct Field
{
  std::string name;
  int size;
  char type;
  int count;
};

/** \brief What a file holds: the value of each element of each field of each point. */
struct Cloud
{
  int width, height;
  std::vector<Field> fields;
  std::vector<std::vector<double>> rows;
};

template <typename T>
void
appendAs (std::string& bytes, double value)
{
  const T typed = static_cast<T> (value);
  bytes.append (reinterpret_cast<const char*> (&typed), sizeof (T));
}

void
append (std::string& bytes, const Field& field, double value)
{
  if (field.type == 'F')
    return (field.size == 4 ? appendAs<float> (bytes, value) : appendAs<double> (bytes, value));
  switch (field.size) // two's complement: the sign does not matter
  {
  case 1:
    return (appendAs<std::uint8_t> (bytes, value));
  case 2:
    return (appendAs<std::uint16_t> (bytes, value));
  case 4:
    return (appendAs<std::uint32_t> (bytes, value));
  default:
    return (appendAs<std::uint64_t> (bytes, value));
  }
}

std::string
header (const Cloud& cloud, const std::string& encoding)
{
  std::ostringstream text;
  text << "# .PCD v0.7\nVERSION 0.7\nFIELDS";
  for (const Field& f : cloud.fields)
    text << ' ' << f.name;
  text << "\nSIZE";
  for (const Field& f : cloud.fields)
    text << ' ' << f.size;
  text << "\nTYPE";
  for (const Field& f : cloud.fields)
    text << ' ' << f.type;
  text << "\nCOUNT";
  for (const Field& f : cloud.fields)
    text << ' ' << f.count;
  text << "\nWIDTH " << cloud.width << "\nHEIGHT " << cloud.height << "\nVIEWPOINT 0.1 -0.2 0.5 1 0 0 0\nPOINTS "
       << cloud.rows.size () << "\nDATA " << encoding << "\n";
  return (text.str ());
}

std::string
asciiFile (const Cloud& cloud)
{
  std::ostringstream text;
  text << header (cloud, "ascii");
  for (const auto& row : cloud.rows)
  {
    for (std::size_t i = 0; i < row.size (); ++i)
      text << (i == 0 ? "" : " ") << row[i];
    text << '\n';
  }
  return (text.str ());
}

std::string
binaryFile (const Cloud& cloud)
{
  std::string bytes = header (cloud, "binary");
  for (const auto& row : cloud.rows)
  {
    std::size_t column = 0;
    for (const Field& f : cloud.fields)
      for (int n = 0; n < f.count; ++n)
        append (bytes, f, row[column++]);
  }
  return (bytes);
}

/** \brief Field after field instead of point after point, compressed. */
std::string
compressedFile (const Cloud& cloud)
{
  std::string raw;
  int column = 0;
  for (const Field& f : cloud.fields)
  {
    for (const auto& row : cloud.rows)
      for (int n = 0; n < f.count; ++n)
        append (raw, f, row[column + n]);
    column += f.count;
  }
  std::string packed (2 * raw.size () + 64, '\0');
  const auto raw_size = static_cast<std::uint32_t> (raw.size ());
  const std::uint32_t size =
      pcl::lzfCompress (raw.data (), raw_size, &packed[0], static_cast<std::uint32_t> (packed.size ()));
  if (size == 0)
    throw std::runtime_error ("cannot compress");
  std::string bytes = header (cloud, "binary_compressed");
  bytes.append (reinterpret_cast<const char*> (&size), sizeof (size));
  bytes.append (reinterpret_cast<const char*> (&raw_size), sizeof (raw_size));
  return (bytes + packed.substr (0, size));
}

const Field x = {"x", 4, 'F', 1}, y = {"y", 4, 'F', 1}, z = {"z", 4, 'F', 1};

/** \brief The image of a wall with a step, of a pinhole camera; labels 0 and 3, a few pixels without reading. */
Cloud
organised ()
{
  Cloud cloud = {10, 8, {x, y, z, {"rgb", 4, 'U', 1}, {"label", 4, 'U', 1}}, {}};
  for (int v = 0; v < cloud.height; ++v)
    for (int u = 0; u < cloud.width; ++u)
    {
      const double depth = (u * v == 6) ? std::nan ("") : u < 5 ? 1.0 : 0.75;
      cloud.rows.push_back (
          {(u - 4.5) / 10.0 * depth, (v - 3.5) / 10.0 * depth, depth, 256.0 * u + v, u < 5 ? 0.0 : 3.0});
    }
  return (cloud);
}

/** \brief Points of a sphere with fields \a extra, whose elements are \a value. */
Cloud
unorganised (const std::vector<Field>& extra, double value, int size = 4)
{
  Cloud cloud = {24, 1, {x, y, z}, {}};
  for (Field& f : cloud.fields)
    f.size = size;
  cloud.fields.insert (cloud.fields.end (), extra.begin (), extra.end ());
  for (int i = 0; i < cloud.width; ++i)
  {
    const double height = 1.0 - (2.0 * i + 1.0) / cloud.width, r = std::sqrt (1.0 - height * height);
    std::vector<double> row = {r * std::cos (2.4 * i), r * std::sin (2.4 * i), height + 3.0};
    for (const Field& f : extra)
      row.insert (row.end (), static_cast<std::size_t> (f.count), value);
    cloud.rows.push_back (row);
  }
  return (cloud);
}

std::string
replaced (std::string text, const std::string& from, const std::string& to)
{
  return (text.replace (text.find (from), from.size (), to));
}

} // namespace

std::vector<std::string>
pcdSeeds ()
{
  const std::vector<Cloud> clouds = {
      organised (),
      unorganised ({}, 0.0),
      unorganised ({}, 0.0, 8),
      unorganised (
          {{"normal_x", 4, 'F', 1}, {"normal_y", 4, 'F', 1}, {"normal_z", 4, 'F', 1}, {"curvature", 4, 'F', 1}}, 0.5),
      unorganised ({{"intensity", 4, 'F', 1}, {"label", 1, 'I', 1}}, 7.0),
      unorganised ({{"label", 8, 'U', 1}, {"rgba", 4, 'U', 1}}, 12345.0),
      unorganised ({{"histogram", 4, 'F', 5}, {"label", 2, 'I', 1}, {"id", 2, 'U', 2}}, 2.0)};
  std::vector<std::string> seeds;
  for (const Cloud& cloud : clouds)
  {
    seeds.push_back (asciiFile (cloud));
    seeds.push_back (binaryFile (cloud));
    seeds.push_back (compressedFile (cloud));
  }
  const Cloud padded = unorganised ({{"_", 1, 'U', 4}, {"label", 4, 'U', 1}}, 1.0); // as PCL writes its structs
  seeds.push_back (asciiFile (padded));
  seeds.push_back (binaryFile (padded));
  seeds.push_back (replaced (seeds[0], "VERSION", "# a comment\n\nVERSION"));
  seeds.push_back (replaced (replaced (seeds[3], "COUNT 1 1 1\n", ""), "VIEWPOINT 0.1 -0.2 0.5 1 0 0 0\n", ""));
  return (seeds);
}

} // namespace fuzz
