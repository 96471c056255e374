// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "child_process.h"

#include <pcl/cosection/common/error.h>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <string>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PCL_COSECTION_HAS_SHADOW_MEMORY
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define PCL_COSECTION_HAS_SHADOW_MEMORY
#endif
#endif

namespace pcl::cosection {
namespace {

constexpr double share_of_memory = 0.75; ///< that a child may allocate

std::array<int, 2>
connectedSockets ()
{
  std::array<int, 2> ends;
  if (socketpair (AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data ()) != 0)
    throw IoError (std::string ("a process cannot be started: ") + std::strerror (errno));
  return (ends);
}

/** \brief Signals as at the start of a program, but for those that ask it to end: they are for the parent, which may
 * still want an answer. */
void
resetSignals ()
{
  for (int signal = 1; signal < NSIG; ++signal)
    std::signal (signal, SIG_DFL);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE})
    std::signal (signal, SIG_IGN);
  sigset_t nothing;
  sigemptyset (&nothing);
  pthread_sigmask (SIG_SETMASK, &nothing, nullptr);
}

/** \brief Close all files but a socket, for which others would wait in vain. \return the socket */
int
keepOnly (int socket)
{
  constexpr int kept = 3;
  const int none = open ("/dev/null", O_RDWR);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    dup2 (none, standard);
  dup2 (socket, kept);
  close_range (kept + 1, ~0u, 0);
  return (kept);
}

} // namespace

// --- Channel
// --------------------------------------------------------------------------------------------------------------

Channel::~Channel ()
{
  close (socket_);
}

bool
Channel::send (const void* bytes, std::size_t size) const
{
  const char* next = static_cast<const char*> (bytes);
  while (size > 0)
  {
    const ssize_t sent = ::send (socket_, next, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR)
      continue;
    if (sent <= 0)
      return (false);
    next += sent;
    size -= static_cast<std::size_t> (sent);
  }
  return (true);
}

bool
Channel::receive (void* bytes, std::size_t size) const
{
  char* next = static_cast<char*> (bytes);
  while (size > 0)
  {
    const ssize_t received = recv (socket_, next, size, 0);
    if (received < 0 && errno == EINTR)
      continue;
    if (received <= 0)
      return (false);
    next += received;
    size -= static_cast<std::size_t> (received);
  }
  return (true);
}

void
Channel::endIfClosed (bool ends) const
{
  fcntl (socket_, F_SETOWN, getpid ());
  const int flags = fcntl (socket_, F_GETFL);
  fcntl (socket_, F_SETFL, ends ? flags | O_ASYNC : flags & ~O_ASYNC);
}

// --- ChildProcess
// ---------------------------------------------------------------------------------------------------------

ChildProcess::ChildProcess (const std::function<void (Channel& to_parent)>& work)
    : ChildProcess (work, connectedSockets ())
{}

ChildProcess::ChildProcess (const std::function<void (Channel& to_parent)>& work, const std::array<int, 2>& ends)
    : maker_ (getpid ())
    , channel_ (ends[0])
{
  sigset_t all, before;
  sigfillset (&all);
  pthread_sigmask (SIG_SETMASK, &all, &before); // no handler of this process may run in the new one
  process_ = fork ();
  if (process_ == 0)
  {
    resetSignals ();
    prctl (PR_SET_DUMPABLE, 0); // a crash leaves no file
    try
    {
      Channel to_parent (keepOnly (ends[1]));
      work (to_parent);
    }
    catch (...)
    {}
    _exit (0);
  }
  const int error = errno;
  pthread_sigmask (SIG_SETMASK, &before, nullptr);
  close (ends[1]);
  if (process_ < 0)
    throw IoError (std::string ("a process cannot be started: ") + std::strerror (error));
}

ChildProcess::~ChildProcess ()
{
  if (process_ < 0 || getpid () != maker_) // in another child, which has a copy of this object
    return;
  kill (process_, SIGKILL);
  look (0);
}

int
ChildProcess::waitForEnd ()
{
  // What crashes closes its end of the channel first, and is gone a moment later.
  constexpr int tries = 2000;
  constexpr useconds_t pause_us = 1000;
  for (int n = 0; n < tries && process_ > 0; ++n)
  {
    look (WNOHANG);
    if (process_ > 0)
      usleep (pause_us);
  }
  if (process_ > 0)
  {
    kill (process_, SIGKILL);
    look (0);
  }
  return (signal_);
}

void
ChildProcess::look (int options)
{
  int status = 0;
  pid_t ended = 0;
  do
    ended = waitpid (process_, &status, options);
  while (ended < 0 && errno == EINTR);
  if (ended == 0)
    return;
  if (ended == process_ && WIFSIGNALED (status))
    signal_ = WTERMSIG (status);
  process_ = -1; // also where the program that uses the library does not let others wait
}

// --- Limits
// ---------------------------------------------------------------------------------------------------------------

std::string
causeOfEnd (int signal, const std::string& library)
{
  if (signal == SIGXCPU)
    return (library + " takes too long");
  if (signal == SIGKILL)
    return ("the process in which " + library + " runs was killed; perhaps it took too much memory");
  return (library + " crashes" + (signal > 0 ? std::string (" (") + strsignal (signal) + ")" : ""));
}

void
limitProcessorTime (double seconds)
{
  rusage usage = {};
  rlimit limit = {};
  if (getrusage (RUSAGE_SELF, &usage) != 0 || getrlimit (RLIMIT_CPU, &limit) != 0)
    return;
  const double used = static_cast<double> (usage.ru_utime.tv_sec + usage.ru_stime.tv_sec);
  limit.rlim_cur = std::min (limit.rlim_max, static_cast<rlim_t> (std::ceil (used + seconds)) + 1);
  setrlimit (RLIMIT_CPU, &limit);
}

void
limitMemory ()
{
#ifndef PCL_COSECTION_HAS_SHADOW_MEMORY
  const double page = static_cast<double> (sysconf (_SC_PAGESIZE));
  double used = 0.0;
  std::ifstream ("/proc/self/statm") >> used;
  rlimit limit = {};
  if (getrlimit (RLIMIT_AS, &limit) != 0)
    return;
  const double most = page * (used + share_of_memory * static_cast<double> (sysconf (_SC_PHYS_PAGES)));
  limit.rlim_cur = std::min (limit.rlim_cur, static_cast<rlim_t> (most));
  setrlimit (RLIMIT_AS, &limit);
#endif
}

} // namespace pcl::cosection
