// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief One field of the points of a file. */
struct CloudField
{
  std::string name;
  std::size_t size = 0;  ///< bytes of one element
  char type = 0;         ///< I: signed, U: unsigned, F: floating point
  std::size_t count = 1; ///< elements

  /** \brief Bytes that mean nothing; binary_compressed leaves them out. */
  bool isPadding () const { return (name == "_"); }
};

enum class CloudEncoding
{
  Ascii,
  Binary,
  BinaryCompressed,
  Ply, ///< of any encoding
};

enum class CloudPadding
{
  Included,
  Excluded,
};

/** \brief What a PCD or PLY file says of its points. */
struct CloudHeader
{
  std::vector<CloudField> fields;
  std::uint64_t width = 0;
  std::uint64_t height = 0;
  std::uint64_t points = 0;
  std::array<double, 7> viewpoint = {0, 0, 0, 1, 0, 0, 0}; ///< tx ty tz qw qx qy qz
  CloudEncoding encoding = CloudEncoding::Ascii;
  std::size_t data_offset = 0; ///< bytes before the points, of a PCD file
  bool has_faces = false;      ///< of a PLY file
  bool has_more = false;       ///< of a PCD file that was read: points follow that the header does not announce

  /** \brief The field of this name, or nullptr. */
  const CloudField* find (const std::string& name) const;

  /** \brief The first field whose name is one of these, in upper or lower case, with scalar_ before it or not, and
   * whatever its underscores, or nullptr. */
  const CloudField* findAlike (const std::vector<std::string>& names) const;

  /** \brief Bytes of a point in a binary file. */
  std::uint64_t pointBytes (CloudPadding padding = CloudPadding::Included) const;
};

/** \brief Read the header of a PCD or PLY file and check it against the size of the file, so that a reader that trusts
 * the header neither leaves the file nor allocates more than a small multiple of it.
 * \throws IoError for anything but a well formed file, DegenerateInput if it holds no points */
CloudHeader readCloudHeader (const std::string& path);

/** \brief Describe a cloud in memory as the header of a file would. \param[in] name for messages \param[in]
 * T_world_sensor its viewpoint
 * \throws InvalidArgument unless the cloud has the bytes that its size and its fields ask for, DegenerateInput if it
 * holds no points */
CloudHeader describeCloud (const std::string& name, const PCLPointCloud2& cloud,
                           const Eigen::Isometry3d& T_world_sensor);

/** \brief Read the points that \a header, from readCloudHeader (), describes.
 *
 * pcl::PCDReader is not used: it reads the header again by rules of its own, for example lines of it that
 * stand in the wrong order or among the points, and then writes beyond the points' memory.
 *
 * Colours in three fields, of integers up to 255 or of real numbers up to 1, come in a further field rgb, too.
 * \param[in,out] header of a PLY file, it gets the camera that stands behind the points, and of either the field rgb
 * \return the fields of the header (of a compressed file, those that are no padding) and the bytes of
 * the points; its other members are not set
 * \throws IoError if the points are not what the header announces */
PCLPointCloud2 readCloudPoints (const std::string& path, CloudHeader& header);

/** \brief Text of a file fit for a message: short, and without what is not printable. */
std::string printable (const std::string& text);

} // namespace pcl::cosection
