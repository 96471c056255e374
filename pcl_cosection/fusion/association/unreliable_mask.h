// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "pcl_cosection/fusion/tracking/frame_cloud.h"

#include <pcl/cosection/common/image.h>
#include <pcl/cosection/fusion/frame_segmenter.h>

#include <cstdint>
#include <map>
#include <set>
#include <utility>

namespace pcl::cosection
{

/** \brief A mask whose instances may be parts of objects, or several that touch, after it was compared with what is
 * known. */
struct ReconciledMask
{
  Image<std::uint16_t> mask;              ///< an object's instance has its number; those of no object have higher ones
  std::uint16_t last_object = 0;          ///< highest number of an object
  std::map<int, double> shown_iou;        ///< of what the mask showed of an object, with where the object is
  std::set<std::pair<int, int>> together; ///< objects that were one instance; smaller number first
  std::set<std::pair<int, int>> apart;    ///< objects that touch and were two
};

/** \brief Let what frames before have shown decide, where a mask contradicts it.
 *
 * An instance that shows half of an object, or of which half is the object's, is a part of it: the object gets all of
 * its parts, and what association says in any case. What moves by itself is not added to an object. An instance that
 * shows several objects stays divided as they are; what they do not explain of it is nobody's.
 * \param[in] labels what shows which object by association, 0: none, FrameSegmentation::unassigned
 * \param[in] moving 1: something that belongs to no object moves */
ReconciledMask reconcile (const Image<std::uint16_t>& mask, const Image<std::uint16_t>& labels,
                          const Image<std::uint8_t>& moving, const FrameCloud& cloud);

/** \brief Give instances that are nobody's and touch one of \a moved to it: they came along. Not what is part of
 * something larger than the object, or that reaches the image's border, as a hand that moves it. */
void attach (const std::set<int>& moved, const Image<std::uint16_t>& labels, const FrameCloud& cloud,
             ReconciledMask& reconciled);

/** \brief The classes of the instances that remain: of those that are what the segmenter showed, with an intersection
 * over union of more than a half.
 * \param[in] found by the segmenter \param[in] reconciled the same after reconcile () and attach () */
std::map<std::uint16_t, ClassScore> carryOver (const FrameInstances& found, const Image<std::uint16_t>& reconciled,
                                               const FrameCloud& cloud);

/** \brief Remove instances without an object that do not touch one: they may be anything.
 * \param[in] object_of by instance, of those that have one */
void dropSmallComponents (const FrameCloud& cloud, const std::map<std::uint16_t, std::uint16_t>& object_of,
                          Image<std::uint16_t>& mask);

} // namespace pcl::cosection
