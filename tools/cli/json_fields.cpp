// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "json_fields.h"

#include "pcl_cosection/common/files.h"
#include "pcl_cosection/common/json_depth.h"

#include <cmath>

using namespace pcl::cosection;

const Json&
member (const Json& json, std::string_view key)
{
  static const Json missing;
  if (!json.is_object ())
    return (missing);
  const auto found = json.find (std::string (key));
  return (found == json.end () ? missing : *found);
}

std::optional<double>
numberIn (const Json& json, const std::string& key)
{
  const Json& value = member (json, key);
  if (!value.is_number () || !std::isfinite (value.get<double> ()))
    return (std::nullopt);
  return (value.get<double> ());
}

std::optional<bool>
flagIn (const Json& json, const std::string& key)
{
  const Json& value = member (json, key);
  return (value.is_boolean () ? std::optional<bool> (value.get<bool> ()) : std::nullopt);
}

std::string
textIn (const Json& json, const std::string& key)
{
  const Json& value = member (json, key);
  return (value.is_string () ? value.get<std::string> () : std::string ());
}

std::vector<std::string>
textsIn (const Json& json, const std::string& key)
{
  std::vector<std::string> texts;
  const Json& list = member (json, key);
  if (list.is_array ())
    for (const Json& value : list)
      if (value.is_string ())
        texts.push_back (value.get<std::string> ());
  return (texts);
}

Json
readJsonObject (const std::string& path)
{
  const std::string text = readBytes (path);
  Json json = nestsDeeply (text) ? Json () : Json::parse (text, nullptr, false);
  return (json.is_object () ? json : Json ());
}
