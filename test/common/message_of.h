// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace pcl::cosection::test {

/** \brief The message of the exception of type \a Exception that \a action throws. */
template <typename Exception, typename Action>
std::string
messageOf (Action&& action)
{
  try
  {
    action ();
  }
  catch (const Exception& error)
  {
    EXPECT_EQ (std::string (error.what ()).find ('\n'), std::string::npos);
    return error.what ();
  }
  ADD_FAILURE () << "no exception of the expected type";
  return {};
}

} // namespace pcl::cosection::test
