// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Bytes as a trajectory.

#include "fuzz_target.h"
#include "memory_file.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/trajectory.h>

#include <cmath>

using namespace pcl::cosection;

namespace {

void
check (const std::vector<StampedPose>& poses)
{
  fuzz::require (!poses.empty (), "a trajectory has poses");
  for (std::size_t n = 0; n < poses.size (); ++n)
  {
    fuzz::require (std::isfinite (poses[n].stamp), "stamps are finite");
    fuzz::require (n == 0 || poses[n - 1].stamp < poses[n].stamp, "stamps ascend");
    fuzz::requireRigid (poses[n].pose);
  }
}

} // namespace

std::vector<std::string>
fuzz::seeds ()
{
  return {"# stamp tx ty tz qx qy qz qw\n0 0.1 -0.2 0.3 0 0 0 1\n1 0.2 -0.2 0.3 0 0.1 0 0.995\n",
          "1305031453.359684 1.3563 0.6305 1.6380 0.6132 0.5962 -0.3311 -0.3986\n"
          "1305031453.391690 1.3543 0.6306 1.6360 0.6129 0.5966 -0.3316 -0.3980\n",
          "0 -1 0 1  1 0 0 2  0 0 1 3\nnan nan nan nan nan nan nan nan nan nan nan nan\n1 0 0 1  0 1 0 2  0 0 1 3\n",
          "1 0 0 0.5 0 1 0 0 0 0 1 0 0 0 0 1\n",
          "1305031453359684000 0 0 0 0 0 0 1\n",
          "\n  # a comment\r\n+2\t1e-3 -1.5E+2 0  0 0 2 2\r\n\n-1 0 0 0 1 0 0 0"};
}

std::vector<std::string>
fuzz::dictionary ()
{
  return {"#",
          "# a comment\n",
          "\n",
          "\r\n",
          "\t",
          ",",
          "0 0 0 0 0 0 0 1\n",
          "2 0 0 0 0.5 0.5 0.5 0.5\n",
          "1e-200",
          "1e200",
          "0.001",
          "1e-5",
          "1305031453.359684",
          "1305031453359684000",
          "-1e18",
          "nan",
          "e",
          "."};
}

bool
fuzz::accepts (const std::string& input)
{
  static MemoryFile file;
  file.set (input);
  std::vector<StampedPose> poses;
  try
  {
    poses = loadTrajectory (file.path ());
  }
  catch (const Error& error)
  {
    requireMessage (error.what ());
    return (false);
  }
  check (poses);
  return (true);
}
