// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

/** \brief Runs from when it is made. */
class Stopwatch
{
public:
  double seconds () const
  {
    return (std::chrono::duration<double> (std::chrono::steady_clock::now () - start_).count ());
  }

private:
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now ();
};
