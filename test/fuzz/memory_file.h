// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "test/common/temporary_folder.h"

#include <sys/mman.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

namespace fuzz {

/** \brief A file without a place on a disk, gone when the process ends however it ends. */
class MemoryFile
{
public:
  MemoryFile ()
      : descriptor_ (memfd_create ("fuzz", MFD_CLOEXEC))
      , path_ ("/proc/self/fd/" + std::to_string (descriptor_))
  {
    if (descriptor_ < 0)
      throw std::runtime_error ("no file in memory");
  }
  MemoryFile (const MemoryFile&) = delete;
  MemoryFile& operator= (const MemoryFile&) = delete;

  ~MemoryFile () { close (descriptor_); }

  /** \brief Replace its contents. */
  void set (const std::string& bytes)
  {
    if (ftruncate (descriptor_, 0) != 0 ||
        pwrite (descriptor_, bytes.data (), bytes.size (), 0) != static_cast<ssize_t> (bytes.size ()))
      throw std::runtime_error ("a file in memory cannot be written");
  }

  /** \brief Opens as any other file, in this process. */
  const std::string& path () const { return (path_); }

private:
  const int descriptor_;
  const std::string path_;
};

/** \brief A file in memory by names of any extension, for what is read by its name. */
class NamedMemoryFile : public MemoryFile
{
public:
  /** \param[in] extension ".ply" ... */
  std::string path (const std::string& extension) const
  {
    const std::string link = folder_.file ("fuzz" + extension);
    if (!std::filesystem::is_symlink (link))
      std::filesystem::create_symlink (MemoryFile::path (), link);
    return (link);
  }

private:
  pcl::cosection::test::TemporaryFolder folder_;
};

/** \brief A folder of files in memory, for what is read by the names in a folder. */
class MemoryFolder
{
public:
  /** \brief Replace the contents of a file, which is made if it is not there. \param[in] name "trajectory/camera.txt"
   * ... */
  void set (const std::string& name, const std::string& bytes)
  {
    std::unique_ptr<MemoryFile>& file = files_[name];
    if (!file)
    {
      file = std::make_unique<MemoryFile> ();
      const std::filesystem::path link = folder_.file (name);
      std::filesystem::create_directories (link.parent_path ());
      std::filesystem::create_symlink (file->path (), link);
    }
    file->set (bytes);
  }

  std::string path (const std::string& name = "") const { return (folder_.file (name)); }

private:
  pcl::cosection::test::TemporaryFolder folder_;
  std::map<std::string, std::unique_ptr<MemoryFile>> files_;
};

/** \brief An input of several kinds: what its first line says, and the rest. */
inline std::pair<std::string, std::string>
splitFirstLine (const std::string& input)
{
  const std::size_t end = input.find ('\n');
  if (end == std::string::npos)
    return {input, ""};
  return {input.substr (0, end), input.substr (end + 1)};
}

} // namespace fuzz
