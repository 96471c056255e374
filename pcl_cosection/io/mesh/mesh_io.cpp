// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "pcl_cosection/common/file_bytes.h"
#include "pcl_cosection/io/file_extension.h"
#include "pcl_cosection/mesh/mesh_checks.h"
#include "ply_mesh.h"

#include "pcl_cosection/common/atomic_file.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>

#include <Eigen/Geometry>

#include <array>
#include <charconv>
#include <cstring>
#include <limits>

namespace pcl::cosection {
namespace {

/** \brief Binary STL: 80 bytes of title, the number of triangles, and for each one its normal, its
 * corners and two unused bytes. */
std::string
encodeStl (const TriangleMesh& mesh)
{
  constexpr std::size_t header_size = 84;
  constexpr std::size_t triangle_size = 50;
  const char title[] = "binary STL, metres"; // must not begin with "solid", as text files do
  std::string bytes (header_size + triangle_size * mesh.triangles.size (), '\0');
  std::memcpy (&bytes[0], title, sizeof (title));
  const auto count = static_cast<std::uint32_t> (mesh.triangles.size ());
  std::memcpy (&bytes[80], &count, sizeof (count));
  char* out = &bytes[0] + header_size;
  for (const auto& triangle : mesh.triangles)
  {
    Eigen::Matrix<float, 3, 4> record;
    for (int n = 0; n < 3; ++n)
      record.col (n + 1) = mesh.vertices[triangle[n]];
    const Eigen::Vector3d a = record.col (1).cast<double> ();
    const Eigen::Vector3d normal = (record.col (2).cast<double> () - a).cross (record.col (3).cast<double> () - a);
    record.col (0) = normal.normalized ().cast<float> ();
    std::memcpy (out, record.data (), sizeof (float) * 12);
    out += triangle_size;
  }
  return bytes;
}

/** \brief Appends a number as text, in full precision whatever the locale. */
template <typename T>
void
appendNumber (std::string& text, T value)
{
  std::array<char, 32> digits;
  const auto result = std::to_chars (digits.data (), digits.data () + digits.size (), value);
  text.append (digits.data (), result.ptr);
}

void
appendVectors (std::string& text, const char* keyword, const std::vector<Eigen::Vector3f>& vectors)
{
  for (const auto& v : vectors)
  {
    text += keyword;
    for (int axis = 0; axis < 3; ++axis)
    {
      text += ' ';
      appendNumber (text, v[axis]);
    }
    text += '\n';
  }
}

std::string
encodeObj (const TriangleMesh& mesh)
{
  std::string text = "# metres\n";
  appendVectors (text, "v", mesh.vertices);
  appendVectors (text, "vn", mesh.normals);
  for (const auto& triangle : mesh.triangles)
  {
    text += 'f';
    for (const auto v : triangle)
    {
      text += ' ';
      appendNumber (text, std::uint64_t{v} + 1);
      if (!mesh.normals.empty ())
      {
        text += "//";
        appendNumber (text, std::uint64_t{v} + 1);
      }
    }
    text += '\n';
  }
  return text;
}

using Encoder = std::string (*) (const TriangleMesh&);

Encoder
encoderFor (const std::string& path)
{
  const std::string extension = lowerCaseExtension (path);
  if (extension == ".ply")
    return encodePly;
  if (extension == ".stl")
    return encodeStl;
  if (extension == ".obj")
    return encodeObj;
  throw InvalidArgument ("cannot write a mesh to '" + path + "': the extension must be .ply, .stl or .obj");
}

} // namespace

void
saveMesh (const TriangleMesh& mesh, const std::string& path)
{
  const Encoder encode = encoderFor (path);
  checkMesh (mesh);
  if (mesh.vertices.size () > std::numeric_limits<std::int32_t>::max ())
    throw InvalidArgument ("cannot write '" + path + "': too many vertices for the format's 32-bit indices");
  writeAtomically (path, [&] (const std::string& temporary) { writeBytes (temporary, encode (mesh)); });
}

TriangleMesh
loadPlyMesh (const std::string& path)
{
  const std::string bytes = readBytes (path);
  try
  {
    return decodePly (bytes);
  }
  catch (const IoError& error)
  {
    throw IoError ("cannot read '" + path + "': " + error.what ());
  }
}

} // namespace pcl::cosection
