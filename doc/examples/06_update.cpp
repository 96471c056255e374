// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Complete a scene again and again as views come; each update starts from the last one. 06_update [VIEW.pcd ...]
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/pcd_view.h>
#include <pcl/cosection/surface/co_section.h>

#include <iostream>

using namespace pcl::cosection;

int
main (int argc, char** argv)
try
{
  std::vector<std::string> files (argv + 1, argv + argc);
  if (files.empty ())
    files.assign (2, "doc/demo/table.pcd"); // the same view twice
  CoSection scene;
  for (const std::string& file : files)
  {
    const LabelledView view = readPcdView (file);
    if (view.view)
      scene.addView (*view.view);
    for (const auto& [label, object] : view.objects) // in all views the same
      if (label == 0)
        scene.addBackground (object.points);
      else
        scene.addPoints (static_cast<int> (label), object.points);
    const SceneResult result = scene.update ();
    for (const ObjectResult& object : result.objects)
      std::cout << file << ", object " << object.id << ": " << object.solver.iterations << " iterations\n";
  }
}
catch (const Error& error)
{
  std::cerr << error.what () << '\n';
  return 1;
}
