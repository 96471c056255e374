// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>

/** \brief Frames from \a first up to but without \a last, counted from 0. */
struct FrameSpan
{
  std::size_t first = 0;
  std::optional<std::size_t> last; ///< nothing: to the end
};

/** \brief The value of --frames: "A:B", "A:" or ":B". \param[in] largest number that is allowed
 * \throws UsageError if it is anything else, or holds no frame */
FrameSpan parseFrames (const std::string& text, double largest = 1e9);
