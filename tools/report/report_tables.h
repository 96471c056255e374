// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "html_writer.h"
#include "report_content.h"

#include <optional>
#include <string>
#include <vector>

/** \brief A cell with the name of its column, which stands before it where the screen is narrow. */
struct TableCell
{
  std::string text;
  std::string after = {};  ///< markup behind the text
  std::string before = {}; ///< and before it
};

/** \brief A table whose rows become blocks on narrow screens. Begins each row with a header. */
class HtmlTable
{
public:
  HtmlTable (HtmlWriter& html, const std::string& caption, std::vector<std::string> header,
             const std::string& style = "cards");

  void row (const std::vector<TableCell>& cells);

  void end ();

private:
  HtmlWriter& html_;
  std::vector<std::string> header_;
};

/** \brief What an object is like: by summary.json, else by its mesh. */
struct ObjectFacts
{
  std::string volume_ml, closed, penetration_mm, frames, solver; ///< "–" where it is not known
  std::optional<bool> is_closed;
};

ObjectFacts factsOf (const RunObject& object);

/** \brief Shares of the surface by provenance, in its order; empty if they are not known. */
std::vector<double> provenanceShares (const RunObject& object);

/** \brief The table of all objects, those that failed too. */
void writeObjectTable (HtmlWriter& html, const ReportContent& content);

/** \brief All parameters of the run in rows. */
void writeParameters (HtmlWriter& html, const ReportContent& content);

/** \brief A list that is closed at first, if there is anything in it. */
void writeCollapsedList (HtmlWriter& html, const std::string& title, const std::vector<std::string>& lines);

/** \brief What is not known. */
extern const char* const dash;
