// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "viewer_pictures.h"

#include "output_files.h"
#include "run_program.h"

#include "pcl_cosection/common/files.h"
#include "pcl_cosection/rendering/picture.h"
#include "pcl_cosection/sequence/stamp_matching.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/evaluation/run_evaluation.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

namespace fs = std::filesystem;
using namespace pcl::cosection;

namespace {

std::string
nameOfFrame (std::size_t number)
{
  std::array<char, 32> name;
  std::snprintf (name.data (), name.size (), "Frame%05zu.png", number);
  return (name.data ());
}

std::string
sizeOf (const SceneView& view)
{
  return (std::to_string (view.width) + " x " + std::to_string (view.height));
}

/** \brief What no mesh has, though its colours shall show it: STL files have no attributes, OBJ files hardly any. */
const char*
missingAttribute (const RunScene& scene, const SceneView& view)
{
  const auto hasNone = [&] (auto attribute) {
    return (view.surface == SurfaceMode::Completed && !scene.run.objects.empty () &&
            std::all_of (scene.run.objects.begin (), scene.run.objects.end (),
                         [&] (const auto& object) { return ((object.mesh.*attribute).empty ()); }));
  };
  if (view.colour == ColourMode::Provenance && hasNone (&TriangleMesh::provenance))
    return ("provenance");
  return (view.colour == ColourMode::Confidence && hasNone (&TriangleMesh::confidence) ? "confidence" : nullptr);
}

/** \brief Draws frames one after the other. */
class FrameDrawer
{
public:
  FrameDrawer (const ViewerSettings& settings, const RunScene& scene) : scene_ (scene), view_ (settings.view)
  {
    view_.viewpoint = chosenViewpoint (settings, scene);
    if (view_.surface == SurfaceMode::Points)
      reader_.emplace (scene, settings.dataset);
  }

  void draw (double stamp, const std::string& path) const
  {
    FramePoints points;
    if (reader_)
      points = reader_->read (scene_, stamp);
    writePng (drawScene (scene_, stamp, view_, &points), path);
  }

private:
  const RunScene& scene_;
  SceneView view_;
  std::optional<FramePointReader> reader_;
};

void
record (const ViewerSettings& settings, const RunScene& scene, Terminal& terminal)
{
  const FrameDrawer drawer (settings, scene);
  makeFolder (settings.record);
  requireWritableFolder (settings.record, settings.record);
  const std::vector<double> stamps = scene.stamps ();
  std::size_t number = 0;
  const std::size_t frames = (stamps.size () + settings.every - 1) / settings.every;
  if (fs::exists (fs::path (settings.record) / nameOfFrame (frames + 1)))
    terminal.warning (settings.record + ": has further frames, of another recording");
  for (std::size_t n = 0; n < stamps.size (); n += settings.every)
  {
    terminal.progress ("frames", static_cast<double> (n) / static_cast<double> (stamps.size ()));
    if (interrupted ())
      throw Cancelled ("cancelled");
    drawer.draw (stamps[n], (fs::path (settings.record) / nameOfFrame (++number)).string ());
  }
  terminal.result ("wrote " + settings.record + ": " + counted (number, "frame") + " of " + sizeOf (settings.view));
}

} // namespace

void
checkPictures (const ViewerSettings& settings)
{
  for (const std::string& output : {settings.screenshot, settings.record})
    if (!output.empty ())
      for (const std::string& input : {settings.run, settings.truth, settings.dataset})
        if (!input.empty () && isWithin (followLinks (output), input))
          throw UsageError (output + " is in " + input + ", which is only read; give another place");
  refuseToOverwrite ({settings.viewpoint, configurationFile (settings.arguments)}, {settings.screenshot});
  if (!settings.screenshot.empty ())
    requireWritable (settings.screenshot);
  std::error_code failure;
  if (!settings.record.empty () && fs::exists (settings.record, failure) &&
      !fs::is_directory (settings.record, failure))
    throw IoError (settings.record + ": is a file; --record needs a folder");
}

RunScene
loadScene (const ViewerSettings& settings, Terminal& terminal)
{
  ReadingNotes notes;
  RunSceneOptions options;
  options.triangles = settings.triangles;
  RunScene scene = loadRunScene (settings.run, notes, options);
  if (!settings.truth.empty ())
  {
    const SceneRecord truth = scene.of_views ? readTruthOfViews (settings.truth, scene.run.camera, notes)
                                             : readTruth (settings.truth, notes);
    const std::vector<std::string> warnings = measureErrors (scene, truth, settings.threads);
    notes.warnings.insert (notes.warnings.end (), warnings.begin (), warnings.end ());
  }
  for (const std::string& warning : notes.warnings)
    terminal.warning (warning);
  const bool no_background = scene.run.background.empty ();
  if (no_background && scene.tsdf.empty () &&
      std::all_of (scene.run.objects.begin (), scene.run.objects.end (),
                   [] (const auto& object) { return (object.mesh.empty ()); }))
    terminal.warning (settings.run + ": has no meshes; there is only the path of the camera to show");
  else if (settings.view.surface == SurfaceMode::Tsdf && scene.tsdf.empty ())
    terminal.warning (settings.run + ": has no surfaces as they were seen, so --mode tsdf shows " +
                      (no_background ? "nothing" : "the background alone"));
  if (const char* const missing = missingAttribute (scene, settings.view))
    terminal.warning (settings.run + ": its meshes have no " + missing + ", so --colour shows them grey");
  if (!scene.run.intrinsics)
    terminal.warning (settings.run + ": its summary.json does not give the camera; one of 640 x 480 pixels is assumed");
  return (scene);
}

std::optional<Viewpoint>
chosenViewpoint (const ViewerSettings& settings, const RunScene& scene)
{
  if (!settings.viewpoint.empty ())
    return (loadViewpoint (settings.viewpoint));
  if (settings.choice == ViewChoice::Camera)
    return (std::nullopt);
  return (overview (scene, settings.choice == ViewChoice::Behind ? M_PI : 0.0,
                    settings.view.path || settings.view.frustum));
}

std::size_t
chosenFrame (const ViewerSettings& settings, const RunScene& scene, std::size_t otherwise)
{
  if (!settings.stamp)
    return (otherwise);
  const std::vector<double> stamps = scene.stamps ();
  const std::optional<std::size_t> frame = nearestStamp (stamps, *settings.stamp, stampPeriod (stamps));
  if (frame)
    return (*frame);
  std::ostringstream text;
  text.precision (12);
  text << "--frame " << *settings.stamp << ": the run has no such stamp; it has those from " << stamps.front ()
       << " to " << stamps.back ();
  throw InvalidArgument (text.str ());
}

void
writePictures (const ViewerSettings& settings, const RunScene& scene, Terminal& terminal)
{
  if (!settings.record.empty ())
    return (record (settings, scene, terminal));
  const std::vector<double> stamps = scene.stamps ();
  const std::size_t frame = chosenFrame (settings, scene, stamps.size () - 1);
  FrameDrawer (settings, scene).draw (stamps[frame], settings.screenshot);
  terminal.result ("wrote " + settings.screenshot + ": frame " + std::to_string (frame + 1) + " of " +
                   std::to_string (stamps.size ()) + ", " + sizeOf (settings.view));
}
