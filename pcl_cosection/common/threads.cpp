// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "threads.h"

#include <omp.h>

#include <algorithm>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

#include <sched.h>
#include <sys/types.h>
#include <unistd.h>

#include <csignal>

namespace pcl::cosection {
namespace {

/** \brief Until the system has forgotten a thread that was joined, it counts against the limit. */
void
waitUntilForgotten (pid_t thread)
{
  constexpr int most_waits = 1000;
  for (int n = 0; n < most_waits && ::tgkill (::getpid (), thread, 0) == 0; ++n)
    ::sched_yield ();
}

/** \brief How many of so many threads can live at once beside those there are. */
int
tryToMake (int wanted)
{
  std::mutex gate;
  std::vector<std::thread> threads;
  std::vector<pid_t> ids;
  try
  {
    const std::lock_guard<std::mutex> closed (gate);
    threads.reserve (wanted);
    ids.resize (wanted);
    for (pid_t& id : ids)
      threads.emplace_back ([&gate, &id] {
        id = ::gettid ();
        const std::lock_guard<std::mutex> opened (gate);
      });
  }
  catch (const std::system_error&)
  {}
  catch (const std::bad_alloc&)
  {}
  for (std::thread& thread : threads)
    thread.join ();
  for (std::size_t n = 0; n < threads.size (); ++n)
    waitUntilForgotten (ids[n]);
  return static_cast<int> (threads.size ());
}

} // namespace

int
obtainableThreads (int wanted)
{
  static thread_local int kept = 1; // by OpenMP's library for the regions of this thread
  const bool inner = omp_in_parallel () != 0;
  if (inner && omp_get_active_level () >= omp_get_max_active_levels ())
    return wanted; // it makes none
  const int there = inner || omp_get_dynamic () != 0 ? 1 : kept;
  const int obtained = std::min (wanted, omp_get_thread_limit ());
  if (obtained <= there)
    return kept = obtained;
  const int result = there + tryToMake (obtained - there);
  if (!inner)
    kept = result;
  return result;
}

} // namespace pcl::cosection
