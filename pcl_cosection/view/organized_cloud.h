// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/image.h>
#include <pcl/cosection/io/pcd_view.h>

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief The points of an organised PCD or PLY file; of another one in one row, of height 1. */
struct OrganizedCloud
{
  int width = 0;
  int height = 0;
  std::vector<Eigen::Vector3f> points; ///< row by row, sensor frame, metres; NaN: no reading
  Picture picture;                     ///< the colours; empty if the file has none
  bool moved = false;                  ///< those of the file are in another frame, in which the sensor was found
  bool seen_from_origin = false; ///< not organised, but all were seen by a sensor there, as viewFromSensor () has it
};

/** \brief Read an organised PCD or PLY file; of the options, the scale, the frame of the points and the memory count.
 * \param[in] any also one that is not organised
 * \throws IoError if the file is not a well formed PCD or PLY file with x, y and z, or not organised (HEIGHT 1)
 * \throws DegenerateInput if it holds no finite point
 * \throws MemoryLimitExceeded, InvalidArgument as readPcdView () */
OrganizedCloud readOrganizedCloud (const std::string& path, const PcdViewOptions& options = {}, bool any = false);

/** \brief "is up to 870 m deep; if it is in millimetres, give --scale 0.001", where points are so far away that they
 * are probably not in metres; else empty. */
std::string hintOfUnit (const std::vector<Eigen::Vector3f>& points);

/** \brief Write a copy of a PCD file with other labels: width, height, order, viewpoint and the other fields stay; the
 * field label is replaced, or added as the last one. The copy is binary_compressed.
 * \param[in] labels one per point
 * \throws IoError naming the file that cannot be read or written \throws InvalidArgument if the number of labels is
 * wrong */
void copyWithLabels (const std::string& input, const std::vector<std::uint32_t>& labels, const std::string& output);

/** \brief Write a depth view as an organised PCD file with the fields x y z rgb label: points in the sensor frame, NaN
 * where there is no reading, and the sensor's pose as VIEWPOINT. readPcdView () reads it.
 * \param[in] labels one per pixel \param[in] colours one per pixel
 * \throws IoError, InvalidArgument if the sizes differ */
PCL_COSECTION_EXPORT void saveLabelledCloud (const DepthView& view, const Image<std::uint16_t>& labels,
                                             const Picture& colours, const std::string& path);

} // namespace pcl::cosection
