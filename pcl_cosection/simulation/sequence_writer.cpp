// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "sequence_writer.h"

#include "new_folder.h"
#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/io/image_io.h"
#include "pcl_cosection/view/organized_cloud.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/io/trajectory.h>
#include <pcl/cosection/simulation/scene_renderer.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <algorithm>
#include <cstdio>
#include <locale>
#include <sstream>

namespace pcl::cosection {
namespace {

constexpr double truth_chord_m = 5e-5;
constexpr double truth_share = 0.05; // of the progress

std::string
numbered (const char* name, int number, const char* extension)
{
  char text[64];
  std::snprintf (text, sizeof text, "%s%04d.%s", name, number, extension);
  return text;
}

class SequenceWriter
{
public:
  SequenceWriter (const SimulatedScene& scene, const NewFolder& folder, const SequenceOptions& options)
      : scene_ (scene)
      , folder_ (folder)
      , options_ (options)
      , renderer_ (scene)
      , wide_mask_ (std::any_of (scene.bodies.begin (), scene.bodies.end (),
                                 [] (const SceneBody& body) { return body.id > 255; }))
  {}

  void write (const ProgressCallback& progress)
  {
    makeFolders ();
    writeCalibration ();
    report (progress, "truth", 0.0);
    writeTruth ();
    const int count = options_.last - options_.first;
    const int together = resolveThreads (options_.threads);
    for (int done = 0; done < count; done += together)
    {
      report (progress, "frames", truth_share + (1.0 - truth_share) * done / count);
      parallelFor (done, std::min (count, done + together), options_.threads,
                   [&] (int n) { writeFrame (options_.first + n); });
    }
    report (progress, "frames", 1.0);
  }

private:
  static void report (const ProgressCallback& progress, const char* stage, double fraction)
  {
    if (progress && !progress (stage, fraction))
      throw Cancelled ("cancelled");
  }

  bool isView (int frame) const { return scene_.views_every > 0 && frame % scene_.views_every == 0; }

  void makeFolders () const
  {
    for (const char* name : {"colour", "mask", "gt-mesh"})
      folder_.makeFolder (name);
    if (scene_.noise)
      folder_.makeFolder ("depth_noise");
    if (!scene_.noise || scene_.exact_depth)
      folder_.makeFolder ("depth");
    if (scene_.views_every > 0)
      folder_.makeFolder ("views");
  }

  void writeCalibration () const
  {
    std::ostringstream out;
    out.imbue (std::locale::classic ());
    out.precision (10);
    const PinholeCamera& c = scene_.camera;
    out << c.fx << ' ' << c.fy << ' ' << c.cx << ' ' << c.cy << ' ' << c.width << ' ' << c.height << '\n';
    folder_.writeText ("calibration.txt", out.str ());
    if (!scene_.spec.empty ())
      folder_.writeText ("scene.json", effectiveSpec (scene_));
  }

  void writeMotion (const KeyedMotion& motion, const std::string& name) const
  {
    std::vector<StampedPose> frames, views;
    for (int frame = options_.first; frame < options_.last; ++frame)
    {
      frames.push_back ({static_cast<double> (frame), motion.at (scene_.timeOf (frame))});
      if (isView (frame))
        views.push_back ({static_cast<double> (views.size ()), frames.back ().pose});
    }
    saveTrajectory (frames, folder_.file (name));
    if (!views.empty ())
      saveTrajectory (views, folder_.file ("views/" + name));
  }

  void writeTruth () const
  {
    writeMotion (scene_.camera_motion, "gt-cam-0.txt");
    for (const SceneBody& body : scene_.bodies)
    {
      if (body.id > 0)
        writeMotion (body.motion, "gt-" + body.name + "-" + std::to_string (body.id) + ".txt");
      if (!body.parts.empty ())
        saveMesh (body.surface (truth_chord_m), folder_.file ("gt-mesh/" + body.name + ".ply"));
    }
  }

  void writeFrame (int number) const
  {
    const SimulatedFrame frame = renderer_.render (scene_.timeOf (number));
    const char* extension = scene_.depth_format == DepthFormat::Exr ? "exr" : "png";
    saveColourImage (frame.colour, folder_.file ("colour/" + numbered ("Color", number, "png")));
    saveMaskImage (frame.mask, folder_.file ("mask/" + numbered ("Mask", number, "png")), wide_mask_);
    Image<float> measured = frame.depth;
    if (scene_.noise)
    {
      measured = measureDepth (frame.depth, frame.normals, scene_.camera, *scene_.noise, scene_.seed,
                               static_cast<std::uint64_t> (number));
      saveDepthImage (measured, folder_.file ("depth_noise/" + numbered ("Depth", number, extension)),
                      scene_.depth_scale);
    }
    if (!scene_.noise || scene_.exact_depth)
      saveDepthImage (frame.depth, folder_.file ("depth/" + numbered ("Depth", number, extension)), scene_.depth_scale);
    if (!isView (number))
      return;
    const int first_view = (options_.first + scene_.views_every - 1) / scene_.views_every;
    const DepthView view{scene_.camera, measured.pixels, frame.T_world_camera};
    saveLabelledCloud (view, frame.mask, frame.colour,
                       folder_.file ("views/" + numbered ("View", number / scene_.views_every - first_view, "pcd")));
  }

  const SimulatedScene& scene_;
  const NewFolder& folder_;
  const SequenceOptions options_;
  const SceneRenderer renderer_;
  const bool wide_mask_;
};

} // namespace

void
writeSequence (const SimulatedScene& scene, const std::string& path, const SequenceOptions& options,
               const ProgressCallback& progress)
{
  scene.validate ();
  SequenceOptions chosen = options;
  if (chosen.last < 0)
    chosen.last = scene.frames;
  if (chosen.first < 0 || chosen.first >= chosen.last || chosen.last > scene.frames)
    throw InvalidArgument ("frames " + std::to_string (chosen.first) + ":" + std::to_string (chosen.last) +
                           " are not there; the scene has 0:" + std::to_string (scene.frames));
  NewFolder folder (path);
  folder.fill ([&] { SequenceWriter (scene, folder, chosen).write (progress); });
}

} // namespace pcl::cosection
