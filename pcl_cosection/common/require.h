// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/error.h>

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

} // namespace pcl::cosection
