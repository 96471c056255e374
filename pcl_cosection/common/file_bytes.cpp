// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "file_bytes.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

namespace pcl::cosection {
namespace {

struct CloseFile
{
  void operator() (std::FILE* file) const { std::fclose (file); }
};

using File = std::unique_ptr<std::FILE, CloseFile>;

[[noreturn]] void
throwSystemError ()
{
  throw std::system_error (errno != 0 ? errno : EIO, std::generic_category ());
}

} // namespace

void
writeBytes (const std::string& path, const std::string& bytes)
{
  errno = 0;
  File file (std::fopen (path.c_str (), "wb"));
  if (!file)
    throwSystemError ();
  if (std::fwrite (bytes.data (), 1, bytes.size (), file.get ()) != bytes.size ())
    throwSystemError ();
  if (std::fclose (file.release ()) != 0) // writes what is still buffered
    throwSystemError ();
}

std::string
readBytes (const std::string& path)
{
  try
  {
    errno = 0;
    const File file (std::fopen (path.c_str (), "rb"));
    if (!file)
      throwSystemError ();
    std::string bytes;
    constexpr std::size_t smallest = 1 << 14;
    for (std::size_t got = 1; got != 0;)
    {
      const std::size_t size = bytes.size ();
      bytes.resize (std::max (2 * size, smallest));
      got = std::fread (&bytes[size], 1, bytes.size () - size, file.get ());
      bytes.resize (size + got);
    }
    if (std::ferror (file.get ()))
      throwSystemError ();
    return bytes;
  }
  catch (const std::system_error& error)
  {
    throw IoError ("cannot read '" + path + "': " + error.code ().message ());
  }
}

} // namespace pcl::cosection
