// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Bytes as summary.json of a run, as the report and the viewer read it, as that of a result that is exported or
// viewed, or as a viewpoint; the first line says which.

#include "fuzz_target.h"
#include "memory_file.h"

#include "completed_result.h"
#include "report_page.h"
#include "scene_data.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/visualization/scene_picture.h>

using namespace pcl::cosection;

namespace {

/** \brief A run of a camera and an object without meshes, but for its summary. */
fuzz::MemoryFolder&
runFolder ()
{
  static fuzz::MemoryFolder folder;
  static const bool is_filled = [] {
    folder.set ("trajectory/camera.txt", "0 0 0 0 0 0 0 1\n1 0.1 0 0 0 0 0 1\n");
    folder.set ("trajectory/object_1.txt", "0 0 0 1 0 0 0 1\n1 0 0 1 0 0 0 1\n");
    return (true);
  }();
  static_cast<void> (is_filled);
  return (folder);
}

/** \brief What the viewer makes of a run. */
bool
viewRun (const std::string& folder)
{
  ReadingNotes notes;
  const RunScene scene = loadRunScene (folder, notes);
  fuzz::requireMessages (notes.warnings);
  scene.camera ().validate ();
  for (const auto& [id, name] : scene.classes)
    fuzz::require (!name.empty (), "a class has a name");
  try
  {
    scene.source.validate ();
  }
  catch (const InvalidArgument& error) // as one that is given
  {
    fuzz::requireMessage (error.what ());
  }
  return (notes.whole);
}

/** \brief What the report makes of it. */
void
reportRun (const std::string& folder)
{
  ReportContent content;
  content.threads = 1;
  content.run = readRunFolder (folder);
  fuzz::requireMessages (content.run.notes);
  content.scene = sceneOf (content.run);
  content.warnings = content.run.notes;
  const std::string data = asScriptText (sceneData (content));
  fuzz::require (data.find ('<') == std::string::npos, "nothing ends the script of a page");
  fuzz::require (!reportPage (content).empty (), "there is a page");
}

bool
readSummary (const std::string& bytes)
{
  runFolder ().set ("summary.json", bytes);
  const std::string path = runFolder ().path ();
  reportRun (path);
  return (viewRun (path));
}

/** \brief A tetrahedron as the only object of a result, with this summary. */
std::string
resultFolder (const std::string& summary)
{
  static fuzz::MemoryFolder folder;
  static const bool is_filled = [] {
    folder.set ("object_1.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                                "property float z\nelement face 4\nproperty list uchar int vertex_indices\n"
                                "end_header\n0 0 0\n0.1 0 0\n0 0.1 0\n0 0 0.1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
    return (true);
  }();
  static_cast<void> (is_filled);
  folder.set ("summary.json", summary);
  return (folder.path ());
}

/** \brief What the viewer makes of a result. */
bool
viewResult (const std::string& bytes)
{
  ReadingNotes notes;
  const RunScene scene = loadRunScene (resultFolder (bytes), notes);
  fuzz::requireMessages (notes.warnings);
  fuzz::require (!scene.stamps ().empty (), "a result has a frame");
  SceneView view;
  view.width = view.height = 64;
  view.oversampling = 1;
  for (const bool with_cameras : {true, false})
  {
    try
    {
      view.viewpoint = overview (scene, 0.0, with_cameras);
      fuzz::require (drawScene (scene, scene.stamps ().back (), view).width == view.width, "there is a picture");
    }
    catch (const InvalidArgument&)
    {
      fuzz::require (false, "what was read can be drawn");
    }
  }
  return (notes.warnings.empty ());
}

/** \brief What the export makes of it. */
bool
readResult (const std::string& bytes)
{
  const CompletedResult result = readCompletedResult (resultFolder (bytes));
  fuzz::requireMessages (result.warnings);
  PhysicsOptions options;
  options.threads = 1;
  const PhysicalScene scene = buildPhysicalScene (result.scene, options);
  fuzz::requireMessages (scene.warnings);
  for (const PhysicalBody& body : scene.bodies)
    fuzz::require (!body.name.empty () && body.mass_kg > 0.0 && body.centre_m.allFinite () && !body.parts.empty (),
                   "a body has a name, mass and parts");
  return (true);
}

bool
readViewpoint (const std::string& bytes)
{
  static fuzz::MemoryFile file;
  file.set (bytes);
  const Viewpoint view = loadViewpoint (file.path ());
  view.validate ();
  fuzz::require (view.pose ().matrix ().allFinite (), "the eye is somewhere");
  view.camera (64, 48).validate ();
  return (true);
}

} // namespace

std::vector<std::string>
fuzz::seeds ()
{
  return {
      R"(summary.json
{"timings_s": {"read": 0.5, "total": 2.5}, "frames_per_second": 20.5, "frames": 2, "frames_left_out": 0,
"camera": {"width": 64, "height": 48, "fx": 60.0, "fy": 60.0, "cx": 31.5, "cy": 23.5},
"parameters": {"dataset": "/data/table", "images": {"format": "cofusion", "depth_dir": "", "depth_scale": 0.0,
"intrinsics": null}, "camera_trajectory": "", "masks": "", "segmentation": "geometric", "preset": "paper",
"constraints": "all", "frames": [0, null], "object_trajectories": {}, "max_views": 100},
"objects": [{"id": 1, "class": "cup", "score": 0.9, "volume_m3": 0.001, "closed": true, "penetration_m": 0.0,
"frames_tracked": 2, "provenance": {"observed": 0.5, "inferred": 0.25, "hull": 0.25, "intersection": 0.0},
"solver": {"iterations": 12, "converged": true}}],
"failed": [{"id": 2, "error": "too few points"}], "events": ["frame 1: object 1 is new"], "warnings": ["a warning"]}
)",
      R"(summary.json
{"error": "no depth image can be read"})",
      R"(summary.json
{"camera": {"width": 640, "height": 480, "fx": 525, "fy": 525, "cx": 319.5, "cy": 239.5}, "objects": [{"id": 3,
"class": "7"}, {"id": 4, "closed": false}], "parameters": {"images": {"format": "tum", "depth_scale": 5000,
"intrinsics": [525, 525, 319.5, 239.5]}}})",
      R"(result.json
{"objects": [{"id": 1, "voxel_size_m": 0.01, "class": "cup"}], "failed": [], "origin_m": [10.0, 0.0, 0.0],
"support_planes": [[0.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.2, -0.5]], "parameters": {"object_trajectories": {}}})",
      R"(views.json
{"views": [{"input": 0, "camera": {"width": 64, "height": 48, "fx": 60.0, "fy": 60.0, "cx": 31.5, "cy": 23.5},
"T_world_sensor": [[1, 0, 0, 10.0], [0, 1, 0, 0.5], [0, 0, 1, -1.0], [0, 0, 0, 1]]}], "origin_m": [10.0, 0.0, 0.0],
"support_planes": [[0.0, 0.0, -1.0, 0.2]], "parameters": {"format": "ply"}, "objects": [{"id": 1}]})",
      R"(viewpoint.json
{"eye": [1.0, -2.0, 0.5], "target": [0.0, 0.0, 0.0], "up": [0.0, 0.0, 1.0], "angle_deg": 40.0})"};
}

