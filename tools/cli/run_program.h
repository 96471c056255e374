// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terminal.h"

#include <exception>
#include <functional>
#include <string>

/** \brief What is to be said of an error. \param[in] out_of_memory of that one, which says nothing itself */
std::string describe (const std::exception& error, const std::string& out_of_memory = "out of memory");

/** \brief A program, and what it says when it ends early. */
struct Program
{
  std::string name;
  std::string interrupted = "interrupted";
  std::string out_of_memory = "out of memory"; ///< may say what would need less
};

/** \brief The main function of all programs: what \a work throws becomes one line and an exit status.
 * \param[in] work returns whether all went well; reads the command line first
 * \return Success, Failure, also if anything else is thrown, WrongUsage after a UsageError, Interrupted after
 * pcl::cosection::Cancelled */
int runProgram (const Program& program, const std::function<bool (Terminal&)>& work);
