// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/fusion/tracking/frame_cloud.h"

#include <pcl/cosection/fusion/frame_segmenter.h>

#include <cstdint>
#include <map>
#include <set>
#include <utility>

namespace pcl::cosection {

/** \brief An unreliable mask, whose instances may be parts of objects or several objects that touch, after it was
 * compared with the labels of its frame. */
struct ReconciledMask
{
  Image<std::uint16_t> mask;              ///< an object's instance has its label; instances of no object higher ones
  std::uint16_t last_object = 0;          ///< highest label of an object
  std::map<int, double> shown_iou;        ///< by object, of its instances with its pixels
  std::set<std::pair<int, int>> together; ///< objects that were one instance; smaller id first
  std::set<std::pair<int, int>> apart;    ///< objects that touch and were two instances
};

/** \brief Let earlier frames decide where a mask contradicts them.
 *
 * An instance that shows half of an object, or of which half is the object's, is a part of it: the object gets all of
 * its parts, and the pixels that association gives it in any case. Moving pixels are not added to an object. An
 * instance that shows several objects is divided as they are; the rest of it belongs to none.
 * \param[in] labels by association
 * \param[in] moving 1: the pixel belongs to no object and moves */
ReconciledMask reconcile (const Image<std::uint16_t>& mask, const LabelImage& labels, const Image<std::uint8_t>& moving,
                          const FrameCloud& cloud);

/** \brief Attach unassigned components that touch an object which has moved to it: they moved with it. Components that
 * are larger than the object, or that the image's border cuts, stay, as the hand that moves it.
 * \param[in] moved ids \return the mask of \a reconciled with them */
Image<std::uint16_t> attachToMoved (const ReconciledMask& reconciled, const std::set<int>& moved,
                                    const LabelImage& labels, const FrameCloud& cloud);

/** \brief Classes of the instances of a reconciled mask: of those that have an intersection over union of more than a
 * half with an instance of the segmenter.
 * \param[in] found by the segmenter \param[in] reconciled instances */
std::map<std::uint16_t, ClassScore> carriedClasses (const FrameInstances& found, const Image<std::uint16_t>& reconciled,
                                                    const FrameCloud& cloud);

/** \brief Drop instances that neither show an object nor touch one that does: they may be anything.
 * \param[in] object_of by instance */
Image<std::uint16_t> dropIsolated (Image<std::uint16_t> mask, const LabelMap& object_of, const FrameCloud& cloud);

} // namespace pcl::cosection
