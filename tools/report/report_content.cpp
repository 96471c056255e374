// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "report_content.h"

#include <array>
#include <filesystem>

using namespace pcl::cosection;

namespace
{

/** \brief Of objects, by their place; report.css has the same as s1 to s8. */
constexpr std::array<TriangleMesh::Colour, 8> object_colours = {
    {{214, 96, 77}, {62, 126, 199}, {226, 164, 45}, {76, 158, 108}, {150, 104, 189}, {70, 171, 186}, {204, 104, 154}, {140, 112, 86}}};

} // namespace

std::string
nameOf (const RunObject& object, const ReportContent& content)
{
  if (content.truth)
    if (const ObjectEvaluation* evaluation = evaluationOf (content.truth->evaluation, object.id))
      return (evaluation->truth_name);
  return ("object " + std::to_string (object.id));
}

std::string
lastPartOf (const std::string& path)
{
  std::filesystem::path part = std::filesystem::path (path).lexically_normal ();
  if (!part.has_filename ())
    part = part.parent_path ();
  if (part.filename () == "." || part.filename () == "..")
  {
    std::error_code failure;
    part = std::filesystem::weakly_canonical (part, failure);
  }
  return (part.filename ().empty () ? path : part.filename ().string ());
}

std::string
titleOf (const ReportContent& content)
{
  const std::string dataset = textIn (member (content.run.summary, "parameters"), "dataset");
  return (lastPartOf (dataset.empty () ? content.run.path : dataset));
}

std::string
styleOf (std::size_t place)
{
  return ("s" + std::to_string (place % object_colours.size () + 1));
}

TriangleMesh::Colour
colourOf (std::size_t place)
{
  return (object_colours[place % object_colours.size ()]);
}

std::string
counted (std::size_t count, const std::string& what)
{
  return (std::to_string (count) + ' ' + what + (count == 1 ? "" : "s"));
}
