// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "option_values.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

namespace {

std::string
format (double value)
{
  std::ostringstream text;
  text << value;
  return (text.str ());
}

} // namespace

std::optional<double>
parseNumber (const std::string& text)
{
  const char* const begin = text.c_str ();
  char* end = nullptr;
  const double value = std::strtod (begin, &end);
  if (text.empty () || end != begin + text.size () || !std::isfinite (value))
    return (std::nullopt);
  return (value);
}

std::optional<std::size_t>
parseSize (const std::string& text)
{
  const std::size_t digits = std::min (text.find_first_not_of ("0123456789.+-eE"), text.size ());
  const std::optional<double> number = parseNumber (text.substr (0, digits));
  std::string unit = text.substr (digits);
  if (!unit.empty () && (unit.back () == 'B' || unit.back () == 'b'))
    unit.pop_back ();
  if (unit.size () == 2 && unit[1] == 'i')
    unit.pop_back ();
  const std::string units = "kmgt";
  double factor = 1.0;
  if (!unit.empty ())
  {
    const std::size_t power = unit.size () == 1 ? units.find (static_cast<char> (std::tolower (unit[0])))
                                                : std::string::npos;
    if (power == std::string::npos)
      return (std::nullopt);
    factor = std::pow (1024.0, static_cast<double> (power + 1));
  }
  if (!number || *number * factor < 1.0 || *number * factor > 9e18)
    return (std::nullopt);
  return (static_cast<std::size_t> (*number * factor));
}

std::size_t
physicalMemory ()
{
  return (static_cast<std::size_t> (sysconf (_SC_PHYS_PAGES)) * static_cast<std::size_t> (sysconf (_SC_PAGESIZE)));
}

std::optional<std::vector<double>>
parseGroups (const std::vector<std::string>& values, std::size_t size)
{
  std::vector<double> numbers;
  for (const std::string& value : values)
  {
    std::istringstream stream (value);
    std::size_t count = 0;
    for (std::string part; std::getline (stream, part, ','); ++count)
    {
      const std::optional<double> number = parseNumber (part);
      if (!number)
        return (std::nullopt);
      numbers.push_back (*number);
    }
    if ((count != 1 && count != size) || value.back () == ',')
      return (std::nullopt);
  }
  if (numbers.empty () || numbers.size () % size != 0)
    return (std::nullopt);
  return (numbers);
}

std::optional<std::vector<double>>
parseNumbers (const std::vector<std::string>& values)
{
  std::vector<double> numbers;
  for (const std::string& value : values)
  {
    if (!value.empty () && value.back () == ',')
      return (std::nullopt);
    std::istringstream stream (value);
    for (std::string part; std::getline (stream, part, ',');)
    {
      const std::optional<double> number = parseNumber (part);
      if (!number)
        return (std::nullopt);
      numbers.push_back (*number);
    }
  }
  return (numbers);
}

CLI::Validator
numberRange (double least, double most, bool open)
{
  const auto check = [=] (const std::string& text) -> std::string {
    const std::optional<double> value = parseNumber (text);
    if (value && *value <= most && (open ? *value > least : *value >= least))
      return ("");
    std::string domain = open ? "greater than " + format (least) : format (least) + " or more";
    if (most < std::numeric_limits<double>::max ())
      domain += ", at most " + format (most);
    return ("\"" + text + "\" is not valid, it must be a number, " + domain);
  };
  return (CLI::Validator (check, ""));
}

CLI::Validator
wholeRange (long least, long most)
{
  const auto check = [=] (const std::string& text) -> std::string {
    char* end = nullptr;
    errno = 0;
    const long value = std::strtol (text.c_str (), &end, 10);
    if (!text.empty () && end == text.c_str () + text.size () && errno == 0 && value >= least && value <= most)
      return ("");
    return ("\"" + text + "\" is not valid, it must be a whole number from " + std::to_string (least) + " to " +
            std::to_string (most));
  };
  return (CLI::Validator (check, ""));
}
