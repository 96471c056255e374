// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/sensor_view.h"

#include <cstdint>
#include <map>

namespace pcl::cosection {

/** \brief Let labels that end within their objects grow to the objects' edges, over readings without a label.
 *
 * What a label leaves out of its object would else be background, which bounds it. An object ends in depth edges, and
 * where it meets its support planes (findSupportPlanes ()). Where the surface goes on beyond most of a label's outline,
 * the label grows by a pixel, and again, while it does so beyond a part of it, but by no more than an 80th of the
 * image's width: nobody leaves out more by mistake. A label without support planes is left as it is.
 *
 * \param[in] camera of the cloud \param[in] members the readings of each label
 * \param[in,out] cloud organised, in the frame of its sensor
 * \return the share of each label's readings that it did not have before, where it is not 0 */
std::map<std::uint32_t, double> growLabels (const PinholeCamera& camera, const Members& members, SensorCloud& cloud);

} // namespace pcl::cosection
