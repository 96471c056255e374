// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// PCD files are read by hand, because pcl::PCDReader takes as much memory as a header claims and prints what is wrong
// with a file instead of throwing it.

#include "pcd_cloud.h"

#include "pcd_file.h"
#include "pcl_cosection/common/byte_text.h"
#include "pcl_cosection/io/lower_case.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/image.h>

#include <pcl/PCLPointCloud2.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <sstream>

namespace pcl::cosection {
namespace {

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN ();

/** \brief One field of a loaded cloud, any numeric type. */
class Column
{
public:
  Column (const std::string& path, const PCLPointCloud2& cloud, const PcdField& field)
      : data_ (cloud.data.data ())
      , step_ (cloud.point_step)
      , type_ (field.type)
      , size_ (field.size)
  {
    for (const PCLPointField& f : cloud.fields)
      if (f.name == field.name)
      {
        offset_ = f.offset;
        if (offset_ + size_ <= step_)
          return;
      }
    throw IoError (path + ": field " + field.name + " cannot be read");
  }

  double real (std::size_t i) const { return (size_ == 4 ? static_cast<double> (load<float> (i)) : load<double> (i)); }

  std::int64_t integer (std::size_t i) const
  {
    switch (size_)
    {
    case 1:
      return (type_ == 'I' ? load<std::int8_t> (i) : load<std::uint8_t> (i));
    case 2:
      return (type_ == 'I' ? load<std::int16_t> (i) : load<std::uint16_t> (i));
    case 4:
      return (type_ == 'I' ? load<std::int32_t> (i) : static_cast<std::int64_t> (load<std::uint32_t> (i)));
    default:
      return (load<std::int64_t> (i));
    }
  }

  double number (std::size_t i) const { return type_ == 'F' ? real (i) : static_cast<double> (integer (i)); }

  std::uint32_t bits (std::size_t i) const { return (load<std::uint32_t> (i)); }

private:
  template <typename T> T load (std::size_t i) const
  {
    T value;
    std::memcpy (&value, data_ + i * step_ + offset_, sizeof (T));
    return (value);
  }

