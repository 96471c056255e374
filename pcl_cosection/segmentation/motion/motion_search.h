// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "motion_labelling.h"
#include "motion_view.h"
#include "pcl_cosection/segmentation/geometry/surface_patches.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief Finds the bodies that were elsewhere in earlier views. */
class MotionSearch
{
public:
  /** \param[in] earlier the youngest first, at least one */
  MotionSearch (const MotionView& now, const std::vector<const MotionView*>& earlier,
                const MotionSegmentationOptions& options);

  /** \param[in,out] next number of the next body that was not found before
   * \return the body of each pixel of the view */
  std::vector<std::uint32_t> run (std::uint32_t& next);

private:
  /** \brief An earlier view, and what it says if nothing moved. */
  struct Earlier
  {
    const MotionView* view;
    Eigen::Isometry3d T_then_now;  ///< of what is at rest, sensor frames
    std::vector<Sighting> at_rest; ///< of the pixels now
    float scale;                   ///< of the noise
    std::vector<char> gone;        ///< its pixels that are seen through now
    std::vector<int> gone_pixels;
  };

  /** \brief A motion: one per earlier view; nothing where it is not known. */
  using Motion = std::vector<std::optional<Eigen::Isometry3d>>;

  void lookAt (const MotionView& view);
  void dividePatches ();

  /** \brief In standard deviations; positive, where it was seen through. */
  float ahead (const Earlier& earlier, const Sighting& sighting, int pixel) const;

  /** \brief Whether a pixel is plainly where an earlier view has seen through. */
  bool isNew (const Earlier& earlier, int pixel) const;
  bool isNew (int pixel) const; ///< in any of them

  /** \brief What a pixel says for the motion, and against rest: from -1 to 1. */
  float vote (int pixel, const Motion& motion) const;

  /** \brief Where the pixels were. */
  Motion follow (const std::vector<int>& pixels) const;

  /** \brief The motion of a known body. */
  Motion motionOf (std::uint32_t body) const;

  /** \brief Those that move so, without parts that show it nowhere. \param[in] body known, or 0 */
  std::vector<char> pixelsMoving (const Motion& motion, std::uint32_t body) const;

  /** \brief The numbered part that shows most, and those near it that show something. */
  std::vector<char> oneBody (const std::vector<int>& parts, std::uint32_t body) const;

  /** \brief How many of these pixels are new in the earlier view in which most are, and explained there. */
  int explained (const std::vector<char>& pixels, const Motion& motion) const;

  /** \brief Unexplained pixels of patches that are new in the earlier view in which most are; by piece. */
  std::vector<int> newPixels () const;

  /** \brief Those of a piece that belong to no body yet. \param[in] beside_new only those on and around patches that
   * are new */
  std::vector<int> pixelsOf (int piece, bool beside_new) const;

  /** \brief Mark what moves and belongs to no body. */
  void leaveUnexplained ();

  /** \brief Try whether pixels move as a whole, and give them a number if they do. */
  bool tryBody (const std::vector<int>& pixels, std::uint32_t& next);

  /** \brief The number that most of the pixels had in the youngest view for which bodies were searched. */
  std::uint32_t numberBefore (const std::vector<char>& pixels, const Motion& motion) const;

  const MotionView& now_;
  const MotionSegmentationOptions& options_;
  int min_pixels_;
  std::vector<Earlier> earlier_;
  PatchImage patches_;
  PatchEvidence borders_;
  std::vector<int> piece_of_; ///< by patch
  int pieces_ = 0;
  std::vector<std::uint32_t> found_;
};

} // namespace pcl::cosection
