// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcd_seeds.h"

#include "ply_file.h"
#include "test/common/replaced.h"

#include <pcl/io/lzf.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace fuzz {
using pcl::cosection::test::replaced;

namespace {

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
  text << "\nWIDTH " << cloud.width << "\nHEIGHT " << cloud.height << "\nVIEWPOINT " << cloud.viewpoint << "\nPOINTS "
       << cloud.rows.size () << "\nDATA " << encoding << "\n";
  return (text.str ());
}

std::string
asciiFile (const Cloud& cloud)
{
  std::ostringstream text;
  text.precision (digits);
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
  const std::uint32_t size = pcl::lzfCompress (raw.data (), raw_size, &packed[0],
                                               static_cast<std::uint32_t> (packed.size ()));
  if (size == 0)
    throw std::runtime_error ("cannot compress");
  std::string bytes = header (cloud, "binary_compressed");
  bytes.append (reinterpret_cast<const char*> (&size), sizeof (size));
  bytes.append (reinterpret_cast<const char*> (&raw_size), sizeof (raw_size));
  return (bytes + packed.substr (0, size));
}

const std::string seen_from = "0.1 -0.2 0.5 1 0 0 0";

const Field x = {"x", 4, 'F', 1}, y = {"y", 4, 'F', 1}, z = {"z", 4, 'F', 1};

