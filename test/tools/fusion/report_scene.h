// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "fusion_scene.h"

#include <nlohmann/json.hpp>

#include <string>

/** \brief A folder with the sequence sim and the run out of it, made once for all tests.
 * pcl_cosection_report runs in that folder. */
class ReportScene : public FusionScene
{
protected:
  static void SetUpTestSuite ();

  ReportScene ();

  /** \brief Make out_none, a run without constraints. */
  void makeOtherRun ();

  /** \brief Run the program. \return the exit status */
  int report (const Words& arguments, const std::function<void ()>& prepare = {});

  /** \brief It fails with one line that has \a part in it, and writes nothing. */
  void expectNoReport (const Words& arguments, int status, const std::string& part);

  /** \brief The page that it writes; fails unless the program succeeds. */
  std::string page (const Words& arguments);

  /** \brief What a browser without WebGL shows of that page, as HTML. */
  std::string shown (const Words& arguments);

  /** \brief The data that a page is made from. */
  static nlohmann::json data (const std::string& page);

  /** \brief What the cell of a table in \a page shows, without markup; "none" if there is no such cell.
   * \param[in] page as shown () gives it
   * \param[in] section the id of the part of the page
   * \param[in] row, column what is in the first cell, and the name of the column */
  static std::string cell (const std::string& page, const std::string& section, const std::string& row,
                           const std::string& column);
};
