// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/io/mesh_io.h>

#include "pcl_cosection/common/files.h"
#include "pcl_cosection/common/number_text.h"
#include "pcl_cosection/io/lower_case.h"
#include "pcl_cosection/mesh/mesh_checks.h"
#include "vtk_errors.h"

#include <pcl/cosection/common/error.h>

#include <Eigen/Geometry>

#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLImageDataWriter.h>

#include <cstring>
#include <limits>
#include <locale>
#include <sstream>

namespace pcl::cosection {
namespace {

/** \brief Append the value at \a index, if there are any. */
template <typename T>
void
appendValue (std::string& bytes, const std::vector<T>& values, std::size_t index)
{
  if (!values.empty ())
    bytes.append (reinterpret_cast<const char*> (&values[index]), sizeof (T));
}

/** \brief Binary little-endian PLY with all vertex properties of the mesh. */
std::string
encodePly (const TriangleMesh& mesh, const Eigen::Vector3d& origin)
{
  const bool in_doubles = !origin.isZero (0.0);
  const std::string real = in_doubles ? "double" : "float";
  std::ostringstream header;
  header.imbue (std::locale::classic ());
  header << "ply\nformat binary_little_endian 1.0\nelement vertex " << mesh.vertices.size () << "\nproperty " << real
         << " x\nproperty " << real << " y\nproperty " << real << " z\n";
  if (!mesh.normals.empty ())
    header << "property float nx\nproperty float ny\nproperty float nz\n";
  if (!mesh.colours.empty ())
    header << "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  if (!mesh.intensity.empty ())
    header << "property float intensity\n";
  if (!mesh.confidence.empty ())
    header << "property float confidence\n";
  if (!mesh.sigma_m.empty ())
    header << "property float sigma_m\n";
  if (!mesh.provenance.empty ())
    header << "property uchar provenance\n";
  header << "element face " << mesh.triangles.size () << "\nproperty list uchar int vertex_indices\nend_header\n";

  std::string bytes = header.str ();
  bytes.reserve (bytes.size () + mesh.vertices.size () * 32 + mesh.triangles.size () * 13);
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
  {
    if (const Eigen::Vector3d p = mesh.vertices[v].cast<double> () + origin; in_doubles)
      bytes.append (reinterpret_cast<const char*> (p.data ()), sizeof (p));
    else
      appendValue (bytes, mesh.vertices, v);
    appendValue (bytes, mesh.normals, v);
    appendValue (bytes, mesh.colours, v);
    appendValue (bytes, mesh.intensity, v);
    appendValue (bytes, mesh.confidence, v);
    appendValue (bytes, mesh.sigma_m, v);
    appendValue (bytes, mesh.provenance, v);
  }
  for (std::size_t t = 0; t < mesh.triangles.size (); ++t)
  {
    bytes += '\3'; // corners
    appendValue (bytes, mesh.triangles, t);
  }
  return bytes;
}

/** \brief Binary STL: 80 bytes of title, the number of triangles, and for each one its normal, its
 * corners and two unused bytes. */
std::string
encodeStl (const TriangleMesh& mesh, const Eigen::Vector3d& /*origin*/)
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

void
appendLine (std::string& text, const char* keyword, const std::string& values)
{
  ((text += keyword) += ' ') += values;
  text += '\n';
}

/** \brief Text, with normals; colours follow the coordinates, as many programs write them. */
std::string
encodeObj (const TriangleMesh& mesh, const Eigen::Vector3d& origin)
{
  constexpr float full = 255.0f;
  std::string text = "# metres\n";
  for (std::size_t n = 0; n < mesh.vertices.size (); ++n)
  {
    const Eigen::Vector3f& v = mesh.vertices[n];
    std::string values = origin.isZero (0.0) ? numbersText (v) : numbersText ((v.cast<double> () + origin).eval ());
    if (!mesh.colours.empty ())
      for (const std::uint8_t channel : mesh.colours[n])
        appendNumber (values += ' ', static_cast<float> (channel) / full);
    appendLine (text, "v", values);
  }
  for (const Eigen::Vector3f& normal : mesh.normals)
    appendLine (text, "vn", numbersText (normal));
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

using Encoder = std::string (*) (const TriangleMesh&, const Eigen::Vector3d& origin);

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

/** \brief Lends \a values to the image, which only reads them. */
template <typename Array, typename T>
void
addArray (vtkImageData& image, const char* name, const std::vector<T>& values)
{
  vtkNew<Array> array;
  array->SetName (name);
  array->SetArray (const_cast<T*> (values.data ()), static_cast<vtkIdType> (values.size ()), 1);
  image.GetPointData ()->AddArray (array);
}

} // namespace

void
saveMesh (const TriangleMesh& mesh, const std::string& path, const Eigen::Vector3d& origin)
{
  const Encoder encode = encoderFor (path);
  checkMesh (mesh);
  if (mesh.vertices.size () > std::numeric_limits<std::int32_t>::max ())
    throw InvalidArgument ("cannot write '" + path + "': too many vertices for the format's 32-bit indices");
  writeAtomically (path, [&] (const std::string& temporary) { writeBytes (temporary, encode (mesh, origin)); });
}

void
saveSignedDistance (const SignedDistanceField& field, const std::string& path, const Eigen::Vector3d& origin)
{
  const VoxelGrid& grid = field.grid;
  if (grid.dims.minCoeff () < 1 || field.values.size () != grid.size () ||
      (!field.supported.empty () && field.supported.size () != grid.size ()))
    throw InvalidArgument ("cannot write '" + path + "': the field must have one value per voxel");

  vtkNew<vtkImageData> image;
  image->SetDimensions (grid.dims.x (), grid.dims.y (), grid.dims.z ());
  image->SetSpacing (grid.voxel_size_m, grid.voxel_size_m, grid.voxel_size_m);
  const Eigen::Vector3d first = grid.origin_m + origin;
  image->SetOrigin (first.x (), first.y (), first.z ());
  addArray<vtkFloatArray> (*image, "signed_distance", field.values);
  if (!field.supported.empty ())
    addArray<vtkUnsignedCharArray> (*image, "supported", field.supported);
  image->GetPointData ()->SetActiveScalars ("signed_distance");

  writeAtomically (path, [&] (const std::string& temporary) {
    // VTK encodes, we write: its own report of a full disk or a missing right says little.
    vtkNew<vtkXMLImageDataWriter> writer;
    const auto errors = VtkErrors::observe (*writer);
    writer->SetInputData (image);
    writer->EncodeAppendedDataOff ();
    writer->SetCompressorTypeToNone (); // compressing would take several times as long as all the rest
    writer->SetHeaderTypeToUInt64 ();
    writer->WriteToOutputStringOn ();
    if (writer->Write () == 0 || errors->failed ())
      throw IoError ("cannot write '" + path + "': VTK could not encode the field");
    writeBytes (temporary, writer->GetOutputString ());
  });
}

} // namespace pcl::cosection
