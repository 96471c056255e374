// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <array>
#include <cstddef>
#include <functional>
#include <string>

namespace pcl::cosection {

/** \brief One end of a connection between two processes. */
class Channel
{
public:
  explicit Channel (int socket) : socket_ (socket) {}
  Channel (const Channel&) = delete;
  Channel& operator= (const Channel&) = delete;
  ~Channel ();

  /** \brief Send bytes. \return false if the other end is closed */
  bool send (const void* bytes, std::size_t size) const;

  /** \brief Wait for bytes. \return false if the other end is closed before all of them came */
  bool receive (void* bytes, std::size_t size) const;

  /** \brief Whether this process ends, by SIGIO, once the other end is closed. Nothing may be sent or received
   * meanwhile. */
  void endIfClosed (bool ends) const;

private:
  const int socket_;
};

/** \brief Another process that runs a function of this program, and may crash. It has the memory that this process had
 * when it was started, but no open files, and prints nothing. Signals that ask a program to end leave it alone: it ends
 * with this object, or with the process that made it. */
class ChildProcess
{
public:
  /** \brief Start it. \param[in] work runs in the new process, which ends afterwards. What it throws ends the process
   * as well. \throws IoError with the system's reason */
  explicit ChildProcess (const std::function<void (Channel& to_parent)>& work);
  ChildProcess (const ChildProcess&) = delete;
  ChildProcess& operator= (const ChildProcess&) = delete;
  /** \brief Ends it. */
  ~ChildProcess ();

  const Channel& channel () const { return (channel_); }

  /** \brief Wait a moment until it ends, then end it. \return the signal that ended it; 0 if that is not known */
  int waitForEnd ();

private:
  ChildProcess (const std::function<void (Channel& to_parent)>& work, const std::array<int, 2>& ends);

  /** \brief Note how it ended, if it did. \param[in] options of waitpid () */
  void look (int options);

  const pid_t maker_;
  Channel channel_;
  pid_t process_ = -1; // -1 once it has ended
  int signal_ = 0;
};

/** \brief What to say of a child process that ended by a signal. \param[in] signal as of ChildProcess::waitForEnd ()
 * \param[in] library that ran in it */
std::string causeOfEnd (int signal, const std::string& library);

/** \brief Let this process use some seconds of processor time from now on, and be ended by SIGXCPU after them. */
void limitProcessorTime (double seconds);

/** \brief Let this process allocate most of the machine's memory from now on; allocations beyond it fail. Does nothing
 * under a sanitizer, which reserves more. */
void limitMemory ();

} // namespace pcl::cosection
