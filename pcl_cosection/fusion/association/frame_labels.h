// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/fusion/mapping/moving_parts.h"
#include "pcl_cosection/fusion/mapping/object_map.h"

#include <cstdint>
#include <map>
#include <vector>

namespace pcl::cosection {

// The images of labels that the stages of segmentation make, one from another.

/** \brief What association alone says of a frame. */
struct PixelAssociation
{
  LabelImage labels;
  std::map<std::uint16_t, double> mean_probability; ///< of the pixels that an object explains, by label
  std::vector<std::uint8_t> background;             ///< per pixel, PointAssignment::first
};

/** \brief Give each pixel to the model that it most likely shows. A pixel that no model explains is unassigned if its
 * place is known to be free in the background, or lies in an object's volume; else it is background. */
PixelAssociation associatePixels (const FrameCloud& cloud, const SceneModels& scene,
                                  const DataAssociation& association);

/** \brief What may join an object beside it. */
enum class ObjectGrowth
{
  Any,
  Small, ///< only components smaller than the object that the image's border does not cut, as it cuts an arm
};

/** \brief Let unassigned pixels join the object beside them, in the image and in depth, ring by ring: where the
 * background is known to be free and the object is not, and only so far from where the object is known. */
LabelImage growObjects (const PixelAssociation& associated, const FrameCloud& cloud, const SceneModels& scene,
                        const DataAssociation& association, ObjectGrowth growth);

/** \brief Replace labels. \param[in] new_label by label; others stay */
LabelImage relabelled (LabelImage labels, const LabelMap& new_label);

/** \brief Overrule association by a mask. Pixels of a matched instance become the object's, unless the object is known
 * to be free there. Unmatched instances and ignored pixels become unassigned, and so do pixels of a matched object
 * outside its instance that the background does not explain.
 * \param[in] object_of labels by instance, of those that match */
LabelImage applyMask (LabelImage labels, const Image<std::uint16_t>& mask, const LabelMap& object_of,
                      const FrameCloud& cloud, const SceneModels& scene, const DataAssociation& association);

/** \brief Unassign background pixels that move. */
LabelImage withoutMoving (LabelImage labels, const MovingParts& moving, const FrameCloud& cloud);

/** \brief Unassign background pixels that may show a lost object. */
LabelImage withoutLost (LabelImage labels, const ObjectMap& objects, const PosedFrame& frame);

/** \brief Unassign pixels of objects that are not confirmed. */
LabelImage withoutUnconfirmed (LabelImage labels, const ObjectMap& objects);

/** \brief Widen all labels but 0 by \a pixels into 0, so that readings beside them, which may be mixed, do not count.
 */
LabelImage widened (const LabelImage& labels, int pixels);

} // namespace pcl::cosection
