// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "export_command_line.h"

#include "option_values.h"
#include "output_files.h"

#include "pcl_cosection/mesh/even_samples.h"

using namespace pcl::cosection;

namespace {

const std::vector<std::pair<std::string, CollisionShape>> shapes = {{"hull", CollisionShape::Hull},
                                                                    {"parts", CollisionShape::Parts},
                                                                    {"mesh", CollisionShape::Mesh},
                                                                    {"outer", CollisionShape::Outer}};
const std::vector<std::pair<std::string, SceneFrame>> frames = {
    {"auto", SceneFrame::Auto}, {"result", SceneFrame::Result}, {"table", SceneFrame::Table}};
constexpr long most_parts = 1000;
constexpr double largest_margin_m = 10.0;

template <typename Value>
Value
valueOf (const std::string& word, const std::vector<std::pair<std::string, Value>>& values)
{
  for (const auto& [name, value] : values)
    if (name == word)
      return (value);
  throw UsageError (word + ": is not known"); // its option has refused it before
}

void
interpret (ExportProgramSettings& settings)
{
  requirePaths (settings.paths, "RESULT", "OUTPUT");
  settings.result = settings.paths[0];
  settings.output = settings.paths[1];
  if (settings.result.empty () || settings.output.empty ())
    throw UsageError ("RESULT and OUTPUT must be names of folders");
  if (settings.formats.empty ())
    throw UsageError ("--format is missing: what to write, for example --format mjcf");
  if (settings.sdf_margin_m && !settings.save_sdf)
    throw UsageError ("--sdf-margin needs --save-sdf");
  settings.physics.collision = valueOf (settings.collision, shapes);
  settings.physics.frame = valueOf (settings.frame, frames);
  settings.physics.threads = settings.threads;
  for (const std::string& value : settings.mass_values)
  {
    const std::size_t equals = value.find ('=');
    const std::optional<double> id = parseNumber (value.substr (0, equals));
    const std::optional<double> mass = equals == std::string::npos ? std::nullopt
                                                                   : parseNumber (value.substr (equals + 1));
    if (!id || !mass || *id < 0.0 || *id >= 1e9 || *id != static_cast<int> (*id) || !(*mass > 0.0))
      throw UsageError ("--mass must be ID=KG with a mass greater than 0, such as 3=0.25; it is \"" + value + "\"");
    if (!settings.physics.masses_kg.emplace (static_cast<int> (*id), *mass).second)
      throw UsageError ("--mass is given twice for object " + std::to_string (static_cast<int> (*id)));
  }
  settings.physics.validate ();
}

} // namespace

const ProgramText&
exportText ()
{
  static const ProgramText text = {
      "pcl_cosection_export",
      "make rigid bodies of completed objects, for simulators and planners",
      "pcl_cosection_export [OPTIONS] --format FORMAT RESULT OUTPUT",
      "Makes rigid bodies of completed objects: convex parts to collide by, mass, centre of mass and inertia, and "
      "static "
      "bodies of what they stand on; and writes them as simulators and planners load them.",
      {"RESULT is a folder that pcl_cosection or pcl_cosection_fusion wrote, with its summary.json.",
       "OUTPUT is a folder. It gets scene.json, which says of each body what it is, and of the formats: urdf (a file "
       "for "
       "each body), scene.sdf, scene.xml (mjcf), scene.glb (gltf), scene.usda, planning_scene.json (moveit); meshes "
       "are "
       "in its folder meshes."},
      {
          {"pcl_cosection_export --format mjcf meshes simulation", "for MuJoCo"},
          {"pcl_cosection_export --format urdf --density 800 meshes robot", "heavier things, for Bullet or ROS"},
          {"pcl_cosection_export --format sdf --collision hull meshes gazebo", "a convex hull for each"},
          {"pcl_cosection_evaluate stability simulation", "does it stay where it is?"},
      },
      {"density = 800", "max-parts = 32"},
  };
  return (text);
}

void
declareExportOptions (CLI::App& app, ExportProgramSettings& settings)
{
  OptionGroup scene (app, "Scene"), bodies (app, "Bodies"), output (app, "Output");
  std::string names;
  for (const std::string& name : exportFormats ())
    names += (names.empty () ? "" : "|") + name;
  scene.add ("--format " + names, settings.formats, "What to write; repeatable");
  scene.add (
      "--frame auto|result|table", settings.frame,
      "The frame of the scene: that of RESULT, or one on the support plane, z up; auto: RESULT's if its z axis is "
      "up (default: auto)");
  bodies.add ("--density DENSITY", settings.physics.density_kg_m3, positiveNumber (),
              "Of all objects, kg/m^3" + byDefault (settings.physics.density_kg_m3));
  bodies.add ("--mass ID=KG", settings.mass_values, "Of an object, instead; repeatable");
  bodies.add ("--collision hull|parts|mesh|outer", settings.collision,
              "Objects collide by their convex hull, by convex parts, as they are, or by parts of their outer bounds "
              "(--save-bounds of pcl_cosection)" +
                  byDefault (settings.collision));
  bodies.add ("--max-parts N", settings.physics.max_parts, wholeRange (1, most_parts),
              "At most so many convex parts of an object" + byDefault (settings.physics.max_parts));
  output.add ("--save-points N", settings.points, wholeRange (1, most_even_samples),
              "Write N points with normals, evenly over each object's surface (points/NAME.pcd)");
  output.addFlag ("--save-sdf", settings.save_sdf,
                  "Write each object's signed distance for planners (sdf/NAME.npy, .json and .vti)");
  output.add ("--sdf-margin METRES", settings.sdf_margin_m, numberRange (0.0, largest_margin_m, true),
              "How far the signed distance reaches around an object (default: 5 voxels)");
  declareGeneralOptions (app, "pcl_cosection_export", settings);
}

std::optional<ExportProgramSettings>
parseExportCommandLine (int argc, const char* const* argv)
{
  return (readCommandLine<ExportProgramSettings> (argc, argv, exportText (), declareExportOptions, interpret));
}
