// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "frame_labels.h"
#include "frame_mask.h"
#include "pcl_cosection/fusion/mapping/object_map.h"

#include <pcl/cosection/tracking/sdf_alignment.h>

#include <cstdint>
#include <map>
#include <vector>

namespace pcl::cosection {

/** \brief Which objects the instances of a mask show. */
struct MatchedInstances
{
  LabelMap object_of;                     ///< labels by instance, of those that show an object
  std::vector<std::uint16_t> new_objects; ///< labels of objects that were background until now
};

/** \brief Match the instances of a mask with objects, count the masks in which objects were seen and missed, and their
 * classes; look for lost objects among the instances that match none, and begin new objects with the other ones.
 * \param[in] labels by association */
MatchedInstances matchInstances (const PosedFrame& frame, const FrameMask& mask, const LabelImage& labels,
                                 const FusionSetup& setup, SdfAlignment& alignment, ObjectMap& objects, EventLog& log);

} // namespace pcl::cosection
