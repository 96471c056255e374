// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>

namespace pcl::cosection {

/** \brief Changes a setting of the whole process, such as the verbosity of a library, while any object of this type
 * lives in any thread: the first one remembers the setting, the last one restores it.
 * \tparam Setting has Value, the static functions change (...), which returns the Value before, and restore (Value) */
template <typename Setting> class ProcessSetting
{
public:
  template <typename... Arguments> explicit ProcessSetting (const Arguments&... arguments)
  {
    const std::lock_guard<std::mutex> lock (mutex_);
    if (users_++ == 0)
      before_ = Setting::change (arguments...);
  }

  ProcessSetting (const ProcessSetting&) = delete;
  ProcessSetting& operator= (const ProcessSetting&) = delete;

  ~ProcessSetting ()
  {
    const std::lock_guard<std::mutex> lock (mutex_);
    if (--users_ == 0)
      Setting::restore (before_);
  }

private:
  inline static std::mutex mutex_;
  inline static int users_ = 0;
  inline static typename Setting::Value before_{};
};

} // namespace pcl::cosection
