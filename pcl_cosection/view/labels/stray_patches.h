// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/sensor_view.h"
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>

namespace pcl::cosection {

constexpr double much_elsewhere = 0.05; ///< of the points of a label; real labels have 1 to 3 % of something else

/** \brief Give readings of an organised cloud that have the label of an object and show something else the label of
 * that: where a label reaches beyond its object, it is on what is behind or before it.
 *
 * The largest connected part of an object's readings is the object. Another part is no part of it if most of its
 * outline, as far as it borders on readings of other labels or has them two pixels away, has no depth edge: it is their
 * surface that goes on. What an occluder cuts off from an object ends in depth edges.
 *
 * \param[in] camera of the cloud \param[in] members the readings of each label
 * \param[in,out] cloud organised, in the frame of its sensor
 * \return the share of each object's readings that have another label now, where it is not 0 */
std::map<std::uint32_t, double> relabelStrayPatches (const PinholeCamera& camera, const Members& members,
                                                     SensorCloud& cloud);

/** \brief Give pixels of a mask that show something else than their object the label of that, as in a cloud. Pixels of
 * ignored_label stay.
 * \param[in] depth image, metres \param[in,out] mask of the same size
 * \return by label: its readings, and how many of them have another label now */
PCL_COSECTION_EXPORT std::map<std::uint16_t, std::array<std::size_t, 2>>
relabelStrayPatches (const PinholeCamera& camera, const Image<float>& depth, Image<std::uint16_t>& mask);

} // namespace pcl::cosection
