// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "numbered_files.h"

#include "pcl_cosection/common/number_text.h"
#include "pcl_cosection/io/lower_case.h"
#include "pcl_cosection/io/text_scanner.h"
#include "stamp_matching.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <system_error>
#include <tuple>

namespace fs = std::filesystem;

namespace pcl::cosection {
namespace {

const char* const letters = "abcdefghijklmnopqrstuvwxyz";

bool
isDigit (char c)
{
  return c >= '0' && c <= '9';
}

/** \brief The name without the longest ending that it has; nothing if it has no such ending. */
std::optional<std::string>
withoutEnding (const std::string& name, const std::vector<std::string>& endings)
{
  std::size_t longest = 0;
  for (const std::string& ending : endings)
    if (name.size () >= ending.size () && name.compare (name.size () - ending.size (), ending.size (), ending) == 0)
      longest = std::max (longest, ending.size ());
  if (longest == 0)
    return std::nullopt;
  return name.substr (0, name.size () - longest);
}

/** \brief Where the number at the end of a text begins: digits, or digits, a point and digits. */
std::size_t
numberBegin (const std::string& text)
{
  const auto digitsBegin = [&text] (std::size_t end) {
    while (end > 0 && isDigit (text[end - 1]))
      --end;
    return end;
  };
  const std::size_t begin = digitsBegin (text.size ());
  if (begin < 2 || begin == text.size () || text[begin - 1] != '.' || !isDigit (text[begin - 2]))
    return begin;
  return digitsBegin (begin - 1);
}

/** \brief Take a word, and what joins it with a number, off the end. \return both */
std::string
takeWord (std::string& stem)
{
  const std::string all = stem;
  stem.erase (stem.find_last_not_of (letters) + 1);
  stem.erase (stem.find_last_not_of ("_-.") + 1);
  return all.substr (stem.size ());
}

/** \brief The names of what is in a folder and wanted, sorted, without hidden ones. \throws IoError */
template <typename IsWanted>
std::vector<std::string>
namesIn (const std::string& folder, IsWanted&& isWanted)
{
  std::error_code failure;
  const fs::file_status status = fs::status (folder, failure);
  if (status.type () == fs::file_type::not_found)
    throw IoError (folder + ": there is no such folder");
  if (fs::exists (status) && !fs::is_directory (status))
    throw IoError (folder + ": is a file; it should be a folder");
  std::vector<std::string> names;
  fs::directory_iterator entry (folder, failure);
  for (; !failure && entry != fs::directory_iterator (); entry.increment (failure))
  {
    std::error_code ignored;
    const std::string name = entry->path ().filename ().string ();
    if (name[0] != '.' && isWanted (*entry, ignored))
      names.push_back (name);
  }
  if (failure)
    throw IoError (folder + ": cannot be listed: " + failure.message ());
  std::sort (names.begin (), names.end ());
  return names;
}

} // namespace

std::vector<std::string>
fileNames (const std::string& folder)
{
  return namesIn (folder, [] (const fs::directory_entry& entry, std::error_code& ignored) {
    return entry.is_regular_file (ignored);
  });
}

std::string
contentsOf (const std::string& folder)
{
  std::string text;
  const auto add = [&text] (const std::string& before, const std::string& kind, const std::vector<std::string>& names) {
    text += (text.empty () ? "holds " : " and ") + std::to_string (names.size ()) + " " + before + kind +
            (names.size () == 1 ? " (" + names.front () + ")" : "s (" + names.front () + " ...)");
  };
  std::map<std::string, std::vector<std::string>> by_extension;
  for (const std::string& name : fileNames (folder))
    by_extension[lowerCaseExtension (name)].push_back (name);
  for (const auto& [extension, names] : by_extension)
    add (extension.empty () ? "other " : extension + " ", "file", names);
  const std::vector<std::string> folders = namesIn (
      folder, [] (const fs::directory_entry& entry, std::error_code& ignored) { return entry.is_directory (ignored); });
  if (!folders.empty ())
    add ("", "folder", folders);
  return text.empty () ? "is empty" : text;
}

std::vector<NumberedFile>
numberedFiles (const std::string& folder, const std::vector<std::string>& names, const NumberedNames& series,
               std::vector<std::string>& warnings)
{
  std::vector<NumberedFile> files;
  std::vector<std::string> too_large, without_number;
  std::set<std::string> words;
  for (const std::string& name : names)
  {
    std::optional<std::string> stem = withoutEnding (lowerCase (name), series.endings);
    if (!stem)
      continue;
    if (series.word_behind)
      words.insert (takeWord (*stem));
    const std::size_t begin = numberBegin (*stem);
    const bool is_any = series.beginnings.empty ();
    if (!is_any && std::find (series.beginnings.begin (), series.beginnings.end (), stem->substr (0, begin)) ==
                       series.beginnings.end ())
      continue;
    const std::string path = (fs::path (folder) / name).string ();
    if (begin == stem->size ())
      without_number.push_back (path);
    else if (const auto number = stampOf (toReal (std::string_view (*stem).substr (begin))))
      files.push_back ({*number, path});
    else
      too_large.push_back (path);
  }
  if (words.size () > 1)
    return {};
  std::stable_sort (files.begin (), files.end (),
                    [] (const NumberedFile& a, const NumberedFile& b) { return a.number < b.number; });
  std::vector<std::string> again;
  std::vector<NumberedFile> unique;
  for (NumberedFile& file : files)
    if (!unique.empty () && unique.back ().number == file.number)
      again.push_back (file.path);
    else
      unique.push_back (std::move (file));
  if (!without_number.empty ())
    warnings.push_back (firstAndMore (without_number) + ": left out; a name must end in a number");
  if (!too_large.empty ())
    warnings.push_back (firstAndMore (too_large) +
                        ": left out; the number in the name has more than 15 digits, and is no time in micro- or "
                        "nanoseconds");
  if (!again.empty ())
    warnings.push_back (firstAndMore (again) + ": left out; another file has the same number");
  return unique;
}

std::set<std::string>
beginningsOf (const std::vector<std::string>& names, const std::vector<std::string>& endings)
{
  std::set<std::string> beginnings;
  for (const std::string& name : names)
    if (const auto stem = withoutEnding (lowerCase (name), endings); stem && numberBegin (*stem) < stem->size ())
      beginnings.insert (stem->substr (0, numberBegin (*stem)));
  return beginnings;
}

std::optional<double>
numberAtEnd (const std::string& text)
{
  const std::size_t begin = numberBegin (text);
  return begin == text.size () ? std::nullopt : stampOf (toReal (std::string_view (text).substr (begin)));
}

std::vector<NumberedFile>
numberedImages (const std::string& folder, const NumberedNames& usual, std::vector<std::string>& warnings)
{
  const std::vector<std::string> names = fileNames (folder);
  std::vector<NumberedFile> files;
  std::vector<std::string> of_series;
  for (const NumberedNames& series : {usual, NumberedNames{{}, usual.endings}, NumberedNames{{}, usual.endings, true}})
    if (files.empty ())
    {
      of_series.clear ();
      files = numberedFiles (folder, names, series, of_series);
    }
  warnings.insert (warnings.end (), of_series.begin (), of_series.end ());
  return files;
}

std::vector<PairedFile>
pairedFiles (const std::string& folder, const std::vector<std::string>& names, const std::vector<std::string>& endings)
{
  std::vector<PairedFile> files;
  for (const std::string& name : names)
  {
    const std::optional<std::string> stem = withoutEnding (lowerCase (name), endings);
    const std::size_t second = stem ? numberBegin (*stem) : 0;
    if (second == 0 || second == stem->size ())
      continue;
    const std::size_t joint = stem->find_last_not_of (letters, second - 1);
    if (joint == stem->npos || joint == 0 || ((*stem)[joint] != '_' && (*stem)[joint] != '-'))
      continue;
    const std::string before = stem->substr (0, joint);
    const std::size_t first = numberBegin (before);
    if (first == before.size ())
      continue;
    const auto a = stampOf (toReal (std::string_view (before).substr (first)));
    const auto b = stampOf (toReal (std::string_view (*stem).substr (second)));
    if (a && b)
      files.push_back ({*a, *b, (fs::path (folder) / name).string (),
                        (*stem)[second] == '0' && stem->size () - second > before.size () - first});
  }
  std::stable_sort (files.begin (), files.end (), [] (const PairedFile& x, const PairedFile& y) {
    return std::tie (x.first, x.second) < std::tie (y.first, y.second);
  });
  return files;
}

} // namespace pcl::cosection
