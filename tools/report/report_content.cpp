// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "report_content.h"

#include <pcl/cosection/visualization/scene_picture.h>

#include <filesystem>

using namespace pcl::cosection;

std::string
nameOf (const RunObject& object, const ReportContent& content)
{
  if (content.truth)
    if (const ObjectEvaluation* evaluation = evaluationOf (content.truth->evaluation, object.id))
      return (evaluation->truth_name);
  const std::string name = textIn (object.summary, "class");
  const bool is_number = name.find_first_not_of ("0123456789") == std::string::npos; // of a class without a name
  return ((is_number ? "object" : name) + " " + std::to_string (object.id));
}

Eigen::Vector3d
upOf (const ReportContent& content)
{
  return (content.run.camera.empty () ? Eigen::Vector3d (Eigen::Vector3d::UnitZ ()) : upDirection (content.scene));
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
counted (std::size_t count, const std::string& what)
{
  return (std::to_string (count) + ' ' + what + (count == 1 ? "" : "s"));
}
