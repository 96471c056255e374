// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/segmentation/network_outputs.h>

#include <cstddef>
#include <string>
#include <vector>

namespace pcl::cosection
{

/** \brief Read the names of a network's classes: a line for each, in the network's order. Spaces around a name are
 * taken off; an empty line is a class without a name.
 * \throws IoError naming the file, if it cannot be read or is no such list */
PCL_COSECTION_EXPORT std::vector<std::string> loadClassNames (const std::string& path);

/** \brief What becomes of a network's classes. A class is given by its name or its number. */
struct PCL_COSECTION_EXPORT ClassRoles
{
  std::vector<std::string> objects; ///< become objects; empty: all that are not below
  std::vector<std::string> statics; ///< belong to the background: tables, screens
  std::vector<std::string> ignored; ///< are neither objects nor background: people

  /** \brief \throws InvalidArgument if a class is not among the names, in two roles, or given by a name where there are
   * none */
  void validate (const std::vector<std::string>& class_names) const;
};

/** \brief Instances as an image of labels. */
struct PCL_COSECTION_EXPORT InstanceLabels
{
  Image<std::uint16_t> labels;        ///< 0 none, 1 ... objects, the one with the most pixels first; ignored_label
  std::vector<std::size_t> instances; ///< label n is instances[n - 1] of those that were given
};

/** \brief Share the pixels of an image out among instances: where several overlap, the one of the highest score has it.
 * Classes that are no objects leave it to the others; ignored ones take part.
 * \param[in] readings 0 where a pixel belongs to nothing, as there is no reading; empty: all pixels may
 * \throws InvalidArgument if \a readings have another size */
PCL_COSECTION_EXPORT InstanceLabels labelInstances (const std::vector<DetectedInstance>& instances, int width,
                                                    int height, const ClassRoles& roles = {},
                                                    const Image<std::uint8_t>& readings = {});

} // namespace pcl::cosection
