// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "threads.h"

#include <omp.h>

#include <algorithm>
#include <cstddef>
#include <exception>

namespace pcl::cosection {

/** \brief Number of threads to use: \a requested, or all processors when it is 0. */
inline int
resolveThreads (int requested)
{
  return (requested > 0 ? requested : std::max (1, omp_get_num_procs ()));
}

/** \brief As resolveThreads (), but no more than are worth waking up for a pass over so many voxels. */
inline int
threadsForVoxels (int requested, std::size_t voxels)
{
  constexpr std::size_t voxels_per_thread = 16384;
  const std::size_t useful = std::max<std::size_t> (1, voxels / voxels_per_thread);
  return static_cast<int> (std::min (static_cast<std::size_t> (resolveThreads (requested)), useful));
}

/** \brief Call \a body (first, last) for consecutive chunks of [begin, end), one chunk per thread.
 *
 * The chunks depend on the number of threads; results must not: let \a body compute each element
 * independently of the chunk it is in. The first exception is rethrown on the calling thread. */
template <typename Body>
void
parallelChunks (int begin, int end, int threads, Body&& body)
{
  const int size = end - begin;
  if (size <= 0)
    return;
  int n = std::min (resolveThreads (threads), size);
  if (n > 1)
    n = obtainableThreads (n);
  if (n <= 1)
  {
    body (begin, end);
    return;
  }
  std::exception_ptr failure;
#pragma omp parallel for num_threads(n) schedule(static, 1)
  for (int chunk = 0; chunk < n; ++chunk)
  {
    try
    {
      const auto first = static_cast<long long> (size) * chunk / n;
      const auto last = static_cast<long long> (size) * (chunk + 1) / n;
      body (begin + static_cast<int> (first), begin + static_cast<int> (last));
    }
    catch (...)
    {
#pragma omp critical(pcl_cosection_parallel)
      if (!failure)
        failure = std::current_exception ();
    }
  }
  if (failure)
    std::rethrow_exception (failure);
}

/** \brief Call \a body (i) for every i in [begin, end), in contiguous chunks. */
template <typename Body>
void
parallelFor (int begin, int end, int threads, Body&& body)
{
  parallelChunks (begin, end, threads, [&body] (int first, int last) {
    for (int i = first; i < last; ++i)
      body (i);
  });
}

} // namespace pcl::cosection
