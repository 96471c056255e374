// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief One field of a PCD file. */
struct PcdField
{
  std::string name;
  std::size_t size = 0;  ///< bytes of one element
  char type = 0;         ///< I: signed, U: unsigned, F: floating point
  std::size_t count = 1; ///< elements

  /** \brief Bytes that mean nothing; binary_compressed leaves them out. */
  bool isPadding () const { return (name == "_"); }
};

enum class PcdEncoding
{
  Ascii,
  Binary,
  BinaryCompressed,
};

enum class PcdPadding
{
  Included,
  Excluded,
};

/** \brief The header of a PCD file. */
struct PcdHeader
{
  std::vector<PcdField> fields;
  std::uint64_t width = 0;
  std::uint64_t height = 0;
  std::uint64_t points = 0;
  std::array<double, 7> viewpoint = {0, 0, 0, 1, 0, 0, 0}; ///< tx ty tz qw qx qy qz
  PcdEncoding encoding = PcdEncoding::Ascii;
  std::size_t data_offset = 0; ///< bytes before the points

  /** \brief The field of this name, or nullptr. */
  const PcdField* find (const std::string& name) const;

  /** \brief Bytes of a point in a binary file. */
  std::uint64_t pointBytes (PcdPadding padding = PcdPadding::Included) const;
};

/** \brief Read the header of a PCD file and check it against the size of the file, so that a reader
 * that trusts the header neither leaves the file nor allocates more than a small multiple of it.
 * \throws IoError for anything but a well formed file, DegenerateInput if it holds no points */
PcdHeader readPcdHeader (const std::string& path);

/** \brief Read the points that \a header, from readPcdHeader (), describes.
 *
 * pcl::PCDReader is not used: it reads the header again by rules of its own, for example lines of it that
 * stand in the wrong order or among the points, and then writes beyond the points' memory.
 *
 * \return the fields of the header (of a compressed file, those that are no padding) and the bytes of
 * the points; its other members are not set
 * \throws IoError if the points are not what the header announces */
PCLPointCloud2 readPcdPoints (const std::string& path, const PcdHeader& header);

/** \brief Text of a file fit for a message: short, and without what is not printable. */
std::string printable (const std::string& text);

} // namespace pcl::cosection
