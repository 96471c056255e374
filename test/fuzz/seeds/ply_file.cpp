// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "ply_file.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <sstream>

namespace fuzz {
namespace {

std::string
plyProperty (const Field& field)
{
  static const std::string reals[] = {"float", "double"};
  static const std::string integers[] = {"char", "short", "int"};
  const std::string type = field.type == 'F' ? reals[field.size / 8] : integers[field.size / 2];
  const std::string normal = "normal_";
  const bool is_normal = field.name.rfind (normal, 0) == 0;
  return (std::string ("property ") + (field.count > 1 ? "list uchar " : "") + (field.type == 'U' ? "u" : "") + type +
          " " + (is_normal ? "n" + field.name.substr (normal.size ()) : field.name) + "\n");
}

void
appendPly (std::string& bytes, const std::string& format, const Field& field, double value)
{
  if (format == "ascii")
  {
    std::ostringstream text;
    text.precision (digits);
    text << value << ' ';
    bytes += text.str ();
    return;
  }
  std::string typed;
  append (typed, field, value);
  if (format == "binary_big_endian")
    std::reverse (typed.begin (), typed.end ());
  bytes += typed;
}

} // namespace

std::string
plyFile (const std::vector<PlyElement>& elements, const std::string& format)
{
  std::string bytes = "ply\nformat " + format + " 1.0\ncomment a scan\nobj_info a sensor\n";
  for (const auto& [name, cloud] : elements)
  {
    bytes += "element " + name + " " + std::to_string (cloud.rows.size ()) + "\n";
    for (const Field& field : cloud.fields)
      bytes += plyProperty (field);
  }
  bytes += "end_header\n";
  for (const auto& [name, cloud] : elements)
    for (const auto& row : cloud.rows)
    {
      std::size_t column = 0;
      for (const Field& field : cloud.fields)
      {
        if (field.count > 1)
          appendPly (bytes, format, {"", 1, 'U', 1}, field.count);
        for (int n = 0; n < field.count; ++n)
          appendPly (bytes, format, field, row[column++]);
      }
      if (format == "ascii")
        bytes += '\n';
    }
  return (bytes);
}

PlyElement
cameraOf (const Cloud& cloud)
{
  std::array<double, 7> pose{};
  std::istringstream text (cloud.viewpoint);
  for (double& value : pose)
    text >> value;
  const Eigen::Matrix3d rotation = Eigen::Quaterniond (pose[3], pose[4], pose[5], pose[6]).normalized ().matrix ();
  Cloud camera = {1, 1, {}, {{}}, ""};
  const auto add = [&camera] (const std::string& name, int size, char type, double value) {
    camera.fields.push_back ({name, size, type, 1});
    camera.rows[0].push_back (value);
  };
  const std::string axes = "xyz";
  for (int axis = 0; axis < 3; ++axis)
    add (std::string ("view_p") + axes[axis], cloud.fields[0].size, 'F', pose[axis]);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      add (axes[row] + std::string ("_axis") + axes[column], 4, 'F', rotation (row, column));
  for (const char* name : {"focal", "scalex", "scaley", "centerx", "centery"})
    add (name, 4, 'F', 0.0);
  add ("viewportx", 4, 'I', cloud.width);
  add ("viewporty", 4, 'I', cloud.height);
  add ("k1", 4, 'F', 0.0);
  add ("k2", 4, 'F', 0.0);
  return {"camera", camera};
}

PlyElement
someFaces ()
{
  return {"face", {2, 1, {{"vertex_indices", 4, 'I', 3}}, {{0, 1, 2}, {1, 3, 2}}, ""}};
}

} // namespace fuzz
