// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

/** \brief What each fuzz_*.cpp defines; what the driver and LLVMFuzzerTestOneInput () need. */
namespace fuzz {

/** \brief Valid inputs of every kind. */
std::vector<std::string> seeds ();

/** \brief Words that mean something in the inputs. */
std::vector<std::string> dictionary ();

/** \brief Read \a input as the program would.
 * \return whether it was accepted; false if it was refused by an error of ours. Ends the program if
 * anything else is thrown, or if what was read is inconsistent. */
bool accepts (const std::string& input);

/** \brief A property of what was read. */
inline void
require (bool holds, const char* property)
{
  if (holds)
    return;
  std::fprintf (stderr, "fuzz: does not hold: %s\n", property);
  std::abort ();
}

/** \brief A message of an error: one line that says something. */
inline void
requireMessage (const std::string& message)
{
  require (!message.empty () && message.find ('\n') == std::string::npos, "an error's message is one line");
}

} // namespace fuzz

/** \brief The entry point of libFuzzer and AFL++. */
extern "C" int LLVMFuzzerTestOneInput (const std::uint8_t* data, std::size_t size);
