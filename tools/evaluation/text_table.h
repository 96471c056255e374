// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

/** \brief A table in columns: the first one flush left, the others flush right. */
class TextTable
{
public:
  explicit TextTable (std::vector<std::string> header);

  void add (std::vector<std::string> row);

  std::vector<std::string> lines () const;

private:
  std::vector<std::vector<std::string>> rows_;
};

/** \brief Metres as millimetres, with three digits: "4.12". */
std::string inMillimetres (double metres);

/** \brief Cubic metres as millilitres. */
std::string inMillilitres (double cubic_metres);

/** \brief "12.3 %" */
std::string inPercent (double share);

/** \brief With \a digits significant digits. */
std::string toText (double value, int digits = 3);

/** \brief A stamp or a parameter, without zeros at its end: "0.01", "99", "1305031102.175". */
std::string toShortText (double value);

/** \brief For CSV files: as many digits as a number has. */
std::string toField (double value);
