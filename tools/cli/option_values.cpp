// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "option_values.h"

#include "arguments.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdlib>

namespace {

std::string
format (double value)
{
  std::ostringstream text;
  text << value;
  return (text.str ());
}

} // namespace

CLI::Validator
oneOf (const std::vector<std::string>& words)
{
  const auto check = [=] (const std::string& text) -> std::string {
    if (std::find (words.begin (), words.end (), text) != words.end ())
      return ("");
    std::string all;
    for (const std::string& word : words)
      all += (all.empty () ? "" : &word == &words.back () ? " or " : ", ") + word;
    return ("\"" + text + "\" is not valid, it must be " + all);
  };
  return (CLI::Validator (check, ""));
}

CLI::Validator
numberRange (double least, double most, bool open)
{
  const auto check = [=] (const std::string& text) -> std::string {
    const std::optional<double> value = parseNumber (text);
    if (value && *value <= most && (open ? *value > least : *value >= least))
      return ("");
    std::string domain;
    if (least > -unlimited)
      domain = open ? ", greater than " + format (least) : ", " + format (least) + " or more";
    if (most < unlimited)
      domain += ", at most " + format (most);
    return ("\"" + text + "\" is not valid, it must be a number" + domain);
  };
  return (CLI::Validator (check, ""));
}

CLI::Validator
positiveNumber ()
{
  return (numberRange (0, unlimited, true));
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

std::optional<double>
parseNumber (const std::string& text)
{
  char* end = nullptr;
  const double value = std::strtod (text.c_str (), &end);
  if (text.empty () || end != text.c_str () + text.size () || !std::isfinite (value))
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
  double factor = 1.0;
  if (!unit.empty ())
  {
    const std::size_t power = unit.size () == 1 ? std::string ("kmgt").find (static_cast<char> (std::tolower (unit[0])))
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

std::optional<std::vector<double>>
parseGroups (const std::vector<std::string>& values, std::size_t size)
{
  for (const std::string& value : values)
    if (const auto count = static_cast<std::size_t> (std::count (value.begin (), value.end (), ',')) + 1;
        value.empty () || (count != 1 && count != size))
      return (std::nullopt);
  std::optional<std::vector<double>> numbers = parseNumbers (values);
  if (numbers && (numbers->empty () || numbers->size () % size != 0))
    return (std::nullopt);
  return (numbers);
}

std::optional<std::array<double, 4>>
parseIntrinsics (const std::vector<std::string>& values)
{
  if (values.empty ())
    return (std::nullopt);
  const auto intrinsics = parseTuples<4> (values);
  if (!intrinsics || intrinsics->size () != 1 || !((*intrinsics)[0][0] > 0.0) || !((*intrinsics)[0][1] > 0.0))
    throw UsageError ("--intrinsics must be four numbers fx,fy,cx,cy with positive fx and fy");
  return ((*intrinsics)[0]);
}

FrameSpan
parseFrames (const std::string& text, double largest)
{
  const auto wrong = [&text] {
    return (
        UsageError ("--frames must be A:B, frames from A up to but without B, such as 0:50; it is \"" + text + "\""));
  };
  const auto frame = [&] (const std::string& part) -> std::optional<std::size_t> {
    if (part.empty ())
      return (std::nullopt);
    const std::optional<double> value = parseNumber (part);
    if (!value || !(*value >= 0.0 && *value <= largest) || *value != std::floor (*value))
      throw wrong ();
    return (static_cast<std::size_t> (*value));
  };
  const std::size_t colon = text.find (':');
  if (colon == std::string::npos)
    throw wrong ();
  const FrameSpan frames = {frame (text.substr (0, colon)).value_or (0), frame (text.substr (colon + 1))};
  if (frames.last && *frames.last <= frames.first)
    throw UsageError ("--frames " + text + " holds no frame");
  return (frames);
}
