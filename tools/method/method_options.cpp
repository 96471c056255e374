// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "method_options.h"

#include "option_values.h"

#include <pcl/cosection/common/image.h>

#include <algorithm>
#include <cmath>

using namespace pcl::cosection;

void
declareVolumeOptions (CLI::App& app, GivenMethod& given, const std::string& background_default)
{
  const std::string group = "Volume";
  app.add_option ("--voxel-size", given.voxel_size, "Edge of an object's voxels")
      ->option_text ("METRES")
      ->check (numberRange (0, unlimited, true))
      ->group (group);
  app.add_option ("--resolution", given.resolution,
                  "Voxels along an object's longest observed side (default: 64, fewer where points are sparse)")
      ->option_text ("N")
      ->check (wholeRange (4, 2048))
      ->group (group);
  app.add_option ("--padding", given.padding,
                  "Volume beyond the observed box on each side, as a fraction of its longest side "
                  "(default: 0, as far as the shape may extend)")
      ->option_text ("FRACTION")
      ->check (numberRange (0, 10))
      ->group (group);
  app.add_option ("--background-voxel-size", given.background_voxel_size,
                  "Edge of the background's voxels (default: " + background_default + ")")
      ->option_text ("METRES")
      ->check (numberRange (0, unlimited, true))
      ->group (group);
  app.add_option ("--max-memory", given.max_memory,
                  "Refuse clouds and volumes that need more, for example 500M or 2G (default: this machine's memory)")
      ->option_text ("BYTES")
      ->group (group);
}

void
declareMethodOptions (CLI::App& app, GivenMethod& given)
{
  const CoSectionOptions defaults;
  const std::string group = "Method";
  app.add_option ("--preset", given.preset, "The parameters of the publication; other options override it")
      ->option_text ("paper")
      ->check (oneOf ({"paper"}))
      ->group (group);
  app.add_option ("--constraints", given.constraints,
                  "What bounds hidden surfaces: seen free space (hull), other bodies (intersection)" +
                      byDefault ("all"))
      ->option_text ("none|hull|intersection|all")
      ->check (oneOf ({"none", "hull", "intersection", "all"}))
      ->group (group);
  app.add_option ("--alpha", given.alpha, "Weight of smoothness, relative to the voxel" + byDefault (defaults.alpha))
      ->option_text ("WEIGHT")
      ->check (numberRange (0, unlimited, true))
      ->group (group);
  app.add_option ("--beta-hull", given.beta_hull, "Weight of seen free space" + byDefault (defaults.beta_hull))
      ->option_text ("WEIGHT")
      ->check (numberRange (0, unlimited))
      ->group (group);
  app.add_option ("--beta-inter", given.beta_inter, "Weight of other bodies" + byDefault (defaults.beta_inter))
      ->option_text ("WEIGHT")
      ->check (numberRange (0, unlimited))
      ->group (group);
  app.add_option ("--sigma", given.sigma, "Width of a point's influence" + byDefault (defaults.sigma_vox))
      ->option_text ("VOXELS")
      ->check (numberRange (0, 10, true))
      ->group (group);
  app.add_option ("--weighting", given.weighting, "How points near a voxel are combined" + byDefault ("mean"))
      ->option_text ("mean|sum")
      ->check (oneOf ({"mean", "sum"}))
      ->group (group);
  app.add_option ("--solver", given.solver, "How the minimum is found" + byDefault ("multigrid"))
      ->option_text ("multigrid|fast-jacobi")
      ->check (oneOf ({"multigrid", "fast-jacobi"}))
      ->group (group);
  app.add_option ("--max-iterations", given.max_iterations,
                  "Most iterations on each level" + byDefault (defaults.solver.max_iterations))
      ->option_text ("N")
      ->check (wholeRange (1, 10000000))
      ->group (group);
  app.add_option ("--tolerance", given.tolerance,
                  "Stop when the surface is this near to the solution" + byDefault (defaults.solver.tolerance_vox))
      ->option_text ("VOXELS")
      ->check (numberRange (0, unlimited, true))
      ->group (group);
}

void
preferCommandLine (const std::vector<std::string>& arguments, GivenMethod& given)
{
  const auto isGiven = [&] (const std::string& name) {
    return (std::any_of (arguments.begin (), arguments.end (), [&name] (const std::string& argument) {
      return (argument.substr (0, argument.find ('=')) == name);
    }));
  };
  const bool voxel_size = isGiven ("--voxel-size"), resolution = isGiven ("--resolution");
  if (voxel_size && !resolution)
    given.resolution.reset ();
  if (resolution && !voxel_size)
    given.voxel_size.reset ();
}

CoSectionOptions
methodOptions (const GivenMethod& given)
{
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
  override (options.threads, given.threads);
  options.solver.threads = options.threads;
  if (!given.constraints.empty ())
  {
    options.use_hull = given.constraints == "hull" || given.constraints == "all";
    options.use_intersection = given.constraints == "intersection" || given.constraints == "all";
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

std::map<int, std::string>
parseObjectFiles (const std::string& option, const std::vector<std::string>& values)
{
  std::map<int, std::string> files;
  for (const std::string& value : values)
  {
    const std::size_t equals = value.find ('=');
    const std::optional<double> id = parseNumber (value.substr (0, equals));
    if (equals == std::string::npos || equals + 1 == value.size () || !id || !(*id >= 1.0 && *id <= 2147483647.0) ||
        *id != std::floor (*id))
      throw UsageError (option + " must be ID=FILE with the number of an object, such as 2=cup.txt; it is \"" + value +
                        "\"");
    if (*id == ignored_label)
      throw UsageError (option + " " + value + ": label " + std::to_string (ignored_label) +
                        " marks what is no object; number it otherwise");
    if (!files.emplace (static_cast<int> (*id), value.substr (equals + 1)).second)
      throw UsageError (option + " is given twice for object " + value.substr (0, equals));
  }
  return (files);
}