/** \brief The image of a wall with a step, of a pinhole camera; labels 0 and 3, a few pixels without reading. */
Cloud
organised ()
{
  Cloud cloud = {10, 8, {x, y, z, {"rgb", 4, 'U', 1}, {"label", 4, 'U', 1}}, {}, seen_from};
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
  Cloud cloud = {24, 1, {x, y, z}, {}, seen_from};
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

const std::string default_viewpoint = "0 0 0 1 0 0 0";

/** \brief Points of a ball of 0.5 m, all around it or only those that are seen from the sensor, which the middle is
 * two metres before; or \a around the sensor. Their number decides on the code that they reach. */
struct Ball
{
  int points = 60;
  bool seen = false;
  bool around = false;
  double normal = 0.0; ///< length of the normals, negative: inward; 0: there are none
  bool intensity = false;
  bool labels = false; ///< 0 and 2, each a half
  std::string viewpoint = default_viewpoint;
};

Cloud
ball (const Ball& wanted)
{
  constexpr double radius = 0.5, distance = 2.0;
  Cloud cloud = {0, 1, {x, y, z}, {}, wanted.viewpoint};
  if (wanted.normal != 0.0)
    for (const char* name : {"normal_x", "normal_y", "normal_z"})
      cloud.fields.push_back ({name, 4, 'F', 1});
  if (wanted.intensity)
    cloud.fields.push_back ({"intensity", 4, 'F', 1});
  if (wanted.labels)
    cloud.fields.push_back ({"label", 4, 'U', 1});
  const int all = (wanted.seen ? 3 * wanted.points : wanted.points);
  for (int i = 0; i < all && static_cast<int> (cloud.rows.size ()) < wanted.points; ++i)
  {
    const double height = (2.0 * i + 1.0) / all - 1.0, r = std::sqrt (1.0 - height * height);
    const std::array<double, 3> outward = {r * std::cos (2.4 * i), r * std::sin (2.4 * i), height}; // the nearest first
    std::vector<double> row;
    for (int axis = 0; axis < 3; ++axis)
      row.push_back (radius * outward[axis] + (axis == 2 && !wanted.around ? distance : 0.0));
    if (wanted.normal != 0.0)
      for (const double component : outward)
        row.push_back (wanted.normal * component);
    if (wanted.intensity)
      row.push_back (0.5 + 0.5 * height);
    if (wanted.labels)
      row.push_back (outward[0] < 0.0 ? 0.0 : 2.0);
    cloud.rows.push_back (row);
  }
  cloud.width = static_cast<int> (cloud.rows.size ());
  return (cloud);
}

std::vector<Cloud>
balls ()
{
  const std::string viewpoint = "0.1 -0.2 0.5 0.9 0.1 -0.2 0.3";
  std::vector<Ball> wanted (11);
  wanted[0].points = 150; // from nowhere, no normals
  wanted[0].around = true;
  wanted[1].around = true; // from nowhere, inward normals
  wanted[1].normal = -1.0;
  wanted[1].labels = true;
  wanted[2].points = 100; // before a camera at the origin
  wanted[2].seen = true;
  wanted[3].seen = true; // the same with a viewpoint
  wanted[3].points = 300;
  wanted[3].viewpoint = viewpoint;
  wanted[4].seen = true;
  wanted[4].normal = 2.0;
  wanted[4].viewpoint = viewpoint;
  wanted[5].seen = true; // normals away from the viewpoint
  wanted[5].normal = -1.0;
  wanted[5].intensity = true;
  wanted[5].viewpoint = viewpoint;
  wanted[6].seen = true;
  wanted[6].labels = true;
  wanted[6].intensity = true;
  wanted[6].viewpoint = viewpoint;
  wanted[7].points = 300; // half of it hidden from its viewpoint
  wanted[7].viewpoint = viewpoint;
  wanted[8].around = true; // all around its viewpoint
  wanted[8].labels = true;
  wanted[8].viewpoint = viewpoint;
  wanted[9].points = 200;
  wanted[9].labels = true;
  wanted[10].points = 40; // too few for a picture
  wanted[10].seen = true;
  wanted[10].viewpoint = viewpoint;
  std::vector<Cloud> clouds;
  for (const Ball& b : wanted)
    clouds.push_back (ball (b));
  return (clouds);
}

/** \brief A cloud in survey coordinates (UTM), which floats would round; with its viewpoint, if it has one. */
Cloud
surveyed (Cloud cloud)
{
  const std::array<double, 3> there = {512434.0, 5405590.0, 348.0};
  for (int axis = 0; axis < 3; ++axis)
  {
    cloud.fields[axis].size = 8;
    for (auto& row : cloud.rows)
      row[axis] += there[axis];
  }
  if (cloud.viewpoint == default_viewpoint)
    return (cloud);
  std::istringstream old (cloud.viewpoint);
  std::ostringstream text;
  text.precision (digits);
  for (std::size_t n = 0; n < 7; ++n)
  {
    double value = 0.0;
    old >> value;
    text << (n == 0 ? "" : " ") << value + (n < there.size () ? there[n] : 0.0);
  }
  cloud.viewpoint = text.str ();
  return (cloud);
}

/** \brief A cloud with colours in three further fields. */
Cloud
coloured (Cloud cloud)
{
  for (const char* name : {"red", "green", "blue"})
    cloud.fields.push_back ({name, 1, 'U', 1});
  for (std::size_t i = 0; i < cloud.rows.size (); ++i)
    for (const double value : {200.0, 3.0 * static_cast<double> (i % 80), 7.0})
      cloud.rows[i].push_back (value);
  return (cloud);
}

std::vector<std::string>
plySeeds ()
{
  const Cloud image = coloured (organised ());
  const std::vector<Cloud> shapes = balls ();
  const Cloud normals_and_labels = shapes[1], with_intensity = coloured (shapes[6]), seen = shapes[3];
  const Cloud survey = surveyed (shapes[0]), seen_survey = surveyed (seen);
  const std::vector<std::vector<PlyElement>> files = {
      {{"vertex", image}, cameraOf (image)},
      {{"vertex", coloured (normals_and_labels)}},
      {{"vertex", shapes[4]}, someFaces (), cameraOf (shapes[4])},
      {{"vertex", with_intensity}, someFaces ()},
      {someFaces (), {"vertex", seen}, cameraOf (seen)},
      {{"vertex", unorganised ({{"histogram", 4, 'F', 5}, {"label", 2, 'I', 1}, {"id", 2, 'U', 2}}, 2.0)}},
      {{"vertex", unorganised ({{"scalar_Classification", 4, 'F', 1}, {"curvature", 8, 'F', 1}}, 6.0, 8)}},
      {{"vertex", survey}},
      {{"vertex", coloured (seen_survey)}, cameraOf (seen_survey)}};
  std::vector<std::string> seeds;
  for (const std::vector<PlyElement>& file : files)
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
      seeds.push_back (plyFile (file, format));
  return (seeds);
}

} // namespace

std::vector<std::string>
pcdSeeds ()
{
  std::vector<Cloud> clouds = {
      organised (),
      unorganised ({}, 0.0),
      unorganised ({}, 0.0, 8),
      unorganised (
          {{"normal_x", 4, 'F', 1}, {"normal_y", 4, 'F', 1}, {"normal_z", 4, 'F', 1}, {"curvature", 4, 'F', 1}}, 0.5),
      unorganised ({{"intensity", 4, 'F', 1}, {"label", 1, 'I', 1}}, 7.0),
      unorganised ({{"label", 8, 'U', 1}, {"rgba", 4, 'U', 1}}, 12345.0),
      unorganised ({{"histogram", 4, 'F', 5}, {"label", 2, 'I', 1}, {"id", 2, 'U', 2}}, 2.0)};
  for (const Cloud& cloud : balls ())
    clouds.push_back (cloud);
  for (const Cloud& cloud : {clouds[0], balls ()[0], balls ()[3]})
    clouds.push_back (surveyed (cloud));
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
  for (const std::string& seed : plySeeds ())
    seeds.push_back (seed);
  return (seeds);
}

} // namespace fuzz
