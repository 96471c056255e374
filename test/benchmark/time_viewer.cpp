// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// time_viewer OUTPUT [WIDTH HEIGHT]: plays what pcl_cosection_fusion wrote to OUTPUT in a window, as fast as that is
// drawn, and prints frames per second for each colour mode. Without a screen: xvfb-run -s "-screen 0 1400x900x24"
// time_viewer OUTPUT

#include <pcl/cosection/visualization/run_window.h>

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>

using namespace pcl::cosection;

namespace {

constexpr std::size_t display_triangles = 30000; // as pcl_cosection_viewer
constexpr int repetitions = 2;

/** \brief Of all threads of this process. */
double
processorSeconds ()
{
  rusage usage;
  getrusage (RUSAGE_SELF, &usage);
  return (static_cast<double> (usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
          1e-6 * static_cast<double> (usage.ru_utime.tv_usec + usage.ru_stime.tv_usec));
}

void
time (const char* what, RunWindow& window, std::size_t frames)
{
  window.show (0); // what is made once
  double best = 0.0;
  const double before_s = processorSeconds ();
  for (int repetition = 0; repetition < repetitions; ++repetition)
  {
    const auto start = std::chrono::steady_clock::now ();
    for (std::size_t frame = 0; frame < frames; ++frame)
      window.show (frame);
    const double seconds = std::chrono::duration<double> (std::chrono::steady_clock::now () - start).count ();
    best = std::max (best, static_cast<double> (frames) / seconds);
  }
  std::printf ("%-12s %5.1f frames/s, %5.1f ms of processor time per frame\n", what, best,
               1000.0 * (processorSeconds () - before_s) / static_cast<double> (repetitions * frames));
}

} // namespace

int
main (int argc, char** argv)
{
  if (argc != 2 && argc != 4)
  {
    std::cerr << "Usage: time_viewer OUTPUT [WIDTH HEIGHT]\n";
    return (2);
  }
  try
  {
    ReadingNotes notes;
    RunSceneOptions scene_options;
    scene_options.triangles = display_triangles;
    RunScene scene = loadRunScene (argv[1], notes, scene_options);
    const std::size_t frames = scene.run.camera.size ();
    RunWindowOptions options;
    if (argc == 4)
    {
      options.view.width = std::atoi (argv[2]);
      options.view.height = std::atoi (argv[3]);
    }
    const Viewpoint above = overview (scene);
    options.view.viewpoint = above;
    RunWindow window (std::move (scene), options);
    for (const char* const colour : {"real", "instance", "provenance", "confidence"})
    {
      time (colour, window, frames);
      window.press ("c");
    }
    window.press ("f");
    time ("from camera", window, frames);
    return (0);
  }
  catch (const std::exception& error)
  {
    std::cerr << "time_viewer: " << error.what () << '\n';
    return (1);
  }
}
