// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/segmentation/geometric_segmentation.h>

#include <Eigen/Core>

#include <vector>

namespace pcl::cosection {

/** \brief Finds the objects of a scene in points without an order, as PCL's tutorials do: planes by RANSAC
 * (pcl::RandomSampleConsensus), then clusters of what is left (pcl::extractEuclideanClusters) that stand on the largest
 * plane, or on others that are longer than an object; without any plane, all clusters.
 *
 * Objects that touch each other are one: segmentObjects () does better where there is an image.
 * \param[in] points metres, in any frame; not finite: no reading
 * \param[in] options concave_angle_rad is not used
 * \return the side of a plane to which its normal points is the one on which more stands
 * \throws DegenerateInput if there are too few readings
 * \throws InvalidArgument if an option is outside its domain */
ObjectSegmentation segmentClusters (const std::vector<Eigen::Vector3f>& points,
                                    const ObjectSegmentationOptions& options = {});

} // namespace pcl::cosection
