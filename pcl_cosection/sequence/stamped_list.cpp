// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "stamped_list.h"

#include "pcl_cosection/common/files.h"
#include "pcl_cosection/io/text_scanner.h"
#include "stamp_matching.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace pcl::cosection {
namespace {

double
parseStamp (std::string_view word)
{
  const std::optional<double> stamp = stampOf (toReal (word));
  if (!stamp)
    throw IoError (quoted (word) + " is not a time in seconds, micro- or nanoseconds");
  return *stamp;
}

} // namespace

std::vector<std::vector<StampedFile>>
readStampedList (const std::string& path, std::size_t columns)
{
  const std::string form = columns == 1 ? "'stamp file'" : "'stamp file stamp file'";
  const std::string bytes = readBytes (path);
  std::vector<std::vector<StampedFile>> rows;
  TextScanner scanner (bytes);
  for (std::size_t number = 1; !scanner.left ().empty (); ++number)
  {
    TextScanner line (scanner.line ());
    const std::string_view first = TextScanner (line).word ();
    if (first.empty () || first[0] == '#')
      continue;
    try
    {
      std::vector<StampedFile> row (columns);
      for (StampedFile& file : row)
      {
        file.stamp = parseStamp (line.word ());
        file.name = line.word ();
        if (file.name.empty ())
          throw IoError ("it ends where the name of a file should be");
        if (std::any_of (file.name.begin (), file.name.end (), [] (unsigned char c) { return c < ' ' || c == 127; }))
          throw IoError (quoted (std::string_view (file.name)) + " is not the name of a file");
      }
      const std::string_view more = line.word ();
      if (!more.empty ())
        throw IoError ("there is " + quoted (more) + " behind it");
      rows.push_back (std::move (row));
    }
    catch (const IoError& error)
    {
      throw IoError (path + ": line " + std::to_string (number) + " must be " + form + ", but " + error.what ());
    }
  }
  if (rows.empty ())
    throw IoError (path + ": is empty; its lines should be " + form);
  return rows;
}

} // namespace pcl::cosection
