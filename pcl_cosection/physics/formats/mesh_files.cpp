// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mesh_files.h"

#include <filesystem>
#include <system_error>

namespace pcl::cosection {

std::string
partName (const PhysicalBody& body, std::size_t part)
{
  return body.name + "_part_" + std::to_string (part);
}

std::string
meshFile (const std::string& mesh_name)
{
  return std::string (mesh_folder) + "/" + mesh_name + ".obj";
}

void
writeMeshFiles (const PhysicalScene& scene, SceneFolder& folder)
{
  for (const PhysicalBody& body : scene.bodies)
  {
    if (!body.visual.empty ())
      folder.write (meshFile (body.name), body.visual);
    for (std::size_t k = 0; k < body.parts.size (); ++k)
      folder.write (meshFile (partName (body, k)), body.parts[k]);
  }
}

void
removeFormerParts (const PhysicalScene& scene, const std::string& folder)
{
  std::error_code failure;
  for (const PhysicalBody& body : scene.bodies)
    for (std::size_t k = body.parts.size ();
         std::filesystem::remove (std::filesystem::path (folder) / meshFile (partName (body, k)), failure);)
      ++k;
}

} // namespace pcl::cosection
