// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/io/mesh_io.h>

#include "mesh_decoders.h"
#include "pcl_cosection/common/ear_clipping.h"
#include "pcl_cosection/common/files.h"
#include "pcl_cosection/common/round_origin.h"
#include "pcl_cosection/io/lower_case.h"
#include "pcl_cosection/io/text_scanner.h"
#include "pcl_cosection/mesh/mesh_cleaning.h"
#include "pcl_cosection/mesh/mesh_parts.h"

#include <pcl/cosection/common/error.h>

#include <Eigen/Geometry>

#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

using Decoder = PolygonSoup (*) (const std::string& bytes);

/** \brief The decoder of the format that a file begins as. \return nullptr if its beginning does not show the format */
Decoder
decoderForContents (const std::string& bytes)
{
  constexpr std::size_t longest = 512;
  TextScanner scanner (std::string_view (bytes).substr (0, longest));
  const std::string_view line = scanner.line ();
  const std::string_view word = TextScanner (line).word ();
  if (word == "ply")
    return decodePlyPolygons;
  if (line.rfind ("# vtk DataFile", 0) == 0)
    return decodeVtk;
  if (word == "<?xml" || word.rfind ("<VTKFile", 0) == 0)
    return decodeVtp;
  if (word == "OFF")
    return decodeOff;
  return nullptr;
}

Decoder
decoderForExtension (const std::string& extension)
{
  static constexpr std::pair<const char*, Decoder> formats[] = {{".ply", decodePlyPolygons}, {".stl", decodeStl},
                                                                {".obj", decodeObj},         {".off", decodeOff},
                                                                {".vtk", decodeVtk},         {".vtp", decodeVtp}};
  for (const auto& [known, decode] : formats)
    if (extension == known)
      return decode;
  return nullptr;
}

PolygonSoup
decode (const std::string& bytes, const std::string& extension)
{
  if (bytes.empty ())
    throw IoError ("it is empty");
  // A binary STL file may begin with anything: only its name shows the format.
  if (const Decoder decoder = (extension == ".stl" ? nullptr : decoderForContents (bytes)))
    return decoder (bytes);
  if (const Decoder decoder = decoderForExtension (extension))
    return decoder (bytes);
  throw IoError ("unknown format; known are .ply, .stl, .obj, .off, .vtk and .vtp");
}

void
check (const PolygonSoup& soup)
{
  if (soup.points.size () > std::numeric_limits<std::uint32_t>::max () ||
      soup.ends.size () > std::numeric_limits<std::uint32_t>::max ())
    throw IoError ("it has more vertices or faces than a 32-bit index can count");
  const auto count = static_cast<std::int64_t> (soup.points.size ());
  for (const std::int64_t corner : soup.corners)
  {
    if (corner < 0 || corner >= count)
      throw IoError ("a face refers to a vertex that does not exist");
    if (!soup.points[static_cast<std::size_t> (corner)].cast<float> ().allFinite ())
      throw IoError ("vertex " + std::to_string (corner) + " (from 0) is not finite");
  }
}

/** \brief A polygon seen from where its corners are counter-clockwise. */
std::vector<Eigen::Vector2d>
flatten (const std::vector<Eigen::Vector3d>& polygon)
{
  Eigen::Vector3d normal = Eigen::Vector3d::Zero (); // twice its area (M. E. Newell's method)
  for (std::size_t n = 2; n < polygon.size (); ++n)
    normal += (polygon[n - 1] - polygon[0]).cross (polygon[n] - polygon[0]);
  const Eigen::Matrix3d across = Eigen::Quaterniond::FromTwoVectors (normal, Eigen::Vector3d::UnitZ ()).matrix ();
  std::vector<Eigen::Vector2d> flat;
  flat.reserve (polygon.size ());
  for (const Eigen::Vector3d& p : polygon)
    flat.emplace_back ((across * (p - polygon[0])).head<2> ());
  return flat;
}

/** \brief Append the triangles of the polygon, maybe concave, with the corners [begin, end) of \a soup. */
void
addTriangles (const PolygonSoup& soup, std::size_t begin, std::size_t end, TriangleMesh& mesh)
{
  const std::size_t size = end - begin;
  const auto corner = [&] (std::size_t n) { return static_cast<std::uint32_t> (soup.corners[begin + n]); };
  if (size == 3)
    mesh.triangles.push_back ({corner (0), corner (1), corner (2)});
  if (size <= 3)
    return;
  std::vector<Eigen::Vector3d> polygon;
  polygon.reserve (size);
  for (std::size_t n = 0; n < size; ++n)
    polygon.push_back (soup.points[corner (n)]);
  const auto ears = clipEars (flatten (polygon));
  for (const auto& [a, b, c] : ears)
    mesh.triangles.push_back ({corner (a), corner (b), corner (c)});
  if (ears.empty ()) // it crosses itself or has no area
    for (std::size_t n = 2; n < size; ++n)
      mesh.triangles.push_back ({corner (0), corner (n - 1), corner (n)});
}

/** \brief The triangles of a soup: polygons are triangulated, what its vertices imply is made so
 * (cleanMesh ()), and triangles are turned to agree and face outward (orientTriangles ()).
 * \throws IoError, whose message is only the reason */
TriangleMesh
makeMesh (const PolygonSoup& soup, const Eigen::Vector3d& origin)
{
  check (soup);
  TriangleMesh mesh;
  mesh.vertices.reserve (soup.points.size ());
  for (const Eigen::Vector3d& point : soup.points)
    mesh.vertices.push_back ((point - origin).cast<float> ());
  mesh.triangles.reserve (soup.ends.size ());
  for (std::size_t n = 0; n < soup.ends.size (); ++n)
    addTriangles (soup, n == 0 ? 0 : soup.ends[n - 1], soup.ends[n], mesh);
  if (mesh.empty ())
    throw IoError ("it has no triangles");
  mesh = cleanMesh (mesh);
  if (mesh.empty ())
    throw IoError ("all its triangles are without area");
  orientTriangles (mesh);
  return mesh;
}

/** \brief Calls decode (bytes) with the bytes of a file, and names the file in its errors. */
template <typename Decode>
auto
load (const std::string& path, Decode&& decode)
{
  const std::string bytes = readBytes (path);
  try
  {
    return decode (bytes);
  }
  catch (const IoError& error)
  {
    throw IoError ("cannot read '" + path + "': " + error.what ());
  }
}

} // namespace

TriangleMesh
loadMesh (const std::string& path, const Eigen::Vector3d& origin)
{
  return load (path,
               [&] (const std::string& bytes) { return makeMesh (decode (bytes, lowerCaseExtension (path)), origin); });
}

Eigen::Vector3d
localOrigin (const std::string& path)
{
  const PolygonSoup soup = load (path,
                                 [&] (const std::string& bytes) { return decode (bytes, lowerCaseExtension (path)); });
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : soup.points)
    if (point.allFinite ())
      box.extend (point);
  if (box.isEmpty () || !(box.sizes ().maxCoeff () > 0.0))
    return Eigen::Vector3d::Zero ();
  const double longest = box.sizes ().maxCoeff ();
  const double spacing = longest / std::sqrt (static_cast<double> (soup.points.size ()));
  return needsLocalOrigin (box.center (), longest, spacing) ? roundOrigin (box.center (), longest)
                                                            : Eigen::Vector3d::Zero ();
}

TriangleMesh
loadPlyMesh (const std::string& path, const Eigen::Vector3d& origin)
{
  return load (path, [&] (const std::string& bytes) { return decodePly (bytes, origin); });
}

} // namespace pcl::cosection
