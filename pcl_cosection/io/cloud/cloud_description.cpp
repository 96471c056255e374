// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "cloud_file.h"

#include <pcl/cosection/common/error.h>

#include <pcl/common/io.h>

#include <optional>

namespace pcl::cosection {
namespace {

/** \brief Type and bytes of an element; nothing for what a file cannot have. */
std::optional<CloudField>
elementOf (const PCLPointField& field)
{
  const char type = pcl::getFieldType (static_cast<int> (field.datatype));
  if (type != 'I' && type != 'U' && type != 'F')
    return std::nullopt;
  return CloudField{field.name, static_cast<std::size_t> (pcl::getFieldSize (field.datatype)), type, field.count};
}

} // namespace

CloudHeader
describeCloud (const std::string& name, const PCLPointCloud2& cloud, const Eigen::Isometry3d& T_world_sensor)
{
  CloudHeader header;
  for (const PCLPointField& field : cloud.fields)
  {
    const std::optional<CloudField> element = elementOf (field);
    if (!element)
      throw InvalidArgument (name + ": field " + field.name + " has no type that PCL knows");
    if (field.offset + element->size * element->count > cloud.point_step)
      throw InvalidArgument (name + ": field " + field.name + " lies outside the point");
    header.fields.push_back (*element);
  }
  header.width = cloud.width;
  header.height = cloud.height;
  header.points = header.width * header.height;
  header.encoding = CloudEncoding::Binary;
  if (header.points == 0)
    throw DegenerateInput (name + ": holds no points");
  if (cloud.point_step == 0 || header.points > cloud.data.size () / cloud.point_step ||
      cloud.data.size () != header.points * cloud.point_step)
    throw InvalidArgument (name + ": has " + std::to_string (cloud.data.size ()) + " bytes, not " +
                           std::to_string (cloud.point_step) + " for each of " + std::to_string (header.points) +
                           " points");
  if (!T_world_sensor.matrix ().allFinite ())
    throw InvalidArgument (name + ": the pose of the sensor must be finite");
  const Eigen::Vector3d place = T_world_sensor.translation ();
  const Eigen::Quaterniond axes (T_world_sensor.linear ());
  header.viewpoint = {place.x (), place.y (), place.z (), axes.w (), axes.x (), axes.y (), axes.z ()};
  return (header);
}

} // namespace pcl::cosection
