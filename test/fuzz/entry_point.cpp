// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "fuzz_target.h"

extern "C" int
LLVMFuzzerTestOneInput (const std::uint8_t* data, std::size_t size)
{
  fuzz::accepts (std::string (reinterpret_cast<const char*> (data), size));
  return (0);
}
