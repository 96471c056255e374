// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "motion_view.h"

namespace pcl::cosection {

/** \brief Finds the bodies that were elsewhere in earlier views.
 * \param[in] earlier the youngest first, at least one
 * \param[in,out] next number of the next body that was not found before
 * \return the body of each pixel of the view */
std::vector<std::uint32_t> findMovingBodies (const MotionView& now, const std::vector<const MotionView*>& earlier,
                                             const MotionSegmentationOptions& options, std::uint32_t& next);

} // namespace pcl::cosection
