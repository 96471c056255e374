// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

/** \brief The text as HTML shows it: what would be markup is escaped, bytes that are not UTF-8 are replaced by U+FFFD.
 */
std::string escapeHtml (const std::string& text);

/** \brief Writes HTML whose elements are closed in order, and whose texts are no markup. */
class HtmlWriter
{
public:
  using Attributes = std::vector<std::pair<std::string, std::string>>;

  /** \brief Begin an element. A value is escaped; an attribute without one is the name alone. */
  HtmlWriter& open (const std::string& name, const Attributes& attributes = {});

  /** \brief End the innermost element. \throws std::logic_error if that is not \a name */
  HtmlWriter& close (const std::string& name);

  HtmlWriter& text (const std::string& text);

  /** \brief An element that has only text in it. */
  HtmlWriter& element (const std::string& name, const std::string& text, const Attributes& attributes = {});

  /** \brief An element without an end, as img. */
  HtmlWriter& single (const std::string& name, const Attributes& attributes = {});

  /** \brief HTML that is written by a program. */
  HtmlWriter& markup (std::string_view html);

  /** \brief All of it. \throws std::logic_error if an element is open */
  const std::string& html () const;

private:
  void begin (const std::string& name, const Attributes& attributes);

  std::string html_;
  std::vector<std::string> open_;
};
