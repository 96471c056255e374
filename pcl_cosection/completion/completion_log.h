// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <new>
#include <string>
#include <type_traits>
#include <vector>

namespace pcl::cosection {

/** \brief Messages of a completion: progress, times, warnings, and why objects failed. */
class CompletionLog
{
public:
  CompletionLog (std::size_t objects, const ProgressCallback& progress) : errors_ (objects), progress_ (progress) {}

  /** \throws Cancelled if the callback returns false */
  void report (const std::string& stage, double fraction) const
  {
    if (progress_ && !progress_ (stage, std::min (1.0, fraction)))
      throw Cancelled ("cancelled");
  }

  void warn (std::string warning) { warnings_.push_back (std::move (warning)); }

  /** \brief Call f (), add its time to that of a stage, and return its result. */
  template <typename Function> auto timed (const char* stage, Function&& f)
  {
    const Stopwatch watch{timings_s_[stage]};
    return f ();
  }

  /** \brief Call f () for one object. If it throws, only that object fails: failed () is then true.
   * \return whether it succeeded */
  template <typename Function> bool guard (std::size_t object, Function&& f)
  {
    errors_[object] = reasonOfFailure (f);
    return errors_[object].empty ();
  }

  /** \brief The results of f (o) for all objects o that have not failed; default values for the others. */
  template <typename Function> auto forEachObject (Function&& f)
  {
    std::vector<std::invoke_result_t<Function, std::size_t>> values (errors_.size ());
    for (std::size_t o = 0; o < errors_.size (); ++o)
      if (!failed (o))
        guard (o, [&] { values[o] = f (o); });
    return values;
  }

  /** \brief Call f (). If it throws, there is a warning that \a what was left out. */
  template <typename Function> void guardPart (const std::string& what, Function&& f)
  {
    const std::string reason = reasonOfFailure (f);
    if (!reason.empty ())
      warn (what + " was left out: " + reason);
  }

  bool failed (std::size_t object) const { return !errors_[object].empty (); }

  const std::string& error (std::size_t object) const { return errors_[object]; }

  const std::vector<std::string>& warnings () const { return warnings_; }

  const std::map<std::string, double>& timings () const { return timings_s_; }

  /** \brief Call f () and return the reason of its failure; empty if it succeeds. \throws Cancelled */
  template <typename Function> static std::string reasonOfFailure (Function&& f)
  {
    try
    {
      f ();
      return {};
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
  }

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
