// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "arrays.h"
#include "bindings.h"
#include "result_parts.h"

#include "export_command_line.h"

#include <pcl/cosection/evaluation/mesh_comparison.h>

#include <pybind11/stl.h>

#include <algorithm>
#include <utility>

namespace py = pybind11;
using namespace pcl::cosection;

namespace {

py::dict
toDict (const ErrorStatistics& errors)
{
  using namespace py::literals;
  return py::dict ("mean"_a = errors.mean, "rmse"_a = errors.rmse, "median"_a = errors.median, "p95"_a = errors.p95,
                   "max"_a = errors.max);
}

py::dict
compare (const TriangleMesh& truth, const TriangleMesh& reconstruction, std::size_t samples, std::uint64_t seed,
         double f_threshold_m, int threads)
{
  using namespace py::literals;
  MeshComparisonOptions options;
  options.samples = samples;
  options.seed = seed;
  options.f_threshold_m = f_threshold_m;
  options.threads = threads;
  std::vector<std::string> warnings;
  const MeshComparison comparison = [&] {
    const py::gil_scoped_release unlocked;
    warnings = frameWarnings (summarizeMesh (truth), summarizeMesh (reconstruction));
    return compareMeshes (truth, reconstruction, options);
  }();
  return py::dict ("accuracy_m"_a = toDict (comparison.accuracy), "completeness_m"_a = toDict (comparison.completeness),
                   "precision"_a = comparison.precision, "recall"_a = comparison.recall,
                   "f_score"_a = comparison.f_score, "warnings"_a = warnings);
}

/** \brief Write a result's folder in formats of simulators. \return files and warnings */
std::pair<std::vector<std::string>, std::vector<std::string>>
exportResult (const std::string& result, const std::string& output, const std::vector<std::string>& options)
{
  const py::gil_scoped_release unlocked;
  const ExportProgramSettings settings = settingsOf (parseExportCommandLine, options, {result, output});
  ExportReport report = exportScene (settings.result, settings.output, settings);
  return {std::move (report.files), std::move (report.scene.warnings)};
}

} // namespace

void
bindEvaluation (py::module_& module)
{
  const MeshComparisonOptions defaults;
  module.def ("compare_meshes", compare, py::arg ("truth"), py::arg ("reconstruction"), py::kw_only (),
              py::arg ("samples") = defaults.samples, py::arg ("seed") = defaults.seed,
              py::arg ("f_threshold_m") = defaults.f_threshold_m, py::arg ("threads") = 0);
  module.def ("export_result", exportResult, py::arg ("result"), py::arg ("output"), py::arg ("options"));
}
