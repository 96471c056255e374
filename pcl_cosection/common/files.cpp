// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "files.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <system_error>

#include <fcntl.h>
#include <sys/types.h>
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

/** \brief Remove what processes that are gone left in a folder; each is looked at once. */
void
removeStale (const fs::path& folder)
{
  static std::mutex mutex;
  static std::set<fs::path> seen;
  {
    const std::lock_guard<std::mutex> lock (mutex);
    if (!seen.insert (folder).second)
      return;
  }
  std::error_code ignored;
  for (fs::directory_iterator file (folder, ignored), end; !ignored && file != end; file.increment (ignored))
    if (isOfGoneProcess (file->path ().filename ().string (), temporary_prefix) && file->is_regular_file (ignored))
      fs::remove (file->path (), ignored);
}

/** \brief Create an empty file of a new name beside \a target, with its extension. */
fs::path
createTemporary (const fs::path& target)
{
  removeStale (target.has_parent_path () ? target.parent_path () : fs::path ("."));
  for (int attempt = 0;; ++attempt)
  {
    fs::path temporary = target.parent_path ();
    temporary /= std::string (temporary_prefix) + std::to_string (::getpid ()) + "-" + std::to_string (attempt) +
                 ".tmp";
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

struct CloseFile
{
  void operator() (std::FILE* file) const { std::fclose (file); }
};

using File = std::unique_ptr<std::FILE, CloseFile>;

/** \brief The reason; EINVAL stands for what is not a regular file. */
std::string
reasonOf (const std::system_error& error)
{
  return error.code () == std::errc::invalid_argument ? "not a regular file" : error.code ().message ();
}

[[noreturn]] void
throwSystemError ()
{
  throw std::system_error (errno != 0 ? errno : EIO, std::generic_category ());
}

} // namespace

bool
isOfGoneProcess (const std::string& name, const std::string& prefix)
{
  if (name.rfind (prefix, 0) != 0)
    return false;
  pid_t process = 0;
  const char *const begin = name.data () + prefix.size (), *const end = name.data () + name.size ();
  const auto parsed = std::from_chars (begin, end, process);
  return parsed.ec == std::errc () && parsed.ptr != end && process > 0 && ::kill (process, 0) != 0 && errno == ESRCH;
}

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
    throw IoError ("cannot write '" + path + "': " + reasonOf (error));
  }
}

void
tryToWriteIn (const std::string& folder)
{
  const TemporaryFile probe (fs::path (folder) / "probe");
}

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
    if (const auto status = fs::status (path); fs::is_directory (status))
      throw std::system_error (EISDIR, std::generic_category ());
    else if (fs::exists (status) && !fs::is_regular_file (status)) // a pipe may never end, nor a device
      throw std::system_error (EINVAL, std::generic_category ());
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
    throw IoError ("cannot read '" + path + "': " + reasonOf (error));
  }
}

} // namespace pcl::cosection
