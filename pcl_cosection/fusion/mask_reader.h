// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "frame_context.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief Reads masks, and collects what is to be said about them. */
class MaskReader
{
public:
  explicit MaskReader (MaskSource masks) : masks_ (std::move (masks)) {}

  /** \brief The mask of a frame; nothing if it has none or the mask is damaged. */
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
  std::vector<std::string> warnings_;
  std::size_t more_ = 0;
  std::size_t used_ = 0;
  bool has_instance_ = false; // in any pixel
};

} // namespace pcl::cosection
