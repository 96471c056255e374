// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "allocation_counter.h"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> current_bytes{0};
std::atomic<std::size_t> peak_bytes{0};

void*
counted (void* memory)
{
  if (!memory)
    throw std::bad_alloc ();
  const std::size_t size = malloc_usable_size (memory);
  const std::size_t now = current_bytes.fetch_add (size, std::memory_order_relaxed) + size;
  std::size_t peak = peak_bytes.load (std::memory_order_relaxed);
  while (peak < now && !peak_bytes.compare_exchange_weak (peak, now, std::memory_order_relaxed))
  {}
  return memory;
}

void
release (void* memory)
{
  if (memory)
    current_bytes.fetch_sub (malloc_usable_size (memory), std::memory_order_relaxed);
  std::free (memory);
}

void*
aligned (std::size_t size, std::align_val_t alignment)
{
  const auto step = static_cast<std::size_t> (alignment);
  return counted (std::aligned_alloc (step, (std::max<std::size_t> (size, 1) + step - 1) / step * step));
}

} // namespace

// The array and nothrow forms of the standard library call these.
void*
operator new (std::size_t size)
{
  return counted (std::malloc (std::max<std::size_t> (size, 1)));
}

void*
operator new (std::size_t size, std::align_val_t alignment)
{
  return aligned (size, alignment);
}

void
operator delete (void* memory) noexcept
{
  release (memory);
}

void
operator delete (void* memory, std::size_t) noexcept
{
  release (memory);
}

void
operator delete (void* memory, std::align_val_t) noexcept
{
  release (memory);
}

void
operator delete (void* memory, std::size_t, std::align_val_t) noexcept
{
  release (memory);
}

namespace pcl::cosection {

std::size_t
AllocationCounter::current ()
{
  return current_bytes;
}

std::size_t
AllocationCounter::peak ()
{
  return peak_bytes;
}

void
AllocationCounter::restart ()
{
  peak_bytes = current_bytes.load ();
}

} // namespace pcl::cosection
