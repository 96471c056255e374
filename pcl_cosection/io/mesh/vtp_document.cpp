// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors

#include "vtp_document.h"
#include "pcl_cosection/io/text_scanner.h"

#include <pcl/cosection/common/error.h>

namespace pcl::cosection
{
namespace
{

constexpr const char* cut_off = "the VTK file ends too early";
constexpr std::string_view spaces = " \t\r\n";

/** \brief Takes tags from the beginning of a text, one after the other. */
class TagScanner
{
public:
  explicit TagScanner (std::string_view text) : left_ (text) {}

  /** \brief The next tag, without what is between tags, comments and declarations; of no text at the end. */
  XmlTag next ()
  {
    for (;;)
    {
      const std::size_t begin = left_.find ('<');
      if (begin == left_.npos)
        return {};
      left_.remove_prefix (begin + 1);
      if (left_.substr (0, 3) == "!--")
        skipTo ("-->");
      else if (left_.substr (0, 1) == "?" || left_.substr (0, 1) == "!")
        skipTo (">");
      else
        return {take ()};
    }
  }

  std::string_view left () const { return left_; }

private:
  void skipTo (std::string_view end)
  {
    const std::size_t at = left_.find (end);
    if (at == left_.npos)
      throw IoError (cut_off);
    left_.remove_prefix (at + end.size ());
  }

  std::string_view take ()
  {
    char quote = '\0';
    for (std::size_t n = 0; n < left_.size (); ++n)
    {
      const char c = left_[n];
      if (quote != '\0')
        quote = (c == quote ? '\0' : quote);
      else if (c == '"' || c == '\'')
        quote = c;
      else if (c == '>')
      {
        const std::string_view taken = left_.substr (0, n);
        left_.remove_prefix (n + 1);
        return taken;
      }
    }
    throw IoError (cut_off);
  }

  std::string_view left_;
};

std::vector<VtpArray>*
sectionOf (VtpPiece& piece, std::string_view name)
{
  if (name == "Points")
    return &piece.points;
  if (name == "Polys")
    return &piece.polys;
  return name == "Strips" ? &piece.strips : nullptr;
}

} // namespace

std::string_view
XmlTag::name () const
{
  return text.substr (0, text.find_first_of (" \t\r\n/", 1));
}

std::string_view
XmlTag::attribute (std::string_view key) const
{
  std::string_view left = text;
  left.remove_prefix (name ().size ());
  for (;;)
  {
    const std::size_t begin = left.find_first_not_of (spaces);
    const std::size_t equals = left.find ('=');
    if (begin == left.npos || equals == left.npos || equals < begin)
      return {};
    std::string_view found = left.substr (begin, equals - begin);
    found = found.substr (0, found.find_first_of (spaces));
    const std::size_t open = left.find_first_of ("\"'", equals);
    const std::size_t close = (open == left.npos ? left.npos : left.find (left[open], open + 1));
    if (close == left.npos)
      return {};
    if (found == key)
      return left.substr (open + 1, close - open - 1);
    left.remove_prefix (close + 1);
  }
}

VtpDocument
parseVtp (const std::string& bytes)
{
  VtpDocument document;
  TagScanner scanner (bytes);
  std::string_view section; // of the piece; empty: none that matters
  bool in_piece = false;
  for (XmlTag tag = scanner.next (); !tag.text.empty (); tag = scanner.next ())
  {
    const std::string_view name = tag.name ();
    const bool closed = tag.text.back () == '/';
    if (document.file.text.empty ())
    {
      if (name != "VTKFile")
        break;
      document.file = tag;
      if (tag.attribute ("type") != "PolyData")
        throw IoError ("the VTK file does not hold PolyData");
    }
    else if (name == "Piece" || name == "/Piece")
    {
      if (name == "Piece")
        document.pieces.push_back ({tag, {}, {}, {}});
      in_piece = name == "Piece" && !closed;
      section = {};
    }
    else if (in_piece && sectionOf (document.pieces.back (), name) != nullptr)
      section = closed ? std::string_view () : name;
    else if (name == "/Points" || name == "/Polys" || name == "/Strips")
      section = {};
    else if (name == "DataArray" && !section.empty ())
    {
      const std::string_view left = scanner.left ();
      sectionOf (document.pieces.back (), section)
          ->push_back ({tag, closed ? std::string_view () : left.substr (0, left.find ('<'))});
    }
    else if (name == "AppendedData" || name == "/VTKFile")
    {
      if (in_piece)
        break;
      if (name == "AppendedData")
      {
        document.appended_tag = tag;
        const std::string_view left = scanner.left ();
        const std::size_t underscore = left.find ('_');
        if (underscore == left.npos)
          break;
        document.appended = left.substr (underscore + 1);
      }
      return document;
    }
  }
  throw IoError (document.file.text.empty () ? "it has no VTKFile element" : cut_off);
}

} // namespace pcl::cosection
