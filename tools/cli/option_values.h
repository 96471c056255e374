// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

/** \brief No upper bound of a number. */
constexpr double unlimited = std::numeric_limits<double>::max ();

/** \brief A default for the help screen. */
template <typename Value>
std::string
byDefault (const Value& value)
{
  std::ostringstream text;
  text << " (default: " << value << ")";
  return (text.str ());
}

/** \brief Replace a setting by what the user gave, if anything. */
template <typename Target, typename Value>
void
override (Target& target, const std::optional<Value>& value)
{
  if (value)
    target = *value;
}

/** \brief Accepts one of some words. */
CLI::Validator oneOf (const std::vector<std::string>& words);

/** \brief Accepts a finite number in [\a least, \a most]; in (\a least, \a most] if \a open. */
CLI::Validator numberRange (double least, double most, bool open = false);

/** \brief Accepts a finite number greater than 0. */
CLI::Validator positiveNumber ();

/** \brief Accepts a whole number in [\a least, \a most]. */
CLI::Validator wholeRange (long least, long most);

/** \brief Declares the options of a group, which is a topic of the help screen. */
class OptionGroup
{
public:
  OptionGroup (CLI::App& app, const std::string& name) : app_ (app), name_ (name) {}

  /** \brief Declare an option with a value. \param[in] form its name and what stands for the value, as "--alpha
   * WEIGHT"; of words, as in "--format ply|stl", one of these is accepted \param[in] value a list has one of each time
   * that the option is given */
  template <typename Value> CLI::Option* add (const std::string& form, Value& value, const std::string& description)
  {
    const std::size_t space = form.find (' ');
    const std::string text = form.substr (space + 1);
    CLI::Option* option = app_.add_option (form.substr (0, space), value, description);
    if (text.find ('|') != std::string::npos)
      option->check (oneOf (CLI::detail::split (text, '|')));
    return (option->option_text (text)->allow_extra_args (false)->group (name_));
  }

  /** \param[in] check what is accepted */
  template <typename Value>
  CLI::Option* add (const std::string& form, Value& value, const CLI::Validator& check, const std::string& description)
  {
    return (add (form, value, description)->check (check));
  }

  /** \brief Declare an option without a value. */
  CLI::Option* addFlag (const std::string& name, bool& value, const std::string& description)
  {
    return (app_.add_flag (name, value, description)->group (name_));
  }

private:
  CLI::App& app_;
  const std::string name_;
};

/** \brief A finite number that fills \a text; nothing if it is anything else. */
std::optional<double> parseNumber (const std::string& text);

/** \brief Bytes from "500M", "2G", "1.5GiB" or "1000000"; k, M, G and T are powers of 1024.
 * Nothing if \a text is no such size, or zero. */
std::optional<std::size_t> parseSize (const std::string& text);

/** \brief The memory of this machine, bytes. */
std::size_t physicalMemory ();

/** \brief The numbers of values "a,b,c", or of values of one number (a list in a configuration file). Nothing if one of
 * them is no number. */
std::optional<std::vector<double>> parseNumbers (const std::vector<std::string>& values);

/** \brief The numbers of values "a,b,c", \a size each, or of values of one number.
 * Nothing if they do not come in groups of \a size. */
std::optional<std::vector<double>> parseGroups (const std::vector<std::string>& values, std::size_t size);

/** \brief The values of the options, group by group. */
template <std::size_t Size>
std::optional<std::vector<std::array<double, Size>>>
parseTuples (const std::vector<std::string>& values)
{
  const auto numbers = parseGroups (values, Size);
  if (!numbers)
    return (std::nullopt);
  std::vector<std::array<double, Size>> tuples (numbers->size () / Size);
  for (std::size_t i = 0; i < numbers->size (); ++i)
    tuples[i / Size][i % Size] = (*numbers)[i];
  return (tuples);
}

/** \brief The values of --intrinsics, "FX,FY,CX,CY" in pixels; nothing if there are no values. \throws UsageError */
std::optional<std::array<double, 4>> parseIntrinsics (const std::vector<std::string>& values);

/** \brief Frames from \a first up to but without \a last, counted from 0. */
struct FrameSpan
{
  std::size_t first = 0;
  std::optional<std::size_t> last; ///< nothing: to the end
};

/** \brief The value of --frames: "A:B", "A:" or ":B". \param[in] largest number that is allowed
 * \throws UsageError if it is anything else, or holds no frame */
FrameSpan parseFrames (const std::string& text, double largest = 1e9);