  const std::uint8_t* data_;
  std::size_t step_;
  std::size_t offset_ = 0;
  char type_;
  std::size_t size_;
};

const PcdField&
requireNumber (const std::string& path, const PcdHeader& header, const std::string& name)
{
  const PcdField* field = header.find (name);
  if (!field)
    throw IoError (path + ": has no field " + name + "; fields x, y and z are needed");
  if (field->count != 1)
    throw IoError (path + ": field " + name + " must be one number (COUNT 1)");
  return (*field);
}

/** \brief Three fields as vectors. */
std::vector<Eigen::Vector3f>
readVectors (const std::string& path, const PcdHeader& header, const PCLPointCloud2& cloud,
             const std::array<std::string, 3>& names, const Eigen::Affine3d& transform)
{
  const std::array<Column, 3> columns = {Column (path, cloud, requireNumber (path, header, names[0])),
                                         Column (path, cloud, requireNumber (path, header, names[1])),
                                         Column (path, cloud, requireNumber (path, header, names[2]))};
  std::vector<Eigen::Vector3f> vectors (header.points);
  for (std::size_t i = 0; i < vectors.size (); ++i)
  {
    const Eigen::Vector3d v (columns[0].number (i), columns[1].number (i), columns[2].number (i));
    vectors[i] = (transform * v).cast<float> ();
    if (v.isZero (0.0) || !std::isfinite (vectors[i].squaredNorm ())) // some sensors write a missing reading as zero
      vectors[i].setConstant (nan_value);
  }
  return (vectors);
}

/** \brief A file: its points as it has them, and as they are returned. */
void
checkMemory (const std::string& path, const PcdHeader& header, std::size_t limit_bytes)
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

constexpr std::size_t most_labels = 256; // that are looked for in fields of other names

/** \brief How many different whole numbers a field holds, at most most_labels + 1; 0 if there are other numbers. NaN is
 * none. */
std::size_t
wholeNumbers (const std::string& path, const PcdHeader& header, const PCLPointCloud2& cloud, const PcdField& field)
{
  if (field.isPadding () || field.count != 1)
    return 0;
  const Column column (path, cloud, field);
  std::set<double> values;
  for (std::size_t i = 0; i < header.points; ++i)
    if (const double value = column.number (i); std::isnan (value))
      continue;
    else if (value != std::trunc (value))
      return 0;
    else if (values.size () <= most_labels)
      values.insert (value);
  return values.size ();
}

/** \brief The field with the labels: the one that is wanted, or label, or one of the names that other programs give it;
 * nullptr if there is none. \throws IoError if the wanted one is missing */
const PcdField*
labelField (const std::string& path, const PcdHeader& header, const PCLPointCloud2& cloud, const std::string& wanted)
{
  const PcdField* named = header.find (wanted.empty () ? "label" : wanted);
  if (named)
    return named;
  if (!wanted.empty ())
  {
    std::string names;
    for (const PcdField& field : header.fields)
      names += " " + printable (field.name);
    throw IoError (path + ": has no field " + printable (wanted) + "; its fields are" + names);
  }
  for (const PcdField& field : header.fields)
  {
    std::string name = lowerCase (field.name);
    if (constexpr std::string_view prefix = "scalar_"; name.compare (0, prefix.size (), prefix) == 0)
      name.erase (0, prefix.size ());
    if ((name == "label" || name == "labels" || name == "class" || name == "classification") &&
        wholeNumbers (path, header, cloud, field) > 0)
      return &field;
  }
  return nullptr;
}

/** \brief Names of fields that hold a few whole numbers, as labels do, with a space before each. */
std::string
fieldsLikeLabels (const std::string& path, const PcdHeader& header, const PCLPointCloud2& cloud)
{
  const std::set<std::string> others = {"x",         "y",   "z",    "normal_x",  "normal_y", "normal_z",
                                        "curvature", "rgb", "rgba", "intensity", "ring"};
  std::string names;
  for (const PcdField& field : header.fields)
    if (others.count (field.name) == 0)
      if (const std::size_t count = wholeNumbers (path, header, cloud, field); count > 1 && count <= most_labels)
        names += " " + printable (field.name);
  return names;
}

void
readLabels (const std::string& path, const PCLPointCloud2& cloud, const PcdField& field, SensorCloud& result)
{
  if (field.count != 1)
    throw IoError (path + ": field " + printable (field.name) + " must be one integer (COUNT 1)");
  const Column column (path, cloud, field);
  const auto labelOf = [&] (std::size_t i) -> std::int64_t {
    if (field.type != 'F')
      return column.integer (i);
    const double label = column.real (i); // as some programs write all fields
    if (std::isnan (label))
      return -1;
    if (label != std::trunc (label))
    {
      std::ostringstream message;
      message << path << ": point " << i << " has label " << label << ", which is not an integer";
      throw IoError (message.str ());
    }
    constexpr double large = 1e15;
    return static_cast<std::int64_t> (std::clamp (label, -large, large));
  };
  for (std::size_t i = 0; i < result.labels.size (); ++i)
  {
    const std::int64_t label = labelOf (i);
    if (label > std::numeric_limits<std::int32_t>::max ())
      throw IoError (path + ": label " + std::to_string (label) + " is too large, the largest is 2147483647");
    if (label >= 0 && label != ignored_label)
      result.labels[i] = static_cast<std::uint32_t> (label);
    else if (result.positions[i].allFinite ())
    {
      result.positions[i].setConstant (nan_value);
      ++result.ignored;
    }
  }
}

} // namespace

SensorCloud
readSensorCloud (const std::string& path, const PcdViewOptions& options, bool with_labels)
{
  const PcdHeader header = readPcdHeader (path);
  for (const char* name : {"x", "y", "z"})
    requireNumber (path, header, name);
  checkMemory (path, header, options.max_memory_bytes);
  const PCLPointCloud2 cloud = readPcdPoints (path, header);

  SensorCloud result;
  result.width = static_cast<int> (header.width);
  result.height = static_cast<int> (header.height);
  const auto& v = header.viewpoint;
  result.T_world_sensor.linear () = Eigen::Quaterniond (v[3], v[4], v[5], v[6]).normalized ().toRotationMatrix ();
  result.T_world_sensor.translation () = options.scale * Eigen::Vector3d (v[0], v[1], v[2]);
  if (options.viewpoint)
    result.T_world_sensor = Eigen::Translation3d (Eigen::Map<const Eigen::Vector3d> (options.viewpoint->data ()));
  result.has_viewpoint = options.viewpoint || !result.T_world_sensor.translation ().isZero (0.0) ||
                         !result.T_world_sensor.linear ().isIdentity (0.0);
  const Eigen::Isometry3d T_sensor_points = options.world_points || options.viewpoint ? result.T_world_sensor.inverse ()
                                                                                      : Eigen::Isometry3d::Identity ();

  result.positions = readVectors (path, header, cloud, {"x", "y", "z"},
                                  Eigen::Affine3d (T_sensor_points) * Eigen::Scaling (options.scale));
  if (header.find ("normal_x") && header.find ("normal_y") && header.find ("normal_z"))
    result.normals = readVectors (
        path, header, cloud, {"normal_x", "normal_y", "normal_z"},
        Eigen::Affine3d (Eigen::Affine3d::MatrixType (Eigen::Isometry3d (T_sensor_points.rotation ()).matrix ())));
  for (Eigen::Vector3f& normal : result.normals) // of any length, as of a program that scaled them with the points
    normal.stableNormalize ();
  result.labels.assign (header.points, 1);
  if (const PcdField* label = with_labels ? labelField (path, header, cloud, options.label_field) : nullptr)
  {
    result.has_labels = true;
    if (options.label_field.empty () && label->name != "label")
      result.warnings.push_back (path + ": has no field label; " + printable (label->name) + " is taken for it");
    readLabels (path, cloud, *label, result);
  }
  else if (const std::string names = with_labels ? fieldsLikeLabels (path, header, cloud) : ""; !names.empty ())
    result.warnings.push_back (path + ": has no field label; if labels are in" + names + ", give --label-field NAME");
  const PcdField* colour = header.find ("rgb") ? header.find ("rgb") : header.find ("rgba");
  if (colour && colour->size == 4 && colour->count == 1)
  {
    const Column column (path, cloud, *colour);
    result.colours.resize (header.points);
    for (std::size_t i = 0; i < result.colours.size (); ++i)
    {
      const std::uint32_t bits = column.bits (i); // 0xAARRGGBB, whether the field is declared F or U
      result.colours[i] = {static_cast<std::uint8_t> (bits >> 16), static_cast<std::uint8_t> (bits >> 8),
                           static_cast<std::uint8_t> (bits)};
    }
  }
  const PcdField* intensity = header.find ("intensity");
  if (intensity && intensity->count == 1)
  {
    const Column column (path, cloud, *intensity);
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
