// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/sensor_view.h"

namespace pcl::cosection {

/** \brief Give points of objects on surfaces that an organised view sees at grazing angles normals, towards the sensor.
 *
 * From row to row they are as far apart as points on the two sides of a depth edge, so that computeOrganizedNormals ()
 * finds none. Here planes are fitted to the pixels around that are steep or have no normal either. Mixed pixels, too,
 * lie on surfaces along the rays; but these are a few pixels wide in the image and scatter, whereas normals are given
 * only where thin planes are several pixels wide and end, where they are farthest, with a jump to what is behind them,
 * unlike edges that were smeared.
 *
 * \param[in] members the readings of each label; those of label 0 are left alone
 * \param[in,out] cloud organised, in the frame of its sensor, with normals, NaN where there is none yet */
void addGrazingNormals (int threads, const Members& members, SensorCloud& cloud);

} // namespace pcl::cosection
