// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "terminal.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <utility>

namespace {

constexpr int bar_width = 30;
constexpr std::size_t longest_line = 2000; // a value that is refused may be of any length
constexpr std::size_t stage_width = 40;    // so that the bar fits into a line of 80 characters

/** \brief A terminal that cannot go back to the beginning of its line. */
bool
isDumb ()
{
  const char* term = std::getenv ("TERM");
  return (term && std::string (term) == "dumb");
}

/** \brief Nothing of a text makes the terminal do anything. */
std::string
withoutControls (std::string text)
{
  std::replace_if (
      text.begin (), text.end (), [] (char c) { return (std::iscntrl (static_cast<unsigned char> (c)) != 0); }, '?');
  return (text);
}

/** \brief One line that no name of a file can make the terminal misbehave with. */
std::string
oneLine (std::string text)
{
  while (!text.empty () && (text.back () == '\n' || text.back () == '\r'))
    text.pop_back ();
  if (text.size () > longest_line)
    text = text.substr (0, longest_line / 2) + " ... " + text.substr (text.size () - longest_line / 2);
  std::replace_if (
      text.begin (), text.end (), [] (char c) { return (c == '\n' || c == '\r' || c == '\t'); }, ' ');
  return (withoutControls (std::move (text)));
}

} // namespace

Terminal::Terminal (const std::string& program)
    : program_ (program)
    , is_terminal_ (isatty (STDERR_FILENO) != 0 && !isDumb ())
{}

void
Terminal::result (const std::string& line)
{
  if (verbosity_ == Verbosity::Quiet)
    return;
  clearBar ();
  std::cout << withoutControls (line) << std::endl;
}

void
Terminal::detail (const std::string& line)
{
  if (verbosity_ == Verbosity::Verbose)
    say ("", line);
}

void
Terminal::warning (const std::string& line)
{
  if (verbosity_ != Verbosity::Quiet)
    say ("warning: ", line);
}

void
Terminal::progress (const std::string& stage, double fraction)
{
  if (stage != stage_)
    detail (stage);
  stage_ = stage;
  if (!is_terminal_ || verbosity_ == Verbosity::Quiet)
    return;
  const double clamped = std::min (1.0, std::max (0.0, fraction));
  const int filled = static_cast<int> (clamped * bar_width);
  char percent[16]; // the compiler does not see that it is at most 100
  std::snprintf (percent, sizeof (percent), "%3d%%", static_cast<int> (100.0 * clamped));
  const std::string bar = "[" + std::string (filled, '#') + std::string (bar_width - filled, ' ') + "] " + percent +
                          " " + oneLine (stage.substr (0, stage_width));
  if (bar == bar_)
    return;
  clearBar ();
  bar_ = bar;
  std::cerr << bar_ << std::flush;
}

void
Terminal::clearBar ()
{
  if (!bar_.empty ())
    std::cerr << '\r' << std::string (bar_.size (), ' ') << '\r' << std::flush;
  bar_.clear ();
}

void
Terminal::say (const std::string& kind, const std::string& line)
{
  clearBar ();
  std::cerr << program_ + ": " + kind + oneLine (line) + "\n" << std::flush;
}

std::string
counted (std::size_t count, const std::string& what)
{
  return (std::to_string (count) + ' ' + what + (count == 1 ? "" : "s"));
}
