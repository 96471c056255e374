// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Settings of the process that several threads change and restore.

#include "pcl_cosection/common/process_setting.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace {

struct Level
{
  using Value = int;

  inline static std::atomic<int> now = 3;

  static Value change (int level) { return now.exchange (level); }
  static void restore (Value before) { now = before; }
};

} // namespace

TEST (ProcessSetting, IsAsBeforeWhenTheLastUserIsGone)
{
  {
    const pcl::cosection::ProcessSetting<Level> first (0);
    {
      const pcl::cosection::ProcessSetting<Level> second (1);
      EXPECT_EQ (Level::now, 0) << "the first one sets it";
    }
    EXPECT_EQ (Level::now, 0);
  }
  EXPECT_EQ (Level::now, 3);

  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back ([] {
      for (int n = 0; n < 2000; ++n)
      {
        const pcl::cosection::ProcessSetting<Level> quiet (0);
        if (Level::now != 0)
          ADD_FAILURE () << "restored while it was in use";
      }
    });
  for (std::thread& thread : threads)
    thread.join ();
  EXPECT_EQ (Level::now, 3);
}
