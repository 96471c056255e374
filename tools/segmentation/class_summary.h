// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

/** \brief "cup, score 0.92"; "class 41, score 0.92" where a class has no name but its number. */
std::string classText (int class_id, const std::string& class_name, double score);

/** \brief For summaries: "class", "class_id", "score" to four digits. */
nlohmann::ordered_json classJson (int class_id, const std::string& class_name, double score);
