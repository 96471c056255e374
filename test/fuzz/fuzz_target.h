// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <Eigen/LU>

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

/** \brief Messages of errors or warnings: each is one line that says something. */
inline void
requireMessages (const std::vector<std::string>& messages)
{
  for (const std::string& message : messages)
    requireMessage (message);
}

/** \brief A motion as it is read from a file. */
inline void
requireRigid (const Eigen::Isometry3d& pose)
{
  require (pose.matrix ().allFinite (), "poses are finite");
  require ((pose.linear () * pose.linear ().transpose ()).isIdentity (1e-9), "rotations are orthonormal");
  require (pose.linear ().determinant () > 0.0, "rotations are not reflections");
}

} // namespace fuzz

/** \brief The entry point of libFuzzer and AFL++. */
extern "C" int LLVMFuzzerTestOneInput (const std::uint8_t* data, std::size_t size);
