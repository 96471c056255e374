// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief Words and numbers as one string, numbers with three digits. */
template <typename... Parts>
std::string
toText (const Parts&... parts)
{
  std::ostringstream text;
  text.precision (3);
  (text << ... << parts);
  return text.str ();
}

/** \brief Lines about decisions: the first hundred, then their number. */
class EventLog
{
public:
  template <typename... Parts> void add (double stamp, const Parts&... parts)
  {
    if (lines_.size () >= most)
    {
      ++more_;
      return;
    }
    std::ostringstream text;
    text.precision (10);
    text << "frame " << stamp << ": " << toText (parts...);
    lines_.push_back (text.str ());
  }

  std::vector<std::string> lines () const
  {
    std::vector<std::string> result = lines_;
    if (more_ > 0)
      result.push_back ("and " + std::to_string (more_) + " more");
    return result;
  }

private:
  static constexpr std::size_t most = 100;
  std::vector<std::string> lines_;
  std::size_t more_ = 0;
};

/** \brief Adds the seconds of a scope. */
class ScopedSeconds
{
public:
  explicit ScopedSeconds (double& seconds) : seconds_ (seconds) {}

  ~ScopedSeconds () { seconds_ += std::chrono::duration<double> (std::chrono::steady_clock::now () - start_).count (); }

  ScopedSeconds (const ScopedSeconds&) = delete;
  ScopedSeconds& operator= (const ScopedSeconds&) = delete;

private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now ();
};

} // namespace pcl::cosection
