// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "suggestion.h"

#include <algorithm>
#include <numeric>

namespace {

/** \brief Levenshtein distance, where more letters at the end cost little: "--vox" is near "--voxel-size". */
std::size_t
editDistance (const std::string& word, const std::string& name)
{
  constexpr std::size_t full = 4; // cost of an edit; a letter missing at the end costs 1
  std::vector<std::size_t> row (name.size () + 1);
  for (std::size_t j = 0; j < row.size (); ++j)
    row[j] = j * full;
  for (std::size_t i = 1; i <= word.size (); ++i)
  {
    std::size_t diagonal = row[0];
    row[0] = i * full;
    for (std::size_t j = 1; j <= name.size (); ++j)
    {
      const std::size_t replaced = diagonal + (word[i - 1] == name[j - 1] ? 0 : full);
      diagonal = row[j];
      row[j] = std::min ({replaced, row[j] + full, row[j - 1] + full});
    }
  }
  std::size_t best = row[name.size ()];
  for (std::size_t j = 0; j < name.size (); ++j)
    best = std::min (best, row[j] + (name.size () - j));
  return (best);
}

} // namespace

std::string
nearestName (const std::string& word, const std::vector<std::string>& names)
{
  std::string nearest;
  std::size_t smallest = 0;
  for (const std::string& name : names)
  {
    const std::size_t distance = editDistance (word, name);
    if (nearest.empty () || distance < smallest)
    {
      nearest = name;
      smallest = distance;
    }
  }
  const std::size_t letters = word.size () - std::min (word.size (), word.find_first_not_of ('-'));
  const std::size_t acceptable = 4 * (letters / 3) + 6; // a third of the letters, or the end missing
  return (smallest <= acceptable ? nearest : "");
}

std::string
suggestion (const std::string& word, const std::vector<std::string>& names, bool bare)
{
  const std::string name = nearestName (word, names);
  if (name.empty ())
    return ("");
  return ("; did you mean " + (bare ? name.substr (name.find_first_not_of ('-')) : name) + "?");
}