std::vector<std::string>
fuzz::dictionary ()
{
  constexpr std::size_t deep = 1 << 14; // brackets in each other
  return {std::string (deep, '[') + std::string (deep, ']'),
          "summary.json\n",
          "viewpoint.json\n",
          "result.json\n",
          "views.json\n",
          "\"T_world_sensor\"",
          "\"support_planes\"",
          "\"origin_m\"",
          "\"voxel_size_m\"",
          "[0, 0, 1e-300, 0]",
          "\"id\": 999999999",
          "\"id\": 1e300",
          "\"id\"",
          "\"class\"",
          "\"provenance\"",
          "\"camera\"",
          "\"objects\"",
          "\"width\"",
          "\"fx\"",
          "\"parameters\"",
          "\"images\"",
          "\"intrinsics\"",
          "\"dataset\"",
          "\"eye\"",
          "\"up\"",
          "\"angle_deg\"",
          "[0, 0, 0]",
          "[",
          "]",
          "{",
          "}",
          ",",
          ":",
          "\"",
          "null",
          "true",
          "-1e308",
          "1e-320",
          "\"</script>\"",
          "\"<!--\"",
          "\"\\n\"",
          "\"\\u0000\"",
          "\"\xff\xfe\""};
}

bool
fuzz::accepts (const std::string& input)
{
  const auto [kind, bytes] = splitFirstLine (input);
  if (kind != "summary.json" && kind != "viewpoint.json" && kind != "result.json" && kind != "views.json")
    return (false);
  try
  {
    if (kind == "result.json")
      return (readResult (bytes));
    if (kind == "views.json")
      return (viewResult (bytes));
    return (kind == "summary.json" ? readSummary (bytes) : readViewpoint (bytes));
  }
  catch (const Error& error)
  {
    requireMessage (error.what ());
    return (false);
  }
}
