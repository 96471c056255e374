// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include <stdlib.h>
#include <sys/resource.h>

#include <csignal>

namespace pcl::cosection::test {

/** \brief A new folder that lives as long as the object. */
class TemporaryFolder
{
public:
  TemporaryFolder ()
  {
    std::string pattern = (std::filesystem::temp_directory_path () / "pcl_cosection_XXXXXX").string ();
    if (::mkdtemp (&pattern[0]) == nullptr)
      throw std::runtime_error ("cannot create " + pattern);
    path_ = pattern;
  }
  TemporaryFolder (const TemporaryFolder&) = delete;
  TemporaryFolder& operator= (const TemporaryFolder&) = delete;

  ~TemporaryFolder ()
  {
    std::error_code ignored;
    std::filesystem::remove_all (path_, ignored);
  }

  std::string file (const std::string& name) const { return (path_ / name).string (); }

  std::size_t entries () const
  {
    return static_cast<std::size_t> (
        std::distance (std::filesystem::directory_iterator (path_), std::filesystem::directory_iterator ()));
  }

private:
  std::filesystem::path path_;
};

/** \brief Limits the size of files that this process writes, for its lifetime, to simulate a full disk. */
class FileSizeLimit
{
public:
  explicit FileSizeLimit (rlim_t bytes)
  {
    ::getrlimit (RLIMIT_FSIZE, &before_);
    const rlimit limited{bytes, before_.rlim_max};
    handler_ = std::signal (SIGXFSZ, SIG_IGN);
    ::setrlimit (RLIMIT_FSIZE, &limited);
  }
  FileSizeLimit (const FileSizeLimit&) = delete;
  FileSizeLimit& operator= (const FileSizeLimit&) = delete;

  ~FileSizeLimit ()
  {
    ::setrlimit (RLIMIT_FSIZE, &before_);
    std::signal (SIGXFSZ, handler_);
  }

private:
  rlimit before_;
  void (*handler_) (int);
};

inline std::string
readFile (const std::string& path)
{
  std::ifstream in (path, std::ios::binary);
  return {std::istreambuf_iterator<char> (in), std::istreambuf_iterator<char> ()};
}

inline void
writeFile (const std::string& path, const std::string& bytes)
{
  std::filesystem::remove (path); // some file systems wait for the disk when a file is overwritten
  std::ofstream (path, std::ios::binary) << bytes;
}

} // namespace pcl::cosection::test
