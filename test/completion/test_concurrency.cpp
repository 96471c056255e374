// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Whole uses of the library in several threads, as ThreadSanitizer watches them (run_tests.sh --sanitize-threads).
// OpenMP's library is not known to it: each has one thread.

#include "common/temporary_folder.h"
#include "imls_sphere.h"

#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/io/pcd_view.h>
#include <pcl/cosection/surface/co_section.h>

#include <pcl/console/print.h>

#include <gtest/gtest.h>

#include <sstream>
#include <thread>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr int users = 4;

/** \brief A file of points without normals and without order, seen from one side. */
std::string
unorganisedCloud ()
{
  const auto cloud = sphereCloud (true, 2000);
  std::ostringstream text;
  text << "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " << cloud->size ()
       << "\nHEIGHT 1\nVIEWPOINT 0 0 1 0 1 0 0\nPOINTS " << cloud->size () << "\nDATA ascii\n";
  for (const auto& p : *cloud) // in the frame of a sensor that looks down from 1 m above
    text << p.x << ' ' << -p.y << ' ' << 1.0f - p.z << '\n';
  return text.str ();
}

void
readCompleteAndSave (const std::string& cloud, const std::string& mesh)
{
  PcdViewOptions reading;
  reading.threads = 1;
  const LabelledView view = readPcdView (cloud, reading);
  CoSectionOptions options;
  options.threads = options.solver.threads = 1;
  CoSection scene (options);
  if (view.view)
    scene.addView (*view.view);
  scene.addObject ({1, view.objects.at (1).points, {}});
  const SceneResult result = scene.update ();
  saveMesh (result.objects.at (0).mesh, mesh);
  loadMesh (mesh);
}

} // namespace

TEST (Concurrency, UsersInSeveralThreadsDoNotDisturbEachOther)
{
  const TemporaryFolder folder;
  const std::string cloud = folder.file ("cloud.pcd");
  writeFile (cloud, unorganisedCloud ());
  const auto level = pcl::console::getVerbosityLevel ();
  const auto mesh = [&] (int n) { return folder.file (std::to_string (n) + ".ply"); };
  readCompleteAndSave (cloud, mesh (users));
  std::vector<std::thread> threads;
  for (int n = 0; n < users; ++n)
    threads.emplace_back ([&, n] { readCompleteAndSave (cloud, mesh (n)); });
  for (std::thread& thread : threads)
    thread.join ();
  ASSERT_FALSE (readFile (mesh (users)).empty ());
  for (int n = 0; n < users; ++n)
    EXPECT_EQ (readFile (mesh (n)), readFile (mesh (users)));
  EXPECT_EQ (pcl::console::getVerbosityLevel (), level);
}
