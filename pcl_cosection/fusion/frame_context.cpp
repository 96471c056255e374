// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "frame_context.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>

namespace pcl::cosection {

std::optional<Image<std::uint16_t>>
MaskReader::read (const RgbdFrame& frame)
{
  constexpr std::size_t most_warnings = 20;
  if (!masks_)
    return std::nullopt;
  try
  {
    return masks_->read (frame.stamp);
  }
  catch (const Error& error)
  {
    if (warnings_.size () < most_warnings)
      warnings_.push_back (std::string (error.what ()) + "; the frame is used without it");
    else
      ++more_;
    return std::nullopt;
  }
}

std::vector<std::string>
MaskReader::warnings () const
{
  std::vector<std::string> result = warnings_;
  if (more_ > 0)
    result.push_back ("and " + std::to_string (more_) + " more warnings about masks");
  return result;
}

std::map<int, FusedObject>::iterator
eraseObject (std::map<int, FusedObject>::iterator object, bool completed, FusionResult& result)
{
  std::vector<ObjectResult>& completions = result.scene.objects;
  completions.erase (std::remove_if (completions.begin (), completions.end (),
                                     [&] (const ObjectResult& completion) {
                                       return completion.id == object->first &&
                                              (completed || !completion.error.empty ());
                                     }),
                     completions.end ());
  return result.objects.erase (object);
}

} // namespace pcl::cosection
