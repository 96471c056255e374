// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace pcl::cosection {

/** \brief What the program has allocated with operator new, in every library it uses. Only programs that
 * compile allocation_counter.cpp count. */
struct AllocationCounter
{
  /** \brief Bytes allocated now. */
  static std::size_t current ();

  /** \brief The most at once since restart (). */
  static std::size_t peak ();

  static void restart ();
};

} // namespace pcl::cosection
