// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "command_line.h"

#include "option_table.h"
#include "option_values.h"
#include "program_text.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>

using namespace pcl::cosection;

namespace
{

/** \brief What the command line says of the size of voxels replaces what the configuration file does. */
void
preferCommandLine (const std::vector<std::string>& arguments, Given& given)
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

template <typename Target, typename Value>
void
override (Target& target, const std::optional<Value>& value)
{
  if (value)
    target = *value;
}

CoSectionOptions
methodOptions (const Given& given)
{
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
  options.compute_hull = given.save_hull;
  options.compute_bounds = given.save_bounds;
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

std::map<int, std::string>
objectTrajectories (const Given& given)
{
  std::map<int, std::string> files;
  for (const std::string& value : given.object_trajectories)
  {
    const std::size_t equals = value.find ('=');
    const std::optional<double> id = parseNumber (value.substr (0, equals));
    if (equals == std::string::npos || equals + 1 == value.size () || !id || !(*id >= 1.0 && *id <= 2147483647.0) ||
        *id != std::floor (*id))
      throw UsageError ("--object-trajectory must be ID=FILE with the label of an object, such as 2=cup.txt; it is \"" +
                        value + "\"");
    if (!files.emplace (static_cast<int> (*id), value.substr (equals + 1)).second)
      throw UsageError ("--object-trajectory is given twice for object " + value.substr (0, equals));
  }
  return (files);
}

void
setPaths (const Given& given, Settings& settings)
{
  if (given.paths.empty ())
    throw UsageError ("INPUT.pcd and OUTPUT are missing; see --help");
  if (given.paths.size () == 1)
    throw UsageError ("OUTPUT is missing after " + given.paths[0] + "; see --help");
  settings.inputs.assign (given.paths.begin (), given.paths.end () - 1);
  settings.output = given.paths.back ();
  if (settings.output.empty ())
    throw UsageError ("OUTPUT is empty; it must be a folder, or a file ending in .ply, .stl or .obj");
  std::string extension = std::filesystem::path (settings.output).extension ().string ();
  std::transform (extension.begin (), extension.end (), extension.begin (),
                  [] (unsigned char c) { return (std::tolower (c)); });
  if (extension == ".pcd")
    throw UsageError ("OUTPUT is " + settings.output +
                      ", a point cloud; it must be a folder, or a file ending in .ply, .stl or .obj");
  constexpr std::array<const char*, 10> unwritten{".off", ".vtk", ".vtp", ".dae", ".glb", ".gltf",
                                                  ".fbx", ".3ds", ".3mf", ".wrl"};
  if (std::find (unwritten.begin (), unwritten.end (), extension) != unwritten.end ())
    throw UsageError ("OUTPUT is " + settings.output + ", a format that is not written; it must be a folder, or a file ending "
                      "in .ply, .stl or .obj");
  const std::string mesh = meshExtension (settings.output);
  if (!mesh.empty () && !given.format.empty () && given.format != mesh)
    throw UsageError ("--format " + given.format + " contradicts OUTPUT " + settings.output);
  settings.format = !mesh.empty () ? mesh : !given.format.empty () ? given.format : "ply";
}

Settings
toSettings (const Given& given)
{
  Settings settings;
  if (given.voxel_size && given.resolution)
    throw UsageError ("--voxel-size and --resolution exclude each other");
  if (given.quiet && given.verbose)
    throw UsageError ("--quiet and --verbose exclude each other");
  setPaths (given, settings);
  settings.json = given.json;
  settings.save_sdf = given.save_sdf;
  if (given.max_faces)
    settings.max_faces = static_cast<std::size_t> (*given.max_faces);
  settings.obstacles = given.obstacles;
  settings.object_trajectories = objectTrajectories (given);
  settings.verbosity = given.quiet ? Verbosity::Quiet : given.verbose ? Verbosity::Verbose : Verbosity::Normal;
  settings.preset = given.preset;
  settings.method = methodOptions (given);
  settings.constraints = settings.method.use_hull ? (settings.method.use_intersection ? "all" : "hull")
                                                  : (settings.method.use_intersection ? "intersection" : "none");
  if (!given.planes.empty ())
  {
    const auto planes = parseQuadruples (given.planes);
    if (!planes)
      throw UsageError ("--plane must be four numbers a,b,c,d");
    for (const auto& p : *planes)
    {
      settings.planes.emplace_back (p[0], p[1], p[2], p[3]);
      if (!(settings.planes.back ().head<3> ().norm () > 0.0))
        throw UsageError ("--plane has the normal 0,0,0; its first three numbers must not all be zero");
    }
  }
  settings.reading.world_points = given.world_points;
  settings.reading.threads = settings.method.threads;
  settings.reading.max_memory_bytes = settings.method.max_memory_bytes;
  override (settings.reading.scale, given.scale);
  if (!given.intrinsics.empty ())
  {
    const auto intrinsics = parseQuadruples (given.intrinsics);
    if (!intrinsics || intrinsics->size () != 1 || !((*intrinsics)[0][0] > 0.0) || !((*intrinsics)[0][1] > 0.0))
      throw UsageError ("--intrinsics must be four numbers fx,fy,cx,cy with positive fx and fy");
    settings.reading.intrinsics = (*intrinsics)[0];
  }
  return (settings);
}

} // namespace

std::string
meshExtension (const std::string& path)
{
  std::string extension = std::filesystem::path (path).extension ().string ();
  std::transform (extension.begin (), extension.end (), extension.begin (),
                  [] (unsigned char c) { return (std::tolower (c)); });
  const bool known = extension == ".ply" || extension == ".stl" || extension == ".obj";
  return (known ? extension.substr (1) : "");
}

std::optional<Settings>
parseCommandLine (int argc, const char* const* argv)
{
  Given given;
  CLI::App app;
  declareOptions (app, given);
  if (!parseArguments (app, completionText (), argc, argv))
    return (std::nullopt);
  try
  {
    preferCommandLine ({argv + 1, argv + argc}, given);
    return (toSettings (given));
  }
  catch (const InvalidArgument& error)
  {
    throw UsageError (error.what ());
  }
}
