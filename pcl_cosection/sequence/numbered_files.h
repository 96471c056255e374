// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief Which files of a folder belong to a series. Letters may be large or small. */
struct NumberedNames
{
  std::vector<std::string> beginnings; ///< what may be before the number; empty: anything
  std::vector<std::string> endings;    ///< what may be behind it, such as ".png"
  bool word_behind = false;            ///< a word is between, the same in all: 0003_depth.png
};

/** \brief A file with a number in its name. */
struct NumberedFile
{
  double number = 0.0;
  std::string path;
};

/** \brief A file with two numbers in its name: FRAME_INSTANCE. */
struct PairedFile
{
  double first = 0.0;
  double second = 0.0;
  std::string path;
  bool is_second_padded = false; ///< it has leading zeros and more digits than the first one
};

/** \brief The files of these endings whose names end in two numbers with _ or - between them, and maybe a word
 * behind that (0003_obj2), by ascending numbers; others are left out. */
std::vector<PairedFile> pairedFiles (const std::string& folder, const std::vector<std::string>& names,
                                     const std::vector<std::string>& endings);

/** \brief The names of the files in a folder, sorted, without hidden ones and folders. \throws IoError if it cannot be
 * listed */
std::vector<std::string> fileNames (const std::string& folder);

/** \brief What a folder holds, for messages: "holds 21 .jpg files (0000.jpg ...) and 1 folder (brick)"; hidden ones do
 * not count. \throws IoError if it cannot be listed */
std::string contentsOf (const std::string& folder);

/** \brief The files of a series, by ascending numbers, which may have a fraction (0.033333.png). Those without a
 * number, with one of more than 15 digits before the point (but for
 * 16 and 19, which are micro- and nanoseconds, and become seconds), or one that another file has too, are left out,
 * with a message in \a warnings.
 * \param[in] names of the files in \a folder, sorted */
std::vector<NumberedFile> numberedFiles (const std::string& folder, const std::vector<std::string>& names,
                                         const NumberedNames& series, std::vector<std::string>& warnings);

/** \brief What names of these endings have before their numbers, small letters; names without a number are left out. */
std::set<std::string> beginningsOf (const std::vector<std::string>& names, const std::vector<std::string>& endings);

/** \brief The number at the end of a text, as those of names; nothing if it does not end in one. */
std::optional<double> numberAtEnd (const std::string& text);

/** \brief The files of a folder whose names begin as is usual, or else of any that end in a number, or else in a number
 * and a word (0003_depth.png). */
std::vector<NumberedFile> numberedImages (const std::string& folder, const NumberedNames& usual,
                                          std::vector<std::string>& warnings);

} // namespace pcl::cosection
