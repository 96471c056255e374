// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "command_line.h"

#include "option_table.h"
#include "option_values.h"
#include "program_text.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

using namespace pcl::cosection;

namespace {

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
  constexpr std::array<const char*, 10> unwritten{".off",  ".vtk", ".vtp", ".dae", ".glb",
                                                  ".gltf", ".fbx", ".3ds", ".3mf", ".wrl"};
  if (std::find (unwritten.begin (), unwritten.end (), extension) != unwritten.end ())
    throw UsageError ("OUTPUT is " + settings.output +
                      ", a format that is not written; it must be a folder, or a file ending "
                      "in .ply, .stl or .obj");
  const std::string mesh = meshExtension (settings.output);
  if (!mesh.empty () && !given.format.empty () && given.format != mesh)
    throw UsageError ("--format " + given.format + " contradicts OUTPUT " + settings.output);
  settings.format = !mesh.empty () ? mesh : !given.format.empty () ? given.format : "ply";
}

void
setViewpoints (const Given& given, Settings& settings)
{
  if (given.viewpoints.empty ())
    return;
  const auto viewpoints = parseTuples<3> (given.viewpoints);
  if (!viewpoints)
    throw UsageError ("--viewpoint must be three numbers x,y,z");
  const std::size_t views = settings.inputs.size () + settings.free_space.size ();
  settings.viewpoints = *viewpoints;
  if (settings.viewpoints.size () == 1)
    settings.viewpoints.assign (views, settings.viewpoints[0]);
  if (settings.viewpoints.size () != views)
    throw UsageError ("--viewpoint is given " + std::to_string (settings.viewpoints.size ()) + " times for " +
                      std::to_string (views) + " views; give one for all, or one for each");
}

Settings
toSettings (const Given& given)
{
  Settings settings;
  if (given.quiet && given.verbose)
    throw UsageError ("--quiet and --verbose exclude each other");
  setPaths (given, settings);
  settings.json = given.json;
  settings.save_sdf = given.save_sdf;
  if (given.max_faces)
    settings.max_faces = static_cast<std::size_t> (*given.max_faces);
  settings.free_space = given.free_space;
  settings.obstacles = given.obstacles;
  settings.object_trajectories = parseObjectFiles ("--object-trajectory", given.object_trajectories);
  settings.verbosity = given.quiet ? Verbosity::Quiet : given.verbose ? Verbosity::Verbose : Verbosity::Normal;
  settings.preset = given.preset;
  settings.method = methodOptions (given);
  settings.method.compute_hull = given.save_hull;
  settings.method.compute_bounds = given.save_bounds;
  settings.constraints = constraintsOf (settings.method);
  if (!given.planes.empty ())
  {
    const auto planes = parseTuples<4> (given.planes);
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
  setViewpoints (given, settings);
  if (!given.intrinsics.empty ())
  {
    const auto intrinsics = parseTuples<4> (given.intrinsics);
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
