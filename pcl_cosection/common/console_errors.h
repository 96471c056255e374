// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/error.h>

#include <pcl/console/print.h>

namespace pcl::cosection {

/** \brief Does something on behalf of a PCL class, which throws nothing: errors go to PCL's console.
 * \param[in] where class and function, such as "cosection::HessianIMLS::setVoxelSize"
 * \return false if \a work threw an Error */
template <typename Work>
bool
reportErrors (const char* where, Work&& work)
{
  try
  {
    work ();
    return true;
  }
  catch (const Error& error)
  {
    PCL_ERROR ("[pcl::%s] %s.\n", where, error.what ());
    return false;
  }
}

} // namespace pcl::cosection
