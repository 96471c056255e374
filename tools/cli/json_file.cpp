// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "json_file.h"

#include <pcl/cosection/common/atomic_file.h>
#include <pcl/cosection/common/error.h>

#include <fstream>

using namespace pcl::cosection;

void
writeJsonFile (const nlohmann::ordered_json& summary, const std::string& path)
{
  writeAtomically (path, [&] (const std::string& temporary) {
    std::ofstream file (temporary);
    // File names need not be UTF-8.
    file << summary.dump (2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << "\n";
    if (!file.flush ())
      throw IoError (path + ": cannot be written");
  });
}
