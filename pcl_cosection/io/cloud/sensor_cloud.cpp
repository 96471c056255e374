// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// PCD files are read by hand, because pcl::PCDReader takes as much memory as a header claims and prints what is wrong
// with a file instead of throwing it.

#include "sensor_cloud.h"

#include "cloud_columns.h"
#include "label_field.h"
#include "local_origin.h"
#include "pcl_cosection/common/byte_text.h"

#include <pcl/cosection/common/error.h>

#include <pcl/PCLPointCloud2.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace pcl::cosection {
namespace {

const CloudField&
requireNumber (const std::string& path, const CloudHeader& header, const std::string& name)
{
  const CloudField* field = header.findAlike ({name});
  if (!field)
    throw IoError (path + ": has no field " + name + "; fields x, y and z are needed");
  if (field->count != 1)
    throw IoError (path + ": field " + name + " must be one number (COUNT 1)");
  return (*field);
}

using Columns = std::array<CloudColumn, 3>;
using Fields = std::array<const CloudField*, 3>;

Columns
columnsOf (const std::string& path, const PCLPointCloud2& cloud, const Fields& fields)
{
  return {CloudColumn (path, cloud, *fields[0]), CloudColumn (path, cloud, *fields[1]),
          CloudColumn (path, cloud, *fields[2])};
}

/** \brief Three columns as vectors. */
std::vector<Eigen::Vector3f>
readVectors (const Columns& columns, std::size_t points, const Eigen::Affine3d& transform)
{
  std::vector<Eigen::Vector3f> vectors (points);
  for (std::size_t i = 0; i < points; ++i)
  {
    const Eigen::Vector3d v (columns[0].number (i), columns[1].number (i), columns[2].number (i));
    vectors[i] = (transform * v).cast<float> ();
    if (v.isZero (0.0) || !std::isfinite (vectors[i].squaredNorm ())) // some sensors write a missing reading as zero
      vectors[i].setConstant (nan_value);
  }
  return (vectors);
}

/** \brief The fields of the normals, if there are any. */
std::optional<Fields>
normalFields (const CloudHeader& header)
{
  const Fields fields = {header.findAlike ({"normal_x", "nx"}), header.findAlike ({"normal_y", "ny"}),
                         header.findAlike ({"normal_z", "nz"})};
  if (!std::all_of (fields.begin (), fields.end (), [] (const CloudField* f) { return f && f->count == 1; }))
    return std::nullopt;
  return fields;
}

/** \brief The pose of the sensor as the file and the user tell it. */
void
setPose (const CloudHeader& header, const PcdViewOptions& options, SensorCloud& cloud)
{
  const auto& v = header.viewpoint;
  cloud.T_world_sensor.linear () = Eigen::Quaterniond (v[3], v[4], v[5], v[6]).normalized ().toRotationMatrix ();
  cloud.T_world_sensor.translation () = options.scale * Eigen::Vector3d (v[0], v[1], v[2]);
  if (options.viewpoint)
    cloud.T_world_sensor = Eigen::Translation3d (Eigen::Map<const Eigen::Vector3d> (options.viewpoint->data ()));
  cloud.has_viewpoint = options.viewpoint || !cloud.T_world_sensor.translation ().isZero (0.0) ||
                        !cloud.T_world_sensor.linear ().isIdentity (0.0);
  cloud.in_world = options.world_points || options.viewpoint;
  if (options.axes == SensorAxes::OpenGl)
    cloud.T_points_sensor = Eigen::AngleAxisd (M_PI, Eigen::Vector3d::UnitX ());
  cloud.T_world_sensor = cloud.T_world_sensor * cloud.T_points_sensor;
}

/** \brief Whether colours of type F are the numbers 0xRRGGBB, as some programs write them, instead of floats with these
 * bits: those are below 1 or, with an alpha of 255, beyond them all. */
bool
areWholeColours (const CloudColumn& column, std::size_t points)
{
  bool any = false;
  for (std::size_t i = 0; i < points; ++i)
  {
    const double value = column.number (i);
    if (!(value >= 0.0 && value <= 0xffffff && value == std::floor (value)))
      return (false);
    any |= value > 0.0;
  }
  return (any);
}

} // namespace

