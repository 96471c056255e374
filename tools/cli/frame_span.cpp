// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "frame_span.h"

#include "arguments.h"
#include "option_values.h"

#include <cmath>

FrameSpan
parseFrames (const std::string& text, double largest)
{
  const auto wrong = [&text] {
    return (
        UsageError ("--frames must be A:B, frames from A up to but without B, such as 0:50; it is \"" + text + "\""));
  };
  const auto frame = [&] (const std::string& part) -> std::optional<std::size_t> {
    if (part.empty ())
      return (std::nullopt);
    const std::optional<double> value = parseNumber (part);
    if (!value || !(*value >= 0.0 && *value <= largest) || *value != std::floor (*value))
      throw wrong ();
    return (static_cast<std::size_t> (*value));
  };
  const std::size_t colon = text.find (':');
  if (colon == std::string::npos)
    throw wrong ();
  const FrameSpan frames = {frame (text.substr (0, colon)).value_or (0), frame (text.substr (colon + 1))};
  if (frames.last && *frames.last <= frames.first)
    throw UsageError ("--frames " + text + " holds no frame");
  return (frames);
}
