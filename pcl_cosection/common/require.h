// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/error.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <string>

namespace pcl::cosection {

/** \throws InvalidArgument with this message unless \a good */
inline void
require (bool good, const std::string& message)
{
  if (!good)
    throw InvalidArgument (message);
}

/** \throws InvalidArgument "NAME is VALUE; it must be DOMAIN" unless \a good */
inline void
require (bool good, const char* name, double value, const char* domain)
{
  if (good)
    return;
  std::ostringstream message;
  message << name << " is " << value << "; it must be " << domain;
  throw InvalidArgument (message.str ());
}

/** \brief Whether a number is positive and finite. */
inline bool
isPositive (double value)
{
  return value > 0.0 && std::isfinite (value);
}

/** \throws InvalidArgument unless so many points are those of an image of this size, and an int can count them
 * \param[in] what the message begins with */
inline void
requireImage (const std::string& what, std::size_t points, int width, int height)
{
  if (width <= 0 || height <= 0 || points != static_cast<std::size_t> (width) * height ||
      points > static_cast<std::size_t> (std::numeric_limits<int>::max ()))
    throw InvalidArgument (what + ": " + std::to_string (points) + " points do not fill an image of " +
                           std::to_string (width) + " x " + std::to_string (height));
}

} // namespace pcl::cosection
