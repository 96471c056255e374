// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "organized_cloud.h"

#include "pcl_cosection/io/cloud/cloud_file.h"
#include "pcl_cosection/io/cloud/sensor_cloud.h"
#include "pcl_cosection/io/quiet_console.h"

#include "pcl_cosection/common/files.h"
#include "pcl_cosection/view/camera_resection.h"
#include "pcl_cosection/view/sensor_view.h"
#include <pcl/cosection/common/error.h>

#include <pcl/common/io.h>
#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <locale>
#include <sstream>

namespace pcl::cosection {
namespace {

constexpr std::size_t label_bytes = sizeof (std::uint32_t);

/** \brief The cloud without padding, and with these labels. */
PCLPointCloud2
withLabels (const PCLPointCloud2& cloud, const CloudHeader& header, const std::vector<std::uint32_t>& labels)
{
  struct Copy
  {
    std::size_t from, to, bytes;
  };
  std::vector<Copy> copies;
  PCLPointCloud2 result;
  result.height = static_cast<std::uint32_t> (header.height);
  result.width = static_cast<std::uint32_t> (header.width);
  std::size_t step = 0, label_offset = 0;
  bool has_label = false;
  const auto addLabel = [&] {
    PCLPointField field;
    field.name = "label";
    field.offset = static_cast<std::uint32_t> (step);
    field.datatype = PCLPointField::UINT32;
    field.count = 1;
    result.fields.push_back (field);
    label_offset = step;
    step += label_bytes;
    has_label = true;
  };
  for (const PCLPointField& field : cloud.fields)
  {
    const CloudField* const described = header.find (field.name);
    if (described == nullptr || described->isPadding ())
      continue;
    if (field.name == "label")
    {
      if (!has_label)
        addLabel ();
      continue;
    }
    const std::size_t bytes = described->size * described->count;
    copies.push_back ({field.offset, step, bytes});
    result.fields.push_back (field);
    result.fields.back ().offset = static_cast<std::uint32_t> (step);
    result.fields.back ().datatype = static_cast<std::uint8_t> (
        pcl::getFieldType (static_cast<int> (described->size), described->type));
    step += bytes;
  }
  if (!has_label)
    addLabel ();
  result.point_step = static_cast<std::uint32_t> (step);
  result.row_step = result.point_step * result.width;
  result.is_dense = false;
  result.data.resize (labels.size () * step);
  for (std::size_t i = 0; i < labels.size (); ++i)
  {
    for (const Copy& copy : copies)
      std::memcpy (result.data.data () + i * step + copy.to, cloud.data.data () + i * cloud.point_step + copy.from,
                   copy.bytes);
    std::memcpy (result.data.data () + i * step + label_offset, &labels[i], label_bytes);
  }
  return (result);
}

/** \brief A line VIEWPOINT: PCL writes it in single precision. */
std::string
viewpointLine (const std::array<double, 7>& viewpoint)
{
  std::ostringstream line;
  line.imbue (std::locale::classic ());
  line.precision (std::numeric_limits<double>::digits10);
  line << "VIEWPOINT";
  for (const double value : viewpoint)
    line << ' ' << value;
  return (line.str ());
}

/** \brief Write a compressed PCD file. PCL writes into memory: where the disk is full, it would die of a file that it
 * maps. \param[in] viewpoint translation and quaternion w x y z \throws IoError naming \a path */
void
writeCompressed (const std::string& path, const PCLPointCloud2& cloud, const std::array<double, 7>& viewpoint)
{
  std::ostringstream encoded;
  int failed = 0;
  {
    const QuietConsole quiet;
    failed = pcl::PCDWriter ().writeBinaryCompressed (encoded, cloud);
  }
  std::string bytes = encoded.str ();
  const std::size_t begin = bytes.find ("VIEWPOINT"), end = bytes.find ('\n', begin);
  if (failed != 0 || begin == std::string::npos || end == std::string::npos)
    throw IoError (path + ": cannot be written");
  bytes.replace (begin, end - begin, viewpointLine (viewpoint));
  writeAtomically (path, [&] (const std::string& temporary) { writeBytes (temporary, bytes); });
}

} // namespace

OrganizedCloud
readOrganizedCloud (const std::string& path, const PcdViewOptions& options, bool any)
{
  options.validate ();
  SensorCloud cloud = readSensorCloud (path, options, false);
  const bool organized = cloud.height > 1 && cloud.width > 1;
  if (!organized && !any)
    throw IoError (path + ": is not organised (WIDTH " + std::to_string (cloud.width) + ", HEIGHT " +
                   std::to_string (cloud.height) + "); an image of points is needed, as the sensor's driver gives it");
  const auto isFinite = [] (const Eigen::Vector3f& p) { return p.allFinite (); };
  if (std::none_of (cloud.positions.begin (), cloud.positions.end (), isFinite))
    throw DegenerateInput (path + ": holds no finite point");
  OrganizedCloud result;
  if (!organized)
  {
    LabelledView view;
    const Eigen::Vector3f before = *std::find_if (cloud.positions.begin (), cloud.positions.end (), isFinite);
    viewFromSensor (path, options, membersOf (cloud), cloud, view);
    result.seen_from_origin = view.view.has_value ();
    result.moved = before != *std::find_if (cloud.positions.begin (), cloud.positions.end (), isFinite);
  }
  result.width = organized ? cloud.width : cloud.width * cloud.height;
  result.height = organized ? cloud.height : 1;
  result.points = std::move (cloud.positions);
  if (organized && !fitPinholeCamera (result.points, result.width, result.height))
    if (const auto located = locateCamera (result.points, result.width, result.height))
    {
      result.points = takeToSensor (located->T_points_sensor.inverse (), result.points);
      result.moved = true;
    }
  if (!cloud.colours.empty ())
  {
    result.picture = Picture (result.width, result.height);
    result.picture.pixels = std::move (cloud.colours);
  }
  return (result);
}

std::string
hintOfUnit (const std::vector<Eigen::Vector3f>& points)
{
  constexpr float large_depth_m = 100.0f;
  float depth_m = 0.0f;
  for (const Eigen::Vector3f& p : points)
    if (p.allFinite ())
      depth_m = std::max (depth_m, p.z ());
  return depth_m > large_depth_m ? "is up to " + std::to_string (static_cast<long> (depth_m)) +
                                       " m deep; if it is in millimetres, give --scale 0.001"
                                 : "";
}

void
copyWithLabels (const std::string& input, const std::vector<std::uint32_t>& labels, const std::string& output)
{
  CloudHeader header = readCloudHeader (input);
  if (labels.size () != header.points)
    throw InvalidArgument (input + ": there must be one label per point");
  const PCLPointCloud2 points = readCloudPoints (input, header);
  writeCompressed (output, withLabels (points, header, labels), header.viewpoint);
}

void
saveLabelledCloud (const DepthView& view, const Image<std::uint16_t>& labels, const Picture& colours,
                   const std::string& path)
{
  view.validate ();
  if (labels.pixels.size () != view.depth.size () || colours.pixels.size () != view.depth.size ())
    throw InvalidArgument (path + ": there must be one label and one colour per pixel");
  pcl::PointCloud<pcl::PointXYZRGBL> cloud (view.camera.width, view.camera.height);
  cloud.is_dense = false;
  for (int v = 0; v < view.camera.height; ++v)
    for (int u = 0; u < view.camera.width; ++u)
    {
      pcl::PointXYZRGBL& point = cloud (u, v);
      const float z = view.at (u, v);
      if (std::isfinite (z))
        point.getVector3fMap () = view.camera.unproject (u, v, z).cast<float> ();
      else
        point.x = point.y = point.z = std::numeric_limits<float>::quiet_NaN ();
      const auto& colour = colours.at (u, v);
      point.r = colour[0];
      point.g = colour[1];
      point.b = colour[2];
      point.a = 255;
      point.label = labels.at (u, v);
    }
  PCLPointCloud2 points;
  pcl::toPCLPointCloud2 (cloud, points);
  const Eigen::Vector3d place = view.T_world_sensor.translation ();
  const Eigen::Quaterniond axes (view.T_world_sensor.linear ());
  writeCompressed (path, points, {place.x (), place.y (), place.z (), axes.w (), axes.x (), axes.y (), axes.z ()});
}

} // namespace pcl::cosection
