// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "python_text.h"

#include <pcl/cosection/surface/co_section.h>

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

/** \brief A mesh of a result, which lives as long as the result does. */
template <typename Result>
std::shared_ptr<pcl::cosection::TriangleMesh>
part (const std::shared_ptr<Result>& result, pcl::cosection::TriangleMesh& mesh)
{
  return {result, &mesh};
}

/** \brief A mesh of a result as part () gives it; None of an empty one. */
template <typename Result>
pybind11::object
partOrNone (const std::shared_ptr<Result>& result, pcl::cosection::TriangleMesh& mesh)
{
  return mesh.empty () ? pybind11::object (pybind11::none ()) : pybind11::cast (part (result, mesh));
}

/** \brief What Python makes an Object of. */
template <typename Result>
pybind11::dict
objectDict (const std::shared_ptr<Result>& result, pcl::cosection::ObjectResult& object)
{
  pybind11::dict dict;
  dict["id"] = object.id;
  dict["error"] = object.error;
  dict["mesh"] = part (result, object.mesh);
  dict["hull"] = partOrNone (result, object.hull);
  dict["inner_bound"] = partOrNone (result, object.inner_bound);
  dict["outer_bound"] = partOrNone (result, object.outer_bound);
  dict["sdf"] = object.signed_distance;
  dict["contradicted_share"] = object.contradicted_share;
  dict["penetration_m"] = object.penetration_m;
  dict["outlier_points"] = object.outlier_points;
  return dict;
}

/** \brief Lines with options as Python has them. */
inline std::vector<std::string>
inPython (std::vector<std::string> lines)
{
  for (std::string& line : lines)
    line = inPython (line);
  return lines;
}

/** \brief The settings of a program for some options and paths. \param[in] parse its command line \throws UsageError */
template <typename Parse>
auto
settingsOf (Parse parse, const std::vector<std::string>& options, const std::vector<std::string>& paths)
{
  std::vector<const char*> argv = {"pcl_cosection"};
  for (const std::string& option : options)
    argv.push_back (option.c_str ());
  argv.push_back ("--"); // what follows are no options
  for (const std::string& path : paths)
    argv.push_back (path.c_str ());
  return parse (static_cast<int> (argv.size ()), argv.data ()).value ();
}
