// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

/** \brief What all programs return. */
enum ExitStatus
{
  Success = 0,
  Failure = 1,
  WrongUsage = 2,
  Interrupted = 130,
};
