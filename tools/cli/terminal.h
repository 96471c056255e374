// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

enum class Verbosity
{
  Quiet,  ///< errors only
  Normal, ///< results, warnings, and a progress bar on a terminal
  Verbose ///< each stage as well
};

/** \brief What the user sees: results on standard output, everything else on standard error. */
class Terminal
{
public:
  explicit Terminal (const std::string& program);
  ~Terminal () { clearBar (); }
  Terminal (const Terminal&) = delete;
  Terminal& operator= (const Terminal&) = delete;

  void setVerbosity (Verbosity verbosity) { verbosity_ = verbosity; }

  /** \brief One line on standard output; not if quiet. */
  void result (const std::string& line);

  /** \brief One line of detail; only if verbose. */
  void detail (const std::string& line);

  /** \brief One line; not if quiet. */
  void warning (const std::string& line);

  /** \brief One line, always. */
  void error (const std::string& line) { say ("error: ", line); }

  /** \brief Draw the progress bar, if standard error is a terminal; say each new stage if verbose. */
  void progress (const std::string& stage, double fraction);

private:
  void clearBar ();
  void say (const std::string& kind, const std::string& line);

  const std::string program_;
  Verbosity verbosity_ = Verbosity::Normal;
  const bool is_terminal_;
  std::string bar_, stage_;
};

/** \brief "1 frame", "2 frames". */
std::string counted (std::size_t count, const std::string& what);
