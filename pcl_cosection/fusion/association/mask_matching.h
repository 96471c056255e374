// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/image.h>

#include <cstddef>
#include <cstdint>
#include <map>

namespace pcl::cosection {

/** \brief Which instances of a mask match which objects. */
struct MaskMatches
{
  std::map<std::uint16_t, std::uint16_t> object_of;     ///< by instance, of those that match
  std::map<std::uint16_t, std::size_t> instance_pixels; ///< by instance, those with a reading
  std::map<std::uint16_t, std::size_t> object_pixels;   ///< by object, those in \a rendered with a reading
};

/** \brief Match instances and objects one to one, those by descending intersection over union; smaller numbers
 * first where it is equal.
 * \param[in] mask instances, 0: none
 * \param[in] rendered labels of objects, 0: none
 * \param[in] depth pixels without a reading do not count
 * \param[in] min_iou must be exceeded
 * \throws InvalidArgument if the images have not the same size */
MaskMatches matchMasks (const Image<std::uint16_t>& mask, const Image<std::uint16_t>& rendered,
                        const Image<float>& depth, double min_iou);

} // namespace pcl::cosection
