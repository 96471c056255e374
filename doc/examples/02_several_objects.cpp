// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// All labelled objects of one view, completed together with the table. 02_several_objects [VIEW.pcd]
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/io/pcd_view.h>
#include <pcl/cosection/surface/co_section.h>

#include <iostream>

using namespace pcl::cosection;

int
main (int argc, char** argv)
try
{
  LabelledView view = readPcdView (argc > 1 ? argv[1] : "doc/demo/table.pcd");
  CoSection scene;
  if (view.view)
    scene.addView (*view.view); // what lies in front of its readings is free
  for (auto& [label, object] : view.objects)
    if (label == 0)
      scene.setBackground (object.points);
    else
      scene.addObject ({static_cast<int> (label), object.points, {}});
  for (const ObjectResult& object : scene.reconstruct ().objects)
    if (object.error.empty ())
    {
      saveMesh (object.mesh, "object_" + std::to_string (object.id) + ".ply");
      std::cout << "object " << object.id << ": " << 1000.0 * computeMassProperties (object.mesh).volume_m3
                << " litres\n";
    }
    else
      std::cerr << "object " << object.id << ": " << object.error << '\n';
}
catch (const Error& error)
{
  std::cerr << error.what () << '\n';
  return 1;
}
