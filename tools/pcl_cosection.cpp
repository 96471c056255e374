// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Completes the hidden surfaces of the objects in PCD views; see pcl_cosection --help.

#include "command_line.h"
#include "complete_views.h"
#include "export_report.h"
#include "method_json.h"
#include "output_files.h"
#include "output_target.h"
#include "run_program.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/surface/co_section.h>

#include <pcl/common/time.h>

#include <iomanip>
#include <sstream>
#include <tuple>
#include <utility>

using namespace pcl::cosection;

namespace {

const char* const out_of_memory =
    "out of memory; use larger voxels (--voxel-size, --background-voxel-size) or fewer threads (--threads)";

std::string
summaryLine (const ObjectResult& object)
{
  std::ostringstream text;
  text << "object " << object.id << ": " << object.mesh.vertices.size () << " vertices, " << std::setprecision (3)
       << 1000.0 * computeMassProperties (object.mesh).volume_m3 << " litres";
  if (object.signed_distance)
    text << ", voxels of " << 1000.0 * object.signed_distance->grid.voxel_size_m << " mm";
  if (object.penetration_m > 0.0)
    text << ", " << 1000.0 * object.penetration_m << " mm inside another body";
  if (object.proposal)
    text << ", proposal " << (object.proposal->used ? "used" : "not used: it does not explain what was measured");
  if (object.learned)
    text << ", the network's answer " << (object.learned->used ? "used" : "not used: the views do not confirm it");
  return (text.str ());
}

/** \brief Poses of proposals are of the meshes as they are in their files, whose origin may be far away. */
void
setProposalOrigins (const Settings& settings, SceneResult& result)
{
  for (ObjectResult& object : result.objects)
  {
    std::size_t number = 0; // of this object's proposals
    for (const auto& [label, file] : settings.proposals)
      if (object.proposal && label == object.id && number++ == object.proposal->proposal)
        object.proposal->T_object_proposal.translate (-localOrigin (file));
  }
}

/** \brief Read, complete, write. \return whether every object succeeded, and whether any did */
std::pair<bool, bool>
complete (Settings settings, const OutputTarget& target, std::vector<std::string>& warnings, Terminal& terminal)
{
  const pcl::StopWatch total;
  CompletedViews completed = completeViews (
      settings, SceneReaders::ofFiles (),
      [&] (const std::string& stage, double fraction) {
        terminal.progress (stage, fraction);
        return (!interrupted ());
      },
      [&] (const std::string& line) {
        warnings.push_back (line);
        terminal.warning (line);
      });
  SceneResult& scene = completed.scene;
  setProposalOrigins (settings, scene);
  for (const ObjectResult& object : scene.objects)
    if (object.error.empty ())
      terminal.result (summaryLine (object));
  const std::vector<std::string> failures = failureTexts (scene.objects);
  for (const std::string& failure : failures)
    terminal.error (failure);
  for (const std::string& file : target.write (scene, completed.origin))
    terminal.result ("wrote " + file);
  scene.timings_s["total"] = total.getTimeSeconds ();
  target.writeSummary (summaryJson (settings, completed));
  for (const auto& [stage, seconds] : scene.timings_s)
    terminal.detail (stage + ": " + std::to_string (seconds) + " s");
  return {failures.empty (), anyCompleted (scene)};
}

bool
run (const Settings& settings, Terminal& terminal)
{
  catchInterruptions ();
  const OutputTarget target (settings);
  std::vector<std::string> warnings;
  bool all_good = false, any = false;
  try
  {
    std::tie (all_good, any) = complete (settings, target, warnings, terminal);
  }
  catch (const Cancelled&)
  {
    throw;
  }
  catch (const std::exception& error)
  {
    saveFailure (describe (error, out_of_memory), parametersJson (settings), warnings,
                 {settings.json, target.formerSummary ()});
    throw;
  }
  if (any)
    exportBeside (settings.output, settings.exports, settings.threads, terminal);
  return (all_good);
}

} // namespace

int
main (int argc, char** argv)
{
  return (runProgram ({"pcl_cosection", "interrupted, nothing was written", out_of_memory}, argc, argv,
                      parseCommandLine, run));
}
