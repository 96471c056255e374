// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <new>
#include <string>
#include <type_traits>
#include <vector>

namespace pcl::cosection
{

/** \brief What a completion says beside its result: progress, times, warnings, and why objects failed. */
class CompletionLog
{
public:
  CompletionLog (std::size_t objects, const ProgressCallback& progress) : errors_ (objects), progress_ (progress) {}

  /** \throws Cancelled if the callback says so */
  void report (const std::string& stage, double fraction) const
  {
    if (progress_ && !progress_ (stage, std::min (1.0, fraction)))
      throw Cancelled ("cancelled");
  }

  void warn (std::string warning) { warnings_.push_back (std::move (warning)); }

  /** \brief Does something, adds the time that it takes to that of a stage, and returns what it returns. */
  template <typename Function> auto timed (const char* stage, Function&& f)
  {
    const Stopwatch watch{timings_s_[stage]};
    return f ();
  }

  /** \brief Does something for one object. If it fails, only that object is lost: failed () is true from then on.
   * \return whether it succeeded */
  template <typename Function> bool guard (std::size_t object, Function&& f)
  {
    errors_[object] = reasonOfFailure (f);
    return errors_[object].empty ();
  }

  /** \brief A value for each object that has not failed; default values for the others. */
  template <typename Function> auto forEachObject (Function&& f)
  {
    std::vector<std::invoke_result_t<Function, std::size_t>> values (errors_.size ());
    for (std::size_t o = 0; o < errors_.size (); ++o)
      if (!failed (o))
        guard (o, [&] { values[o] = f (o); });
    return values;
  }

  /** \brief Why a function fails; empty if it does not. \throws Cancelled */
  template <typename Function> static std::string reasonOfFailure (Function&& f)
  {
    try
    {
      f ();
    }
    catch (const Cancelled&)
    {
      throw;
    }
    catch (const Error& e)
    {
      return e.what ();
    }
    catch (const std::bad_alloc&)
    {
      return "not enough memory";
    }
    return {};
  }

  bool failed (std::size_t object) const { return !errors_[object].empty (); }

  const std::string& error (std::size_t object) const { return errors_[object]; }

  const std::vector<std::string>& warnings () const { return warnings_; }

  const std::map<std::string, double>& timings () const { return timings_s_; }

private:
  struct Stopwatch
  {
    double& seconds;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now ();

    ~Stopwatch () { seconds += std::chrono::duration<double> (std::chrono::steady_clock::now () - start).count (); }
  };

  std::vector<std::string> errors_; // one per object, empty while it has not failed
  std::vector<std::string> warnings_;
  std::map<std::string, double> timings_s_;
  const ProgressCallback& progress_;
};

} // namespace pcl::cosection
