// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "text_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

TextTable::TextTable (std::vector<std::string> header)
{
  add (std::move (header));
}

void
TextTable::add (std::vector<std::string> row)
{
  rows_.push_back (std::move (row));
}

std::vector<std::string>
TextTable::lines () const
{
  std::vector<std::size_t> widths;
  for (const auto& row : rows_)
    for (std::size_t n = 0; n < row.size (); ++n)
    {
      widths.resize (std::max (widths.size (), n + 1), 0);
      widths[n] = std::max (widths[n], row[n].size ());
    }
  std::vector<std::string> lines;
  for (const auto& row : rows_)
  {
    std::string line;
    for (std::size_t n = 0; n < row.size (); ++n)
    {
      const std::string space (widths[n] - row[n].size (), ' ');
      line += n == 0 ? row[n] + space : "  " + space + row[n];
    }
    line.erase (line.find_last_not_of (' ') + 1);
    lines.push_back (line);
  }
  return (lines);
}

std::string
toText (double value, int digits)
{
  const double magnitude = std::abs (value) > 0.0 ? std::floor (std::log10 (std::abs (value))) : 0.0;
  const int decimals = std::clamp (digits - 1 - static_cast<int> (magnitude), 0, digits);
  char text[64];
  std::snprintf (text, sizeof (text), std::abs (value) < 1e9 ? "%.*f" : "%.*g", decimals, value);
  return (text);
}

std::string
inMillimetres (double metres)
{
  return (toText (1000.0 * metres));
}

std::string
inMillilitres (double cubic_metres)
{
  return (toText (1e6 * cubic_metres));
}

std::string
inPercent (double share)
{
  char text[32];
  std::snprintf (text, sizeof (text), "%.1f %%", 100.0 * share);
  return (text);
}

std::string
toShortText (double value)
{
  char text[32];
  std::snprintf (text, sizeof (text), "%.14g", value);
  return (text);
}

std::string
toField (double value)
{
  char text[32];
  std::snprintf (text, sizeof (text), "%.9g", value);
  return (text);
}
