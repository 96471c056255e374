// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "watch.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>

#if defined(__SANITIZE_ADDRESS__)
#define FUZZ_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define FUZZ_SANITIZED 1
#endif
#endif

#ifdef FUZZ_SANITIZED
#include <sanitizer/common_interface_defs.h>

extern "C" __attribute__ ((visibility ("default"))) const char*
__asan_default_options ()
{
  return ("max_allocation_size_mb=1024:hard_rss_limit_mb=4096:detect_leaks=1");
}

// It ends the program without the callback of AddressSanitizer, but an abort is noticed.
extern "C" __attribute__ ((visibility ("default"))) const char*
__ubsan_default_options ()
{
  return ("abort_on_error=1:print_stacktrace=1");
}
#endif

namespace fuzz {
namespace {

constexpr unsigned int max_seconds = 10; ///< for one input
#ifndef FUZZ_SANITIZED
constexpr std::size_t max_growth = std::size_t{1} << 30; ///< bytes of address space
#endif

/** \brief What a handler of signals needs; it can be given nothing else. */
struct
{
  std::array<char, 64> program;
  const char* data = nullptr;
  std::size_t size = 0;
  std::array<char, 256> name;
  bool active = false;
} watched;

void
print (const char* text)
{
  if (write (STDERR_FILENO, text, std::strlen (text)) < 0)
    return;
}

/** \brief Only what a handler of signals may do. */
void
report (const char* reason)
{
  if (!watched.active)
    return;
  watched.active = false;
  print ("\n");
  print (watched.program.data ());
  print (": ");
  print (reason);
  if (watched.name[0] != '\0')
  {
    const int file = open (watched.name.data (), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (file < 0 || write (file, watched.data, watched.size) != static_cast<ssize_t> (watched.size))
      print ("; the input cannot be saved to ");
    else
      print ("; the input is saved, reproduce by: ");
    print (watched.program.data ());
    print (" ");
    print (watched.name.data ());
    close (file);
  }
  print ("\n");
}

extern "C" void
onCrash (int signal)
{
  report (signal == SIGALRM ? "no end after 10 seconds" : "crash");
  if (signal == SIGALRM)
    _exit (1);
  std::signal (signal, SIG_DFL);
  raise (signal);
}

#ifdef FUZZ_SANITIZED
void
onSanitizerError ()
{
  report ("error found by a sanitizer");
}
#else
/** \brief Limits the address space to what is used already and max_growth. */
void
limitMemory ()
{
  std::size_t pages = 0;
  std::ifstream ("/proc/self/statm") >> pages;
  const rlim_t limit = pages * static_cast<std::size_t> (sysconf (_SC_PAGESIZE)) + max_growth;
  const rlimit limits = {limit, limit};
  setrlimit (RLIMIT_AS, &limits);
}
#endif

void
handle (int signal)
{
  struct sigaction action = {};
  action.sa_handler = onCrash;
  action.sa_flags = SA_ONSTACK; // the stack may be what is used up
  sigemptyset (&action.sa_mask);
  sigaction (signal, &action, nullptr);
}

} // namespace

void
startWatching (const std::string& program)
{
  std::snprintf (watched.program.data (), watched.program.size (), "%s", program.c_str ());
  static std::array<char, 1 << 16> stack;
  stack_t alternative = {};
  alternative.ss_sp = stack.data ();
  alternative.ss_size = stack.size ();
  sigaltstack (&alternative, nullptr);
  handle (SIGALRM);
  handle (SIGABRT);
#ifdef FUZZ_SANITIZED
  __sanitizer_set_death_callback (onSanitizerError); // it has its own handlers for the other signals
#else
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL})
    handle (signal);
  limitMemory ();
#endif
}

void
watchBegin (const std::string& input, const std::string& name)
{
  watched.data = input.data ();
  watched.size = input.size ();
  std::snprintf (watched.name.data (), watched.name.size (), "%s", name.c_str ());
  watched.active = true;
  alarm (max_seconds);
}

void
watchEnd ()
{
  alarm (0);
  watched.active = false;
}

} // namespace fuzz
