// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <charconv>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief Append the shortest text that reads back as the same number, whatever the locale. */
template <typename T>
void
appendNumber (std::string& text, T value)
{
  std::array<char, 32> digits;
  const auto end = std::to_chars (digits.data (), digits.data () + digits.size (), value + T (0)); // no "-0"
  text.append (digits.data (), end.ptr);
}

/** \brief Append the elements of an Eigen vector. */
template <typename Vector>
void
appendNumbers (std::string& text, const Vector& values, const char* separator)
{
  for (int n = 0; n < values.size (); ++n)
  {
    if (n > 0)
      text += separator;
    appendNumber (text, values[n]);
  }
}

template <typename T>
std::string
numberText (T value)
{
  std::string text;
  appendNumber (text, value);
  return text;
}

/** \brief "x y z" */
template <typename Vector>
std::string
numbersText (const Vector& values, const char* separator = " ")
{
  std::string text;
  appendNumbers (text, values, separator);
  return text;
}

/** \brief "a" for one, "a and 3 more" for four. */
inline std::string
firstAndMore (const std::vector<std::string>& things)
{
  return things.size () == 1 ? things[0] : things[0] + " and " + std::to_string (things.size () - 1) + " more";
}

} // namespace pcl::cosection
