// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "many_balls.h"

#include <gtest/gtest.h>

#include <ctime>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

/** \brief The processor's time, so that what else runs on the machine counts little. */
double
secondsFor (int objects)
{
  const std::clock_t begin = std::clock ();
  const SceneResult result = completeManyBalls (objects, 1);
  EXPECT_EQ (result.objects.size (), static_cast<std::size_t> (objects));
  return static_cast<double> (std::clock () - begin) / CLOCKS_PER_SEC;
}

} // namespace

/** \brief Each object has few neighbours, so four times as many take about four times as long. */
TEST (ManyObjects, TakeTimeInProportionToTheirNumber)
{
  secondsFor (1);
  const double few = secondsFor (40), many = secondsFor (160);
  EXPECT_LT (many, 6.0 * few);
}
