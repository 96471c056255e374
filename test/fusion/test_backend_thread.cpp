// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The back end in a thread of its own: what it has in the end does not depend on how the threads run.

#include "backend_fixture.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/fusion/co_section_backend.h>

#include <algorithm>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr std::chrono::milliseconds moment (20);

class BackendThreadTest : public BackendTest
{
protected:
  Keyframe stamped (int n) const
  {
    Keyframe result = keyframe (0.05 * n);
    result.stamp = n;
    return result;
  }

  static void waitForAll (BackendThread& thread)
  {
    while (!thread.wait (0, moment))
      ;
  }

  SceneResult solutionOf (int keyframes) const
  {
    CoSectionBackend backend (options ());
    for (int n = 0; n < keyframes; ++n)
    {
      backend.addKeyframe (stamped (n), atRest ());
      backend.addFrame (stamped (n).view, atRest ());
    }
    return backend.solve ();
  }
};

} // namespace

TEST_F (BackendThreadTest, InStepItsUpdatesAreThoseOfTheBackEndAlone)
{
  CoSectionBackend backend (options ()), alone (options ());
  BackendThread thread (backend);
  for (int n = 0; n < 3; ++n)
  {
    thread.addKeyframe (stamped (n), atRest ());
    waitForAll (thread);
    const std::vector<BackendUpdate> updates = thread.takeUpdates ();
    ASSERT_EQ (updates.size (), 1u);
    EXPECT_EQ (updates[0].stamp, n);
    EXPECT_GT (updates[0].seconds, 0.0);
    alone.addKeyframe (stamped (n), atRest ());
    expectSame (updates[0].scene, alone.update (UpdateOutput::Meshes));
  }
  EXPECT_TRUE (thread.takeUpdates ().empty ());
}

TEST_F (BackendThreadTest, KeyframesThatComeMeanwhileAreCompletedTogether)
{
  constexpr int keyframes = 8;
  CoSectionBackend backend (options ());
  std::vector<double> stamps;
  {
    BackendThread thread (backend, UpdateOutput::Fields);
    for (int n = 0; n < keyframes; ++n)
    {
      thread.addKeyframe (stamped (n), atRest ());
      thread.addFrame (stamped (n).view, atRest ());
      for (const BackendUpdate& update : thread.takeUpdates ())
        stamps.push_back (update.stamp);
    }
    waitForAll (thread);
    for (const BackendUpdate& update : thread.takeUpdates ())
      stamps.push_back (update.stamp);
  }
  ASSERT_FALSE (stamps.empty ());
  EXPECT_TRUE (std::is_sorted (stamps.begin (), stamps.end ()));
  EXPECT_EQ (std::adjacent_find (stamps.begin (), stamps.end ()), stamps.end ());
  EXPECT_EQ (stamps.back (), keyframes - 1);
  EXPECT_EQ (backend.keyframes (), static_cast<std::size_t> (keyframes));
  backend.forgetUpdates ();
  expectSame (backend.solve (), solutionOf (keyframes));
}

TEST_F (BackendThreadTest, FramesAloneAskForNoUpdate)
{
  CoSectionBackend backend (options ());
  {
    BackendThread thread (backend);
    thread.addFrame (stamped (0).view, atRest ());
    waitForAll (thread);
    EXPECT_TRUE (thread.takeUpdates ().empty ());
  }
  EXPECT_EQ (backend.views (), 1u);
}

TEST_F (BackendThreadTest, CanBeGivenUpAtAnyTime)
{
  for (int wait = 0; wait < 3; ++wait)
  {
    CoSectionBackend backend (options ());
    {
      BackendThread thread (backend);
      for (int n = 0; n < 4; ++n)
        thread.addKeyframe (stamped (n), atRest ());
      thread.wait (0, wait * moment);
    }
    backend.addKeyframe (stamped (5), atRest ()); // the thread is gone
    EXPECT_EQ (backend.update (UpdateOutput::Fields).objects.at (0).error, "");
  }
}

TEST_F (BackendThreadTest, WhatFailsIsToldAndNothingMoreIsDone)
{
  Keyframe wrong = stamped (1);
  wrong.view.depth.pop_back ();
  CoSectionBackend backend (options ());
  {
    BackendThread thread (backend);
    thread.addKeyframe (wrong, atRest ());
    EXPECT_THROW (waitForAll (thread), InvalidArgument);
    EXPECT_THROW (thread.takeUpdates (), InvalidArgument);
    thread.addKeyframe (stamped (2), atRest ());
    EXPECT_THROW (thread.wait (0, moment), InvalidArgument);
  }
  EXPECT_EQ (backend.views (), 0u);
}
