// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/sensor_view.h"

#include <pcl/cosection/common/camera.h>

namespace pcl::cosection {

/** \brief Give points of objects on what is too thin for computeOrganizedNormals () normals, towards the sensor: wires,
 * handles, and the edges of sheets, of which a camera sees bands of a few pixels.
 *
 * A plane needs pixels all around. Of a band, all pixels of its label that are near in the image are near in space as
 * well; mixed pixels at the edges of what is wide have most of their label elsewhere, and those of a band have no
 * neighbours at their depth. A band lies along a line, and faces the sensor across it.
 *
 * \param[in] members the readings of each label; those of label 0 are left alone
 * \param[in,out] cloud organised, in the frame of its sensor, with normals, NaN where there is none yet */
void addThinNormals (int threads, const PinholeCamera& camera, const Members& members, SensorCloud& cloud);

} // namespace pcl::cosection