void
checkMemory (const std::string& path, const CloudHeader& header, std::size_t limit_bytes)
{
  const std::size_t per_point = 2 * header.pointBytes () + 2 * sizeof (Eigen::Vector3f) + sizeof (std::uint32_t) +
                                sizeof (OrientedPoint);
  if (limit_bytes == 0 || header.points <= limit_bytes / per_point)
    return;
  const double needed = std::min (static_cast<double> (header.points) * static_cast<double> (per_point), 1e18);
  throw MemoryLimitExceeded (path + ": its " + std::to_string (header.points) + " points need " +
                             byteText (static_cast<std::size_t> (needed)) + "; " + byteText (limit_bytes) +
                             " are left of what is allowed: thin the cloud (pcl_voxel_grid) or allow more memory");
}

SensorCloud
readSensorCloud (const std::string& path, const PcdViewOptions& options, bool with_labels)
{
  CloudHeader header = readCloudHeader (path);
  for (const char* name : {"x", "y", "z"})
    requireNumber (path, header, name);
  checkMemory (path, header, options.max_memory_bytes);
  const PCLPointCloud2 cloud = readCloudPoints (path, header);
  return (toSensorCloud (path, header, cloud, options, with_labels));
}

SensorCloud
toSensorCloud (const std::string& path, const CloudHeader& header, const PCLPointCloud2& cloud,
               const PcdViewOptions& options, bool with_labels)
{
  const Fields position_fields = {&requireNumber (path, header, "x"), &requireNumber (path, header, "y"),
                                  &requireNumber (path, header, "z")};

  SensorCloud result;
  result.width = static_cast<int> (header.width);
  result.height = static_cast<int> (header.height);
  setPose (header, options, result);
  const Columns columns = columnsOf (path, cloud, position_fields);
  const Eigen::Affine3d T_sensor_points = takeToLocalOrigin (path, position_fields, columns, options, result);
  result.positions = readVectors (columns, header.points, T_sensor_points);
  if (const auto fields = normalFields (header))
    result.normals = readVectors (
        columnsOf (path, cloud, *fields), header.points,
        Eigen::Affine3d (Eigen::Affine3d::MatrixType (Eigen::Isometry3d (T_sensor_points.rotation ()).matrix ())));
  for (Eigen::Vector3f& normal : result.normals) // of any length, as of a program that scaled them with the points
    normal.stableNormalize ();
  result.labels.assign (header.points, 1);
  if (with_labels)
    readLabels (path, header, cloud, options, result);
  if (header.has_more)
    result.warnings.push_back (path + ": holds more points than the " + std::to_string (header.points) +
                               " that its header announces; these alone are read");
  if (header.has_faces)
    result.warnings.push_back (path + ": its vertices are taken as points, its faces are not used");
  const CloudField* colour = header.find ("rgb") ? header.find ("rgb") : header.find ("rgba");
  if (colour && colour->size == 4 && colour->count == 1)
  {
    const CloudColumn column (path, cloud, *colour);
    const bool are_numbers = colour->type == 'F' && areWholeColours (column, header.points);
    result.colours.resize (header.points);
    for (std::size_t i = 0; i < result.colours.size (); ++i)
    {
      // 0xAARRGGBB, whether the field is declared F or U
      const std::uint32_t bits = are_numbers ? static_cast<std::uint32_t> (column.number (i)) : column.bits (i);
      result.colours[i] = {static_cast<std::uint8_t> (bits >> 16), static_cast<std::uint8_t> (bits >> 8),
                           static_cast<std::uint8_t> (bits)};
    }
  }
  const CloudField* intensity = header.find ("intensity");
  if (intensity && intensity->count == 1)
  {
    const CloudColumn column (path, cloud, *intensity);
    result.intensities.resize (header.points);
    for (std::size_t i = 0; i < result.intensities.size (); ++i)
    {
      const double value = column.number (i);
      result.intensities[i] = std::isfinite (static_cast<float> (value)) ? static_cast<float> (value) : nan_value;
    }
  }
  return (result);
}

} // namespace pcl::cosection
