// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/io/rgbd_sequence.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief The mask of a frame; nothing if it has none. */
using MaskSource = std::function<std::optional<Image<std::uint16_t>> (const RgbdFrame& frame)>;

/** \brief Reads masks, and collects what is to be said about them. */
class MaskReader
{
public:
  /** \param[in] camera of the depth images */
  MaskReader (MaskSource masks, const PinholeCamera& camera) : masks_ (std::move (masks)), camera_ (camera) {}

  /** \brief The mask of a frame; nothing if it has none or the mask is damaged. Where an instance reaches beyond its
   * object (relabelStrayPatches ()), its pixels are those of what they show. */
  std::optional<Image<std::uint16_t>> read (const RgbdFrame& frame);

  /** \brief Whether a mask was read. */
  bool hasMasks () const { return used_ > 0; }

  /** \brief Whether there are masks, and none could be used. */
  bool lacksMasks () const { return masks_ && used_ == 0; }

  /** \brief Why masks that were read show no object at all; empty if a pixel of one has an instance. */
  std::string emptiness () const;

  std::vector<std::string> warnings () const;

private:
  MaskSource masks_; // empty: no frame has one
  PinholeCamera camera_;
  std::map<std::uint16_t, std::array<std::size_t, 2>> readings_; // by label: of all masks, and those elsewhere
  std::vector<std::string> warnings_;
  std::size_t more_ = 0;
  std::size_t used_ = 0;
  bool has_instance_ = false; // in any pixel
};

} // namespace pcl::cosection
