// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "atomic_file.h"
#include <pcl/cosection/common/error.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace pcl::cosection {
namespace {

namespace fs = std::filesystem;

constexpr int max_links = 40; ///< one after the other; as many as Linux follows

fs::path
behindLinks (fs::path path)
{
  for (int n = 0; n <= max_links; ++n)
  {
    std::error_code none;
    if (!fs::is_symlink (fs::symlink_status (path, none)))
      return path;
    path = path.parent_path () / fs::read_symlink (path); // which is the second alone if it is absolute
  }
  throw std::system_error (ELOOP, std::generic_category ());
}

/** \brief The file that \a path stands for, behind symbolic links.
 * \throws std::system_error if it exists and is not a regular file that may be written */
fs::path
resolveTarget (const fs::path& given)
{
  const fs::path path = behindLinks (given);
  const auto status = fs::status (path);
  if (!fs::exists (status))
  {
    if (!path.has_filename ())
      throw std::system_error (path.empty () ? ENOENT : EISDIR, std::generic_category ());
    return path;
  }
  if (fs::is_directory (status))
    throw std::system_error (EISDIR, std::generic_category ());
  if (!fs::is_regular_file (status)) // renaming would replace a device or a pipe by a file
    throw std::system_error (EINVAL, std::generic_category (), "not a regular file");
  if (::access (path.c_str (), W_OK) != 0)
    throw std::system_error (errno, std::generic_category ());
  return fs::canonical (path);
}

/** \brief Create an empty file of a new name beside \a target, with its extension. */
fs::path
createTemporary (const fs::path& target)
{
  for (int attempt = 0;; ++attempt)
  {
    fs::path temporary = target.parent_path ();
    temporary /= ".cosection-" + std::to_string (::getpid ()) + "-" + std::to_string (attempt) + ".tmp";
    temporary += target.extension ();
    const int descriptor = ::open (temporary.c_str (), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0)
    {
      ::close (descriptor);
      return temporary;
    }
    if (errno != EEXIST)
      throw std::system_error (errno, std::generic_category ());
  }
}

/** \brief Removes the file unless it was renamed. */
class TemporaryFile
{
public:
  explicit TemporaryFile (const fs::path& target) : path_ (createTemporary (target)) {}
  TemporaryFile (const TemporaryFile&) = delete;
  TemporaryFile& operator= (const TemporaryFile&) = delete;

  ~TemporaryFile ()
  {
    std::error_code ignored;
    if (!path_.empty ())
      fs::remove (path_, ignored);
  }

  const fs::path& path () const { return path_; }

  void renameTo (const fs::path& target)
  {
    fs::rename (path_, target);
    path_.clear ();
  }

private:
  fs::path path_;
};

} // namespace

std::string
followLinks (const std::string& path)
{
  try
  {
    return behindLinks (path).string ();
  }
  catch (const std::system_error& error)
  {
    throw IoError (path + ": " + error.code ().message ());
  }
}

void
writeAtomically (const std::string& path, const std::function<void (const std::string&)>& write)
{
  try
  {
    const fs::path target = resolveTarget (path);
    TemporaryFile temporary (target);
    write (temporary.path ().string ());
    temporary.renameTo (target);
  }
  catch (const std::system_error& error)
  {
    const bool special = error.code () == std::errc::invalid_argument;
    throw IoError ("cannot write '" + path + "': " + (special ? "not a regular file" : error.code ().message ()));
  }
}

} // namespace pcl::cosection
