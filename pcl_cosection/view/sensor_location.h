// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace pcl::cosection {

/** \brief Where the sensor may have stood that measured an unorganised cloud, from the order of its points.
 *
 * Such clouds often are images of which only the missing readings were removed. Where one of two neighbours of a row
 * lies far behind the other, both are nearly on one ray, so the line through them passes by the sensor. Most such lines
 * do not, as they begin and end in different rows or beside missing readings, which may happen to meet, too: places
 * that many of them pass by are sought by random samples (M. Fischler, R. Bolles, "Random Sample Consensus", 1981), one
 * after the other, and adjusted by least squares. The order may have gaps, as filters leave them, but not be another,
 * as of pcl::VoxelGrid.
 * \param[in] points row by row, in any frame, metres; not finite: no reading
 * \return places by which most lines pass, at most three; none if too few meet, or if they are too nearly parallel to
 * say how far away. drawRangeImage () finds whether all points are visible from there. The error is a few pixels'
 * width at the distance of the points
 *
 * O (points); deterministic. */
std::vector<Eigen::Vector3d> locateSensor (const std::vector<Eigen::Vector3f>& points);

/** \brief Where the views begin that were put one after the other into one cloud, each in its order, as
 * pcl::PointCloud::operator+= does: places are located as by locateSensor (), and the cloud is divided so that the
 * fewest lines miss the place of their part (A. Viterbi, 1967).
 * \return index of the first point of each view, the first is 0; nothing if there is no more than one
 *
 * O (points); deterministic. */
std::vector<std::size_t> beginningsOfViews (const std::vector<Eigen::Vector3f>& points);

} // namespace pcl::cosection
