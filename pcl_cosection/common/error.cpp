// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/common/error.h>

namespace pcl::cosection {

// Out-of-line destructors anchor the types' run-time information in this library, so that a
// handler in another library recognises them.
Error::~Error () = default;
InvalidArgument::~InvalidArgument () = default;
IoError::~IoError () = default;
DegenerateInput::~DegenerateInput () = default;
MemoryLimitExceeded::~MemoryLimitExceeded () = default;
Cancelled::~Cancelled () = default;

} // namespace pcl::cosection
