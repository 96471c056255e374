// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// PLY files as point clouds: their vertices, and the camera that pcl::PLYWriter puts behind them.

#include "cloud_decoders.h"
#include "pcl_cosection/common/files.h"
#include "pcl_cosection/io/mesh/ply_header.h"

#include <pcl/cosection/common/error.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace pcl::cosection {
namespace {

constexpr std::uint64_t max_points = 0x7fffffff;
constexpr double max_viewpoint = 1e15; // as of a PCD header

/** \brief Names that PCL gives to properties of a PLY file. */
std::string
fieldName (const std::string& property)
{
  static const std::map<std::string, std::string> names = {{"nx", "normal_x"}, {"ny", "normal_y"}, {"nz", "normal_z"}};
  const auto found = names.find (property);
  return found == names.end () ? property : found->second;
}

CloudField
fieldOf (const PlyProperty& property)
{
  const bool real = property.type == ScalarType::Float32 || property.type == ScalarType::Float64;
  const bool with_sign = property.type == ScalarType::Int8 || property.type == ScalarType::Int16 ||
                         property.type == ScalarType::Int32;
  return {fieldName (property.name), sizeOf (property.type), real ? 'F' : with_sign ? 'I' : 'U', 1};
}

bool
isVertices (const PlyElement& element)
{
  return element.name == "vertex";
}

/** \brief Call \a decode with a scanner, and name the file in its errors. */
template <typename Decode>
auto
scan (const std::string& path, std::string_view text, Decode&& decode)
{
  try
  {
    TextScanner scanner (text);
    return decode (scanner);
  }
  catch (const IoError& error)
  {
    throw IoError (path + ": " + error.what ());
  }
}

PCLPointCloud2
readVertices (const PlyElement& element, const CloudHeader& header, PlyElementReader& reader)
{
  PCLPointCloud2 cloud = emptyCloud (header, CloudPadding::Included);
  struct Target
  {
    StoreNumber store;
    std::size_t offset;
  };
  std::vector<std::optional<Target>> targets;
  std::size_t field = 0;
  for (const PlyProperty& property : element.properties)
    if (property.count_type)
      targets.emplace_back ();
    else
    {
      targets.push_back (Target{storeFor (header.fields[field]), cloud.fields[field].offset});
      ++field;
    }
  reader.read (element, [&] (std::uint64_t row, std::size_t n, double value) {
    if (!targets[n]->store (value, &cloud.data[row * cloud.point_step + targets[n]->offset]))
      throw IoError ("vertex " + std::to_string (row) + " has a value that property " +
                     quoted (element.properties[n].name) + " cannot hold");
  });
  return cloud;
}

/** \brief Take the pose of the sensor and the size of the image from the camera. */
void
useCamera (std::map<std::string, double>& camera, CloudHeader& header)
{
  Eigen::Matrix3d rotation;
  const std::string axes = "xyz";
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      rotation (row, column) = camera[std::string () + axes[row] + "_axis" + axes[column]];
  const Eigen::Vector3d place (camera["view_px"], camera["view_py"], camera["view_pz"]);
  if (place.allFinite () && place.cwiseAbs ().maxCoeff () <= max_viewpoint && rotation.isUnitary (1e-3) &&
      rotation.determinant () > 0.0)
  {
    const Eigen::Quaterniond q (rotation);
    header.viewpoint = {place.x (), place.y (), place.z (), q.w (), q.x (), q.y (), q.z ()};
  }
  const double width = camera["viewportx"];
  const double height = camera["viewporty"];
  if (width >= 1.0 && height >= 1.0 && width == std::floor (width) && height == std::floor (height) &&
      width * height == static_cast<double> (header.points))
  {
    header.width = static_cast<std::uint64_t> (width);
    header.height = static_cast<std::uint64_t> (height);
  }
}

} // namespace

CloudHeader
parsePlyCloudHeader (const std::string& path, std::string_view text, std::uint64_t size)
{
  return scan (path, text, [&] (TextScanner& scanner) {
    const PlyHeader ply = parsePlyHeader (scanner);
    const auto vertices = std::find_if (ply.elements.begin (), ply.elements.end (), isVertices);
    if (vertices == ply.elements.end ())
      throw IoError ("the PLY file has no vertices");
    CloudHeader header;
    for (const PlyProperty& property : vertices->properties)
      if (!property.count_type)
        header.fields.push_back (fieldOf (property));
    if (vertices->count == 0)
      throw DegenerateInput (path + ": holds no points");
    const std::uint64_t left = size - (text.size () - scanner.left ().size ()) + 1; // text may lack the last space
    if (vertices->count > max_points || header.fields.empty () || vertices->leastSize (ply.encoding) > left)
      throw IoError ("the PLY file is shorter than its header says");
    header.points = header.width = vertices->count;
    header.height = 1;
    header.encoding = CloudEncoding::Ply;
    header.has_faces = std::any_of (ply.elements.begin (), ply.elements.end (), [] (const PlyElement& element) {
      return (element.name == "face" || element.name == "tristrips") && element.count > 0;
    });
    return header;
  });
}

PCLPointCloud2
readPlyPoints (const std::string& path, CloudHeader& header)
{
  const std::string bytes = readBytes (path);
  return scan (path, bytes, [&] (TextScanner& scanner) {
    const PlyHeader ply = parsePlyHeader (scanner);
    const auto isCamera = [] (const PlyElement& element) { return element.name == "camera" && element.count == 1; };
    auto last = std::find_if (ply.elements.begin (), ply.elements.end (), isVertices);
    if (last == ply.elements.end () || last->count != header.points)
      throw IoError ("the file changed while it was read");
    if (const auto camera = std::find_if (last, ply.elements.end (), isCamera); camera != ply.elements.end ())
      last = camera;
    PlyElementReader reader (scanner, ply.encoding);
    std::optional<PCLPointCloud2> cloud;
    std::map<std::string, double> camera;
    for (auto element = ply.elements.begin (); element <= last; ++element)
      if (isVertices (*element) && !cloud)
        cloud = readVertices (*element, header, reader);
      else
        reader.read (*element, [&] (std::uint64_t, std::size_t n, double value) {
          if (isCamera (*element))
            camera[element->properties[n].name] = value;
        });
    if (!camera.empty ())
      useCamera (camera, header);
    return std::move (*cloud);
  });
}

} // namespace pcl::cosection
