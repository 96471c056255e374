// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/io/trajectory.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief The median difference of successive stamps that ascend; 1 if there are fewer than two. */
PCL_COSECTION_EXPORT double stampPeriod (const std::vector<double>& stamps);

/** \brief The index of the stamp nearest to \a stamp, if it is less than \a limit away; the earlier of two that are
 * equally near. O (log n).
 * \param[in] stamps ascending */
PCL_COSECTION_EXPORT std::optional<std::size_t> nearestStamp (const std::vector<double>& stamps, double stamp,
                                                              double limit);

/** \brief The pose of a trajectory for each frame: that of the nearest stamp if it is less than half a \a period away,
 * else nothing. A gap stays a gap: poses are neither interpolated nor extrapolated.
 * \param[in] trajectory by ascending stamps, as loadTrajectory () returns it
 * \param[in] stamps of the frames, in any order and of the trajectory's unit
 * \param[in] period of the frames, as stampPeriod () returns it
 * \throws InvalidArgument if the period is not positive and finite */
PCL_COSECTION_EXPORT std::vector<std::optional<Eigen::Isometry3d>>
posesAtStamps (const std::vector<StampedPose>& trajectory, const std::vector<double>& stamps, double period);

/** \brief A stamp in seconds, or the number of a frame: of 16 and 19 digits before the point, as times since 1970 in
 * micro- and nanoseconds have, seconds; nothing if it has more than 15 otherwise, or is not finite. */
PCL_COSECTION_EXPORT std::optional<double> stampOf (double number);

/** \brief The range of stamps for messages: "0 to 59". */
PCL_COSECTION_EXPORT std::string stampSpan (double first, double last);

} // namespace pcl::cosection
