// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/view/sensor_view.h"

namespace pcl::cosection {

// Between something and what is behind it a sensor measures what is nowhere. These take the normals of such points, so
// that they are left out.

/** \brief Points of the background at depth edges, walls of which would stand between things. Those of objects are too
 * few to do without. */
void leaveOutMixedPixels (const DepthView& view, SensorCloud& cloud);

/** \brief Points of an unorganised object that lie beside an edge of it, as seen from the sensor, far behind that, and
 * far from others, if enough others remain: trails along the sensor's rays. In an image these are few pixels, of a
 * cloud that was thinned to one point per cell they are a large share.
 * \param[in] indices of the points of the object
 * \return whether some were left out of points that are one per pixel of an image */
bool leaveOutTrails (const PcdViewOptions& options, const DepthView& view, const std::vector<std::size_t>& indices,
                     SensorCloud& cloud);

/** \brief Points of the background near objects that are so much farther from each other than others there that they
 * show no surface. \param[in] background indices of the points near objects */
void leaveOutScattered (const PcdViewOptions& options, const Surroundings& objects,
                        const std::vector<std::size_t>& background, SensorCloud& cloud);

} // namespace pcl::cosection
