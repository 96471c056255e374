// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief Builds an XML document, indented, in which every element is closed and every text is escaped. */
class XmlText
{
public:
  using Attributes = std::vector<std::pair<std::string, std::string>>;

  /** \brief Begin an element that has children. */
  void open (const std::string& tag, const Attributes& attributes = {});
  /** \brief End the innermost open element. */
  void close ();
  /** \brief An element without children. */
  void add (const std::string& tag, const Attributes& attributes);
  /** \brief An element that holds a text. */
  void add (const std::string& tag, const std::string& text, const Attributes& attributes = {});
  /** \brief \a text must have no two hyphens side by side. */
  void addComment (const std::string& text);

  /** \brief The document so far. */
  const std::string& text () const { return text_; }

private:
  void begin (const std::string& tag, const Attributes& attributes);

  std::string text_ = "<?xml version=\"1.0\"?>\n";
  std::vector<std::string> open_tags_;
};

} // namespace pcl::cosection
