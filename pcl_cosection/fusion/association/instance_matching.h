// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/fusion/mapping/object_map.h"

#include <pcl/cosection/tracking/sdf_alignment.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace pcl::cosection {

/** \brief The instances of a frame, of a mask that was given or by a segmenter. */
struct FrameMask
{
  Image<std::uint16_t> instances;              ///< number per pixel, 0: none, FrameSegmenter::ignored
  std::map<std::uint16_t, ClassScore> classes; ///< of instances, where they are known
  bool exact = true;                           ///< instances are objects: FrameSegmenter::isExact ()
  bool shows_all = true;                       ///< FrameSegmenter::findsAll ()
};

/** \brief Which instances of a mask match which objects. */
struct MaskMatches
{
  std::map<std::uint16_t, std::uint16_t> object_of;     ///< by instance, of those that match
  std::map<std::uint16_t, std::size_t> instance_pixels; ///< by instance, those with a reading
  std::map<std::uint16_t, std::size_t> object_pixels;   ///< by object, those in \a rendered with a reading
};

/** \brief Match instances and objects one to one, those by descending intersection over union; smaller numbers
 * first where it is equal.
 * \param[in] mask instances, 0: none
 * \param[in] rendered labels of objects, 0: none
 * \param[in] depth pixels without a reading do not count
 * \param[in] min_iou must be exceeded
 * \throws InvalidArgument if the images have not the same size */
MaskMatches matchMasks (const Image<std::uint16_t>& mask, const Image<std::uint16_t>& rendered,
                        const Image<float>& depth, double min_iou);

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
