// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <stdexcept>
#include <string>

namespace fuzz
{

/** \brief A file without a place on a disk, gone when the process ends however it ends. */
class MemoryFile
{
public:
  MemoryFile ()
      : descriptor_ (memfd_create ("fuzz", MFD_CLOEXEC)), path_ ("/proc/self/fd/" + std::to_string (descriptor_))
  {
    if (descriptor_ < 0)
      throw std::runtime_error ("no file in memory");
  }
  MemoryFile (const MemoryFile&) = delete;
  MemoryFile&
  operator= (const MemoryFile&) = delete;

  ~MemoryFile ()
  {
    close (descriptor_);
  }

  /** \brief Replace its contents. */
  void
  set (const std::string& bytes)
  {
    if (ftruncate (descriptor_, 0) != 0 ||
        pwrite (descriptor_, bytes.data (), bytes.size (), 0) != static_cast<ssize_t> (bytes.size ()))
      throw std::runtime_error ("a file in memory cannot be written");
  }

  /** \brief Opens as any other file, in this process. */
  const std::string&
  path () const
  {
    return (path_);
  }

private:
  const int descriptor_;
  const std::string path_;
};

} // namespace fuzz
