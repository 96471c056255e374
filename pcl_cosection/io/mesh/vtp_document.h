// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pcl::cosection
{

/** \brief A start tag of XML: what stands between < and >. Views of the file's bytes, as all here. */
struct XmlTag
{
  std::string_view text;

  std::string_view name () const;

  /** \brief The value of an attribute; empty if there is none of this \a key. */
  std::string_view attribute (std::string_view key) const;
};

/** \brief A DataArray element. */
struct VtpArray
{
  XmlTag tag;
  std::string_view content; ///< what follows the tag
};

/** \brief Elements of a piece that describe its surface. */
struct VtpPiece
{
  XmlTag tag;
  std::vector<VtpArray> points;
  std::vector<VtpArray> polys;
  std::vector<VtpArray> strips;
};

/** \brief The structure of a .vtp file; its arrays are not decoded. */
struct VtpDocument
{
  XmlTag file;
  std::vector<VtpPiece> pieces;
  XmlTag appended_tag;       ///< of no text if the file has no appended data
  std::string_view appended; ///< behind the underscore that it begins with
};

/** \brief \throws IoError, whose message is only the reason */
VtpDocument parseVtp (const std::string& bytes);

} // namespace pcl::cosection
