// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/image.h>

#include <cstddef>
#include <cstdint>
#include <map>

namespace pcl::cosection
{

/** \brief Which instances of a mask show which objects. */
struct MaskMatches
{
  std::map<std::uint16_t, std::uint16_t> object_of;     ///< by instance, of those that match
  std::map<std::uint16_t, std::size_t> instance_pixels; ///< of all instances, that have a reading
  std::map<std::uint16_t, std::size_t> object_pixels;   ///< of all objects in the rendered image
};

/** \brief Match instances and objects one to one, those of the largest intersection over union first; of equals, the
 * smallest numbers.
 * \param[in] mask instances, 0: none
 * \param[in] rendered where objects are expected, 0: nowhere
 * \param[in] depth pixels without a reading do not count
 * \param[in] min_iou must be exceeded
 * \throws InvalidArgument if the images have not the same size */
MaskMatches matchMasks (const Image<std::uint16_t>& mask, const Image<std::uint16_t>& rendered,
                        const Image<float>& depth, double min_iou);

} // namespace pcl::cosection
