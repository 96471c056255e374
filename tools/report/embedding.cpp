// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "embedding.h"

#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/mesh_decimation.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

using namespace pcl::cosection;

namespace {

constexpr int quality = 82;       ///< of 100: differences cannot be seen
constexpr double steps = 65535.0; ///< along each side of the box

template <typename Pixel>
std::string
encoded (const Image<Pixel>& picture, int type, int conversion)
{
  cv::Mat image;
  cv::cvtColor (cv::Mat (picture.height, picture.width, type, const_cast<Pixel*> (picture.pixels.data ())), image,
                conversion);
  std::vector<unsigned char> bytes;
  if (!cv::imencode (".webp", image, bytes, {cv::IMWRITE_WEBP_QUALITY, quality}))
    throw IoError ("a picture cannot be encoded as WebP: this OpenCV was built without it");
  return ("data:image/webp;base64," + toBase64 (bytes.data (), bytes.size ()));
}

/** \brief Append a whole number, lowest byte first. */
void
append (std::uint32_t value, int bytes, std::string& to)
{
  for (int n = 0; n < bytes; ++n)
    to += static_cast<char> (value >> (8 * n));
}

std::string
lettersOf (const std::string& bytes)
{
  return (toBase64 (bytes.data (), bytes.size ()));
}

void
check (const TriangleMesh& mesh, const std::vector<double>& errors_m)
{
  const std::size_t vertices = mesh.vertices.size ();
  for (const std::size_t size :
       {mesh.colours.size (), mesh.provenance.size (), mesh.confidence.size (), errors_m.size ()})
    if (size != 0 && size != vertices)
      throw std::invalid_argument ("a mesh to embed must have one value per vertex, or none");
  for (const TriangleMesh::Triangle& triangle : mesh.triangles)
    if (*std::max_element (triangle.begin (), triangle.end ()) >= vertices)
      throw std::invalid_argument ("a mesh to embed has a triangle of a vertex that is not there");
}

/** \brief Shares in [0, 1] as bytes; what is no number is 1. */
template <typename Value>
std::string
asBytes (const std::vector<Value>& values, double one)
{
  std::string bytes;
  for (const Value value : values)
  {
    const double share = static_cast<double> (value) / one;
    append (
        static_cast<std::uint32_t> (std::lround (255.0 * (std::isfinite (share) ? std::clamp (share, 0.0, 1.0) : 1.0))),
        1, bytes);
  }
  return (lettersOf (bytes));
}

} // namespace

std::string
toBase64 (const void* bytes, std::size_t size)
{
  static const char* const letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* in = static_cast<const std::uint8_t*> (bytes);
  std::string text;
  text.reserve ((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3)
  {
    const std::size_t left = size - i;
    const std::uint32_t group = (static_cast<std::uint32_t> (in[i]) << 16) |
                                (left > 1 ? static_cast<std::uint32_t> (in[i + 1]) << 8 : 0) |
                                (left > 2 ? in[i + 2] : 0);
    text += letters[group >> 18];
    text += letters[(group >> 12) & 63];
    text += left > 1 ? letters[(group >> 6) & 63] : '=';
    text += left > 2 ? letters[group & 63] : '=';
  }
  return (text);
}

std::string
dataUri (const TransparentPicture& picture)
{
  return (encoded (picture, CV_8UC4, cv::COLOR_RGBA2BGRA));
}

std::string
dataUri (const Picture& picture)
{
  return (encoded (picture, CV_8UC3, cv::COLOR_RGB2BGR));
}

TriangleMesh
forDisplay (const TriangleMesh& mesh, std::size_t most_triangles)
{
  if (mesh.triangles.size () <= most_triangles)
    return (mesh);
  try
  {
    return (decimate (mesh, most_triangles));
  }
  catch (const InvalidArgument&) // not a manifold: written by something else
  {
    return (mesh);
  }
}

Json
embedMesh (const TriangleMesh& mesh, const std::vector<double>& errors_m, double error_max_m)
{
  check (mesh, errors_m);
  Eigen::AlignedBox3d box = vertexBox (mesh);
  if (box.isEmpty ())
    box.extend (Eigen::Vector3d::Zero ());
  const Eigen::Vector3d size = box.sizes ().cwiseMax (std::numeric_limits<float>::min ());
  std::string positions, indices;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    for (int axis = 0; axis < 3; ++axis)
      append (static_cast<std::uint32_t> (std::lround (steps * (vertex[axis] - box.min ()[axis]) / size[axis])), 2,
              positions);
  const int index_bytes = mesh.vertices.size () <= 65536 ? 2 : 4;
  for (const TriangleMesh::Triangle& triangle : mesh.triangles)
    for (const std::uint32_t index : triangle)
      append (index, index_bytes, indices);

  Json json;
  json["vertices"] = mesh.vertices.size ();
  json["triangles"] = mesh.triangles.size ();
  json["min"] = {box.min ().x (), box.min ().y (), box.min ().z ()};
  json["size"] = {size.x (), size.y (), size.z ()};
  json["positions"] = lettersOf (positions);
  json["index_bytes"] = index_bytes;
  json["indices"] = lettersOf (indices);
  if (!mesh.colours.empty ())
    json["colours"] = toBase64 (mesh.colours.data (), 3 * mesh.colours.size ());
  if (!mesh.provenance.empty ())
    json["provenance"] = toBase64 (mesh.provenance.data (), mesh.provenance.size ());
  if (!mesh.confidence.empty ())
    json["confidence"] = asBytes (mesh.confidence, 1.0);
  if (!errors_m.empty ())
    json["error"] = asBytes (errors_m, error_max_m);
  return (json);
}
