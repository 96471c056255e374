// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "failure_json.h"

#include <new>

std::string
describe (const std::exception& error)
{
  return (dynamic_cast<const std::bad_alloc*> (&error) ? std::string ("out of memory") : error.what ());
}
