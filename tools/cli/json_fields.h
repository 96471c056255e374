// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/** \brief The content of a file, in which fields may be missing or of another type. */
using Json = nlohmann::ordered_json;

/** \brief A member; null if it is missing. */
const Json& member (const Json& json, std::string_view key);

/** \brief A member that is a finite number. */
std::optional<double> numberIn (const Json& json, const std::string& key);

/** \brief A member that is true or false. */
std::optional<bool> flagIn (const Json& json, const std::string& key);

/** \brief A member that is text; empty if it is not. */
std::string textIn (const Json& json, const std::string& key);

/** \brief The texts in a member that is a list. */
std::vector<std::string> textsIn (const Json& json, const std::string& key);

/** \brief Read a summary that a program wrote. \return null if it is no JSON object, or nests too deeply
 * \throws pcl::cosection::IoError if the file cannot be read */
Json readJsonObject (const std::string& path);
