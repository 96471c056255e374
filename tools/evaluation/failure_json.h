// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation_json.h"
#include "output_files.h"
#include "run_program.h"

#include <exception>
#include <string>

/** \brief Run \a work; if it throws, leave {"error": ...} in the file \a json, unless that is empty, and throw on. */
template <typename Work>
void
withFailureJson (const std::string& json, Work&& work)
{
  try
  {
    work ();
  }
  catch (const std::exception& error)
  {
    if (!json.empty ())
      try
      {
        saveJson (Json{{"error", describe (error)}}, json);
      }
      catch (const std::exception&)
      {
        // the error itself is reported
      }
    throw;
  }
}
