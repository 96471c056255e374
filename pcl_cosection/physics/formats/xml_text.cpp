// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "xml_text.h"

namespace pcl::cosection {
namespace {

std::string
escaped (const std::string& text)
{
  std::string result;
  for (const char c : text)
    switch (c)
    {
    case '&':
      result += "&amp;";
      break;
    case '<':
      result += "&lt;";
      break;
    case '>':
      result += "&gt;";
      break;
    case '"':
      result += "&quot;";
      break;
    default:
      result += static_cast<unsigned char> (c) < ' ' ? ' ' : c; // XML 1.0 has no place for most control characters
    }
  return result;
}

} // namespace

void
XmlText::begin (const std::string& tag, const Attributes& attributes)
{
  text_.append (2 * open_tags_.size (), ' ');
  text_ += '<' + tag;
  for (const auto& [name, value] : attributes)
    text_ += ' ' + name + "=\"" + escaped (value) + '"';
}

void
XmlText::open (const std::string& tag, const Attributes& attributes)
{
  begin (tag, attributes);
  text_ += ">\n";
  open_tags_.push_back (tag);
}

void
XmlText::close ()
{
  const std::string tag = open_tags_.back ();
  open_tags_.pop_back ();
  text_.append (2 * open_tags_.size (), ' ');
  text_ += "</" + tag + ">\n";
}

void
XmlText::add (const std::string& tag, const Attributes& attributes)
{
  begin (tag, attributes);
  text_ += "/>\n";
}

void
XmlText::add (const std::string& tag, const std::string& text, const Attributes& attributes)
{
  begin (tag, attributes);
  text_ += '>' + escaped (text) + "</" + tag + ">\n";
}

void
XmlText::addComment (const std::string& text)
{
  text_.append (2 * open_tags_.size (), ' ');
  text_ += "<!-- " + escaped (text) + " -->\n";
}

} // namespace pcl::cosection
