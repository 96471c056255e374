// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "pcl_cosection/fusion/tracking/frame_cloud.h"

#include "pcl_cosection/fusion/association/data_association.h"
#include <pcl/cosection/common/image.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace pcl::cosection
{

/** \brief Pixels of a frame by what they show. */
struct FrameSegmentation
{
  static constexpr std::uint16_t
      unassigned = 65535; ///< neither the background nor a known object; in a mask: to be ignored

  Image<std::uint16_t> labels;                      ///< id of the object, 0: background or no reading
  std::map<std::uint16_t, double> mean_probability; ///< of an object's pixels that its model explains
};

/** \brief What may join an object that is beside it. */
enum class ObjectGrowth
{
  Any,
  Small, ///< only what is no part of something larger than the object, or that the image's border cuts, as an arm
};

/** \brief Segment a frame by its association alone. Pixels that no model explains join the object beside them in the
 * image and in depth, if the background has seen their place free and the object has not, and only so far in from where
 * it is known; the others in places that the background has seen free, or that lie in an object's volume, stay
 * unassigned.
 * \param[in] growth what may join
 * \param[in] models the background first
 * \param[in] ids of the models, 0 first */
FrameSegmentation segmentFrame (const FrameCloud& cloud, const std::vector<AssociatedModel>& models,
                                const std::vector<std::uint16_t>& ids, const DataAssociation& association,
                                ObjectGrowth growth = ObjectGrowth::Any);

/** \brief Give a mask the last word: pixels of an instance that matches an object become the object's, unless the
 * object has seen their place free; instances that match none and what is to be ignored become unassigned, and so do
 * pixels of a matched object outside its mask that the background does not explain.
 * \param[in] object_of by instance */
void applyMask (const FrameCloud& cloud, const Image<std::uint16_t>& mask,
                const std::map<std::uint16_t, std::uint16_t>& object_of, const std::vector<AssociatedModel>& models,
                const std::vector<std::uint16_t>& ids, const DataAssociation& association,
                FrameSegmentation& segmentation);

/** \brief Widen all labels but 0 by \a pixels into what has none, so that what is beside them counts for nothing. */
Image<std::uint16_t> widened (const Image<std::uint16_t>& labels, int pixels);

} // namespace pcl::cosection
