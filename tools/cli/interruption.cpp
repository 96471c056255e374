// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "interruption.h"

#include <csignal>

namespace {

volatile std::sig_atomic_t signal_received = 0;

extern "C" void
rememberSignal (int)
{
  signal_received = 1;
}

} // namespace

void
catchInterruptions ()
{
  struct sigaction action = {};
  action.sa_handler = rememberSignal;
  action.sa_flags = SA_RESTART | static_cast<int> (SA_RESETHAND);
  sigemptyset (&action.sa_mask);
  sigaction (SIGINT, &action, nullptr);
  sigaction (SIGTERM, &action, nullptr);
  std::signal (SIGXFSZ, SIG_IGN); // writing fails instead, as on a full disk
}

bool
interrupted ()
{
  return (signal_received != 0);
}
