// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "class_summary.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <iomanip>
#include <sstream>

std::string
classText (int class_id, const std::string& class_name, double score)
{
  std::ostringstream text;
  text << (class_name == std::to_string (class_id) ? "class " : "") << class_name << ", score " << std::setprecision (2)
       << score;
  return (text.str ());
}

nlohmann::ordered_json
classJson (int class_id, const std::string& class_name, double score)
{
  return {{"class", class_name}, {"class_id", class_id}, {"score", std::round (1e4 * score) / 1e4}};
}
