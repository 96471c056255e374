// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "arrays.h"
#include "bindings.h"
#include "mesh_arrays.h"
#include "result_parts.h"
#include "running.h"
#include "view_data.h"

#include "command_line.h"
#include "complete_views.h"
#include "output_target.h"

#include <pybind11/stl.h>

#include <limits>
#include <map>
#include <memory>
#include <utility>

namespace py = pybind11;
using namespace pcl::cosection;

namespace {

/** \brief What a completion is made of; names stand for arrays, other names are files. */
struct SceneData
{
  std::vector<std::string> options; ///< as the command line of pcl_cosection has them
  std::vector<std::string> views;   ///< names
  std::map<std::string, ViewData> named_views;
  std::map<std::string, TriangleMesh> named_meshes;
  ObjectPoses T_world_object; ///< by label, one per view; not finite: not known
};

/** \brief The options, and what they mean, for results that go to a file or folder. \throws UsageError */
Settings
settingsOf (const SceneData& scene, const std::string& output, const std::string& format)
{
  std::vector<std::string> options = scene.options;
  for (const auto& [label, poses] : scene.T_world_object)
    options.push_back ("--object-trajectory=" + std::to_string (label) + "=poses of object " + std::to_string (label));
  if (!format.empty ())
    options.push_back ("--format=" + format);
  std::vector<std::string> paths = scene.views;
  paths.push_back (output);
  return settingsOf (parseCommandLine, options, paths);
}

SceneReaders
readersOf (const SceneData& scene)
{
  const SceneReaders files = SceneReaders::ofFiles ();
  SceneReaders readers;
  readers.view = [&scene, files] (const std::string& name, const PcdViewOptions& options) {
    const auto found = scene.named_views.find (name);
    return found == scene.named_views.end ()
               ? files.view (name, options)
               : toLabelledView (found->second.cloud, found->second.T_world_sensor, options, name);
  };
  readers.obstacle = [&scene, files] (const std::string& name, const Eigen::Vector3d& origin) {
    const auto found = scene.named_meshes.find (name);
    if (found == scene.named_meshes.end ())
      return files.obstacle (name, origin);
    TriangleMesh mesh = found->second;
    for (Eigen::Vector3f& v : mesh.vertices)
      v = (v.cast<double> () - origin).cast<float> ();
    return mesh;
  };
  readers.proposal = [&scene, files] (const std::string& name) {
    const auto found = scene.named_meshes.find (name);
    return found == scene.named_meshes.end () ? files.proposal (name) : found->second;
  };
  readers.poses = [&scene] (const std::map<int, std::string>&, std::size_t) { return scene.T_world_object; };
  return readers;
}

/** \brief A result with what it was made with. */
struct CompletionData
{
  CompletedViews completed;
  Settings settings;
  SceneData scene; ///< without its arrays
};

using SharedCompletion = std::shared_ptr<CompletionData>;

SharedCompletion
complete (SceneData scene, const py::object& progress)
{
  PythonRun run (progress);
  return run.run ([&] (const ProgressCallback& go_on) {
    auto result = std::make_shared<CompletionData> ();
    result->settings = settingsOf (scene, ".", "");
    result->completed = completeViews (result->settings, readersOf (scene), go_on, {});
    scene.named_views.clear ();
    scene.named_meshes.clear ();
    result->scene = std::move (scene);
    return result;
  });
}

std::vector<std::string>
save (const CompletionData& data, const std::string& output, const std::string& format)
{
  const py::gil_scoped_release unlocked;
  Settings settings = settingsOf (data.scene, output, format);
  settings.model = data.settings.model;
  const OutputTarget target (settings);
  std::vector<std::string> files = target.write (data.completed.scene, data.completed.origin);
  target.writeSummary (summaryJson (settings, data.completed));
  return files;
}

py::list
planesOf (const CompletionData& data)
{
  py::list planes;
  for (Eigen::Vector4d plane : data.completed.scene.planes)
  {
    plane[3] -= plane.head<3> ().dot (data.completed.origin);
    planes.append (py::make_tuple (plane[0], plane[1], plane[2], plane[3]));
  }
  return planes;
}

void
bindViews (py::module_& module)
{
  py::class_<ViewData> (module, "ViewData")
      .def_static ("of_depth", viewOfDepth, py::arg ("depth"), py::arg ("labels"), py::arg ("colours"),
                   py::arg ("intrinsics"), py::arg ("T_world_sensor"))
      .def_static ("of_points", viewOfPoints, py::arg ("points"), py::arg ("labels"), py::arg ("colours"),
                   py::arg ("normals"), py::arg ("T_world_sensor"));
}

void
bindScene (py::module_& module)
{
  py::class_<SceneData> (module, "SceneData")
      .def (py::init ([] (std::vector<std::string> options) {
              SceneData scene;
              scene.options = std::move (options);
              return scene;
            }),
            py::arg ("options"))
      .def (
          "add_view",
          [] (SceneData& scene, const std::string& name, const ViewData* view, bool free_space) {
            if (view != nullptr)
              scene.named_views[name] = *view;
            if (free_space)
              scene.options.push_back ("--free-space=" + name);
            else
              scene.views.push_back (name);
          },
          py::arg ("name"), py::arg ("view"), py::arg ("free_space"))
      .def (
          "add_mesh",
          [] (SceneData& scene, const std::string& option, const std::string& name, const TriangleMesh* mesh) {
            scene.options.push_back (option + name);
            if (mesh != nullptr)
              scene.named_meshes[name] = *mesh;
          },
          py::arg ("option"), py::arg ("name"), py::arg ("mesh"))
      .def (
          "set_poses",
          [] (SceneData& scene, int label, const std::vector<DenseArray<double>>& poses) {
            for (const DenseArray<double>& pose : poses)
              scene.T_world_object[label].push_back (toIsometry (pose));
          },
          py::arg ("label"), py::arg ("T_world_object"));
}

} // namespace

void
bindCompletion (py::module_& module)
{
  bindViews (module);
  bindScene (module);
  py::class_<CompletionData, SharedCompletion> (module, "CompletionData")
      .def_property_readonly ("objects",
                              [] (const SharedCompletion& data) {
                                py::list objects;
                                for (ObjectResult& object : data->completed.scene.objects)
                                  objects.append (objectDict (data, object));
                                return objects;
                              })
      .def_property_readonly (
          "background",
          [] (const SharedCompletion& data) { return partOrNone (data, data->completed.scene.background); })
      .def_property_readonly ("planes", planesOf)
      .def_property_readonly ("origin_m", [] (const CompletionData& data) { return toArray (data.completed.origin); })
      .def_property_readonly ("warnings",
                              [] (const CompletionData& data) { return inPython (data.completed.warnings); })
      .def_property_readonly ("timings_s", [] (const CompletionData& data) { return data.completed.scene.timings_s; })
      .def ("summary", [] (const CompletionData& data) { return summaryJson (data.settings, data.completed).dump (); })
      .def ("save", save, py::arg ("output"), py::arg ("format"));
  module.def ("complete", complete, py::arg ("scene"), py::arg ("progress"));
  module.def ("option_names", [] {
    Given given;
    CLI::App app;
    declareOptions (app, given);
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options ())
      for (const std::string& name : option->get_lnames ())
        names.push_back (name);
    return names;
  });
}
