// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <nlohmann/json.hpp>

#include <string>

/** \brief Write a summary through a temporary name. \throws pcl::cosection::IoError */
void
writeJsonFile (const nlohmann::ordered_json& summary, const std::string& path);
