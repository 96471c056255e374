// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "html_writer.h"

#include <nlohmann/json.hpp>

#include <stdexcept>

namespace
{

/** \brief Bytes that are not UTF-8 become U+FFFD. */
std::string
asUtf8 (const std::string& text)
{
  using Json = nlohmann::json;
  return (Json::parse (Json (text).dump (-1, ' ', false, Json::error_handler_t::replace)).get<std::string> ());
}

} // namespace

std::string
escapeHtml (const std::string& text)
{
  std::string html;
  for (const char c : asUtf8 (text))
    switch (c)
    {
    case '&':
      html += "&amp;";
      break;
    case '<':
      html += "&lt;";
      break;
    case '>':
      html += "&gt;";
      break;
    case '"':
      html += "&quot;";
      break;
    case '\'':
      html += "&#39;";
      break;
    case '\0':
      html += "\xEF\xBF\xBD";
      break;
    default:
      html += c;
    }
  return (html);
}

void
HtmlWriter::begin (const std::string& name, const Attributes& attributes)
{
  html_ += '<' + name;
  for (const auto& [attribute, value] : attributes)
    html_ += ' ' + attribute + (value.empty () ? "" : "=\"" + escapeHtml (value) + '"');
  html_ += '>';
}

HtmlWriter&
HtmlWriter::open (const std::string& name, const Attributes& attributes)
{
  begin (name, attributes);
  open_.push_back (name);
  return (*this);
}

HtmlWriter&
HtmlWriter::close (const std::string& name)
{
  if (open_.empty () || open_.back () != name)
    throw std::logic_error ("the element to close is " + (open_.empty () ? "none" : open_.back ()) + ", not " + name);
  open_.pop_back ();
  html_ += "</" + name + ">\n";
  return (*this);
}

HtmlWriter&
HtmlWriter::text (const std::string& text)
{
  html_ += escapeHtml (text);
  return (*this);
}

HtmlWriter&
HtmlWriter::element (const std::string& name, const std::string& words, const Attributes& attributes)
{
  return (open (name, attributes).text (words).close (name));
}

HtmlWriter&
HtmlWriter::single (const std::string& name, const Attributes& attributes)
{
  begin (name, attributes);
  html_ += '\n';
  return (*this);
}

HtmlWriter&
HtmlWriter::markup (std::string_view html)
{
  html_ += html;
  return (*this);
}

const std::string&
HtmlWriter::html () const
{
  if (!open_.empty ())
    throw std::logic_error ("the element " + open_.back () + " is not closed");
  return (html_);
}
