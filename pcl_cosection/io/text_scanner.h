// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace pcl::cosection {

/** \brief Takes a text apart, word by word or line by line. */
class TextScanner
{
public:
  explicit TextScanner (std::string_view text) : left_ (text) {}

  /** \brief The next word, on whatever line; empty at the end. */
  std::string_view word ()
  {
    left_.remove_prefix (std::min (left_.find_first_not_of (" \t\r\n\v\f"), left_.size ()));
    return take (std::min (left_.find_first_of (" \t\r\n\v\f"), left_.size ()));
  }

  /** \brief The rest of this line, without the line break. */
  std::string_view line ()
  {
    const std::string_view line = take (std::min (left_.find ('\n'), left_.size ()));
    left_.remove_prefix (left_.empty () ? 0 : 1);
    return line;
  }

  /** \brief The next bytes, as many as there are. */
  std::string_view bytes (std::size_t size) { return take (std::min (size, left_.size ())); }

  /** \brief What comes next. */
  std::string_view left () const { return left_; }

private:
  std::string_view take (std::size_t size)
  {
    const std::string_view taken = left_.substr (0, size);
    left_.remove_prefix (size);
    return taken;
  }

  std::string_view left_;
};

/** \brief A word of a file in quotes, for messages: shortened, and only printable characters. */
inline std::string
quoted (std::string_view word)
{
  constexpr std::size_t longest = 24;
  std::string text (word.substr (0, longest));
  for (char& c : text)
    if (c < ' ' || c > '~')
      c = '?';
  return "'" + text + (word.size () > longest ? "...'" : "'");
}

/** \brief A real number, whatever the locale; "nan" and "inf" too. \throws IoError */
inline double
toReal (std::string_view word)
{
  std::string_view digits = word;
  if (!digits.empty () && digits[0] == '+')
    digits.remove_prefix (1);
  double value = 0.0;
  const auto result = std::from_chars (digits.data (), digits.data () + digits.size (), value);
  if (digits.empty () || result.ptr != digits.data () + digits.size () || result.ec == std::errc::invalid_argument)
    throw IoError (word.empty () ? "it ends where a number should be" : quoted (word) + " is not a number");
  if (result.ec == std::errc::result_out_of_range) // too large, or too small to differ from 0
    return digits.find ("e-") == digits.npos && digits.find ("E-") == digits.npos
               ? std::numeric_limits<double>::infinity ()
               : 0.0;
  return value;
}

/** \brief An integer. \throws IoError */
inline std::int64_t
toInteger (std::string_view word)
{
  std::int64_t value = 0;
  const auto result = std::from_chars (word.data (), word.data () + word.size (), value);
  if (word.empty () || result.ptr != word.data () + word.size () || result.ec != std::errc ())
    throw IoError (word.empty () ? "it ends where a number should be" : quoted (word) + " is not an integer");
  return value;
}

} // namespace pcl::cosection
