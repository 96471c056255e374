// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "method_options.h"

#include "option_values.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/image.h>

#include <algorithm>
#include <cmath>

using namespace pcl::cosection;

void
declareVolumeOptions (CLI::App& app, GivenMethod& given, const std::string& background_default)
{
  OptionGroup volume (app, "Volume");
  volume.add ("--voxel-size METRES", given.voxel_size, positiveNumber (), "Edge of an object's voxels");
  volume.add ("--resolution N", given.resolution, wholeRange (4, 2048),
              "Voxels along an object's longest observed side (default: 64, fewer where points are sparse, "
              "up to 96 where it is thin)");
  volume.add ("--padding FRACTION", given.padding, numberRange (0, 10),
              "Volume beyond the observed box on each side, as a fraction of its longest side (default: 0, as far as "
              "the shape may extend)");
  volume.add ("--background-voxel-size METRES", given.background_voxel_size, positiveNumber (),
              "Edge of the background's voxels (default: " + background_default + ")");
  volume.add ("--max-memory BYTES", given.max_memory,
              "Refuse clouds and volumes that need more, for example 500M or 2G (default: this machine's memory)");
}

void
declareMethodOptions (CLI::App& app, GivenMethod& given)
{
  const CoSectionOptions defaults;
  OptionGroup method (app, "Method");
  method.add ("--preset paper", given.preset, oneOf ({"paper"}),
              "The parameters of the publication; other options override it");
  method.add ("--constraints none|hull|intersection|all", given.constraints,
              "What bounds hidden surfaces: seen free space (hull), other bodies (intersection)" + byDefault ("all"));
  method.add (
      "--priors LIST", given.priors,
      "What is expected of hidden surfaces that nothing bounds: names separated by commas, of extent, symmetry, "
      "revolution, vessels, extrusion, plane, rays, learned, proposals; or none" +
          byDefault ("all"));
  method.add ("--alpha WEIGHT", given.alpha, positiveNumber (),
              "Weight of smoothness, relative to the voxel" + byDefault (defaults.alpha));
  method.add ("--beta-hull WEIGHT", given.beta_hull, numberRange (0, unlimited),
              "Weight of seen free space" + byDefault (defaults.beta_hull));
  method.add ("--beta-inter WEIGHT", given.beta_inter, numberRange (0, unlimited),
              "Weight of other bodies" + byDefault (defaults.beta_inter));
  method.add ("--sigma VOXELS", given.sigma, numberRange (0, 10, true),
              "Width of a point's influence" + byDefault (defaults.sigma_vox));
  method.add ("--weighting mean|sum", given.weighting, "How points near a voxel are combined" + byDefault ("mean"));
  method.add ("--solver multigrid|fast-jacobi", given.solver, "How the minimum is found" + byDefault ("multigrid"));
  method.add ("--max-iterations N", given.max_iterations, wholeRange (1, 10000000),
              "Most iterations on each level" + byDefault (defaults.solver.max_iterations));
  method.add ("--tolerance VOXELS", given.tolerance, positiveNumber (),
              "Stop when the surface is this near to the solution" + byDefault (defaults.solver.tolerance_vox));
}

namespace {

/** \brief The priors of all lists. */
Priors
namedPriors (const std::vector<std::string>& lists)
try
{
  std::string names;
  for (const std::string& list : lists)
    names += (names.empty () ? "" : ",") + list;
  return (Priors::named (names));
}
catch (const InvalidArgument& error)
{
  throw UsageError (std::string ("--priors: ") + error.what ());
}

} // namespace

CoSectionOptions
methodOptions (GivenMethod given)
{
  const auto isGiven = [&] (const std::string& name) {
    return (std::any_of (given.arguments.begin (), given.arguments.end (), [&name] (const std::string& argument) {
      return (argument.substr (0, argument.find ('=')) == name);
    }));
  };
  const bool voxel_size = isGiven ("--voxel-size"), resolution = isGiven ("--resolution");
  if (voxel_size && !resolution)
    given.resolution.reset ();
  if (resolution && !voxel_size)
    given.voxel_size.reset ();
  if (given.voxel_size && given.resolution)
    throw UsageError ("--voxel-size and --resolution exclude each other");
  CoSectionOptions options = given.preset == "paper" ? CoSectionOptions::paper () : CoSectionOptions ();
  if (given.resolution)
    options.voxel_size_m = 0.0;
  override (options.voxel_size_m, given.voxel_size);
  override (options.resolution, given.resolution);
  override (options.padding, given.padding);
  override (options.background_voxel_size_m, given.background_voxel_size);
  override (options.alpha, given.alpha);
  override (options.beta_hull, given.beta_hull);
  override (options.beta_inter, given.beta_inter);
  override (options.sigma_vox, given.sigma);
  override (options.solver.max_iterations, given.max_iterations);
  override (options.solver.tolerance_vox, given.tolerance);
  options.threads = given.threads;
  options.solver.threads = given.threads;
  if (!given.constraints.empty ())
  {
    options.use_hull = given.constraints == "hull" || given.constraints == "all";
    options.use_intersection = given.constraints == "intersection" || given.constraints == "all";
  }
  if (!given.priors.empty ())
  {
    options.priors = namedPriors (given.priors);
    options.use_extent_prior = options.use_symmetric_extent = true; // the list decides
  }
  if (given.no_planes)
    options.use_planes = false;
  if (!given.weighting.empty ())
    options.weighting = given.weighting == "sum" ? Weighting::Sum : Weighting::Mean;
  if (!given.solver.empty ())
    options.solver.type = given.solver == "fast-jacobi" ? SolverType::FastJacobi : SolverType::Multigrid;
  options.max_memory_bytes = physicalMemory (); // rather than let the system end the program
  if (!given.max_memory.empty ())
  {
    const std::optional<std::size_t> size = parseSize (given.max_memory);
    if (!size)
      throw UsageError ("--max-memory: \"" + given.max_memory +
                        "\" is not valid, it must be a size such as 500M or 2G");
    options.max_memory_bytes = *size;
  }
  options.validate ();
  return (options);
}

std::string
constraintsOf (const CoSectionOptions& method)
{
  if (method.use_hull)
    return (method.use_intersection ? "all" : "hull");
  return (method.use_intersection ? "intersection" : "none");
}

std::pair<int, std::string>
parseObjectFile (const std::string& option, const std::string& value)
{
  const std::size_t equals = value.find ('=');
  const std::optional<double> id = parseNumber (value.substr (0, equals));
  if (equals == std::string::npos || equals + 1 == value.size () || !id || !(*id >= 1.0 && *id <= 2147483647.0) ||
      *id != std::floor (*id))
    throw UsageError (option + " must be ID=FILE with the number of an object; it is \"" + value + "\"");
  if (*id == ignored_label)
    throw UsageError (option + " " + value + ": label " + std::to_string (ignored_label) +
                      " marks what is no object; number it otherwise");
  return {static_cast<int> (*id), value.substr (equals + 1)};
}

std::map<int, std::string>
parseObjectFiles (const std::string& option, const std::vector<std::string>& values)
{
  std::map<int, std::string> files;
  for (const std::string& value : values)
    if (const auto [id, file] = parseObjectFile (option, value); !files.emplace (id, file).second)
      throw UsageError (option + " is given twice for object " + std::to_string (id));
  return (files);
}
