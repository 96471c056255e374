// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>

#include <functional>
#include <stdexcept>
#include <string>

namespace pcl::cosection {

/** \brief Base of everything the library throws; what () is one line fit for a user. */
class PCL_COSECTION_EXPORT Error : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
  ~Error () override;
};

/** \brief A parameter is outside its domain; the message names it and says what would be right. */
class PCL_COSECTION_EXPORT InvalidArgument : public Error
{
public:
  using Error::Error;
  ~InvalidArgument () override;
};

/** \brief A file cannot be read or written, or does not hold what it should. */
class PCL_COSECTION_EXPORT IoError : public Error
{
public:
  using Error::Error;
  ~IoError () override;
};

/** \brief The input is well formed but determines no surface (too few points, all on one spot ...). */
class PCL_COSECTION_EXPORT DegenerateInput : public Error
{
public:
  using Error::Error;
  ~DegenerateInput () override;
};

/** \brief The work would need more memory than was allowed. */
class PCL_COSECTION_EXPORT MemoryLimitExceeded : public Error
{
public:
  using Error::Error;
  ~MemoryLimitExceeded () override;
};

/** \brief The progress callback asked to stop. */
class PCL_COSECTION_EXPORT Cancelled : public Error
{
public:
  using Error::Error;
  ~Cancelled () override;
};

/** \brief Called now and then with the name of the running stage and the finished fraction of the
 * whole work in [0, 1], always from the calling thread. Returning false cancels: the running call
 * throws Cancelled and leaves nothing half-written. */
using ProgressCallback = std::function<bool (const std::string& stage, double fraction)>;

} // namespace pcl::cosection
