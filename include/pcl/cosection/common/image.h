// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief An image, row by row. */
template <typename Pixel> struct Image
{
  Image () = default;
  /** \brief An image of one value. */
  Image (int width, int height, const Pixel& value = Pixel ())
      : width (width)
      , height (height)
      , pixels (static_cast<std::size_t> (width) * height, value)
  {}

  /** \brief The pixel in column \a u and row \a v. */
  Pixel& at (int u, int v) { return pixels[static_cast<std::size_t> (v) * width + u]; }

  /** \brief The pixel in column \a u and row \a v. */
  const Pixel& at (int u, int v) const { return pixels[static_cast<std::size_t> (v) * width + u]; }

  int width = 0;             ///< pixels
  int height = 0;            ///< pixels
  std::vector<Pixel> pixels; ///< width * height, row by row
};

/** \brief An 8-bit colour picture: red, green, blue. */
using Picture = Image<std::array<std::uint8_t, 3>>;

/** \brief Label of a pixel that shows neither an object nor the background, a person for example: nothing is tracked by
 * it, it is in no model, and it is never completed. */
constexpr std::uint16_t ignored_label = 65535;

} // namespace pcl::cosection
