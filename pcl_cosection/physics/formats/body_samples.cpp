// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "body_samples.h"

#include "pcl_cosection/io/cloud/pcd_writer.h"
#include "pcl_cosection/io/npy.h"
#include "pcl_cosection/mesh/even_samples.h"
#include "pcl_cosection/mesh/moved_mesh.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include "scene_json.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/volume/mesh_distance.h>

#include <string>
#include <vector>

namespace pcl::cosection {
namespace {

constexpr double most_voxels = 1e9; // which take 4 GB, and as much again to be written

/** \brief The values with the last index fastest, as NumPy has them. */
std::vector<float>
lastIndexFastest (const SignedDistanceField& field)
{
  const VoxelGrid& grid = field.grid;
  std::vector<float> values;
  values.reserve (grid.size ());
  for (int i = 0; i < grid.dims.x (); ++i)
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int k = 0; k < grid.dims.z (); ++k)
        values.push_back (field.values[grid.index (i, j, k)]);
  return values;
}

} // namespace

void
writeBodyPoints (const PhysicalBody& body, std::size_t count, int threads, SceneFolder& folder)
{
  const TriangleMesh points = movedMesh (sampleEvenly (body.visual, count, threads), body.T_scene_body);
  folder.write ("points/" + body.name + ".pcd", encodePcd (points));
}

void
writeBodyDistance (const PhysicalBody& body, double voxel_size_m, double margin_m, int threads, SceneFolder& folder)
{
  const Eigen::AlignedBox3d box = vertexBox (body.visual);
  VoxelGrid grid;
  grid.voxel_size_m = voxel_size_m;
  const Eigen::Array3d voxels = ((box.sizes ().array () + 2.0 * margin_m) / voxel_size_m).ceil () + 1.0;
  if (!(voxels.prod () <= most_voxels))
    throw InvalidArgument (body.name + ": its signed distance would need more than " +
                           std::to_string (static_cast<long> (most_voxels)) + " voxels; make the margin smaller");
  grid.dims = voxels.cast<int> ();
  grid.origin_m = box.center () - 0.5 * voxel_size_m * (grid.dims.array () - 1).cast<double> ().matrix ();
  const double everywhere_m = (grid.dims.cast<double> () * voxel_size_m).norm ();
  const SignedDistanceField field = sampleSignedDistance (body.visual, grid, everywhere_m, threads);

  const std::string stem = "sdf/" + body.name;
  const std::vector<std::size_t> shape (grid.dims.data (), grid.dims.data () + grid.dims.size ());
  folder.write (stem + ".npy", encodeNpy (lastIndexFastest (field), shape));
  folder.write (stem + ".vti", field);
  const nlohmann::ordered_json json = {
      {"body", body.name},
      {"array", body.name + ".npy"},
      {"shape", shape},
      {"origin_m", toJson (grid.origin_m)},
      {"voxel_size_m", voxel_size_m},
      {"units", "metres"},
      {"sign", "positive outside"},
      {"frame", "that of the body: the axes of the scene, the origin at the position of T_scene_body in scene.json"},
      {"meaning", "array[i, j, k] is the signed distance at origin_m + voxel_size_m * (i, j, k)"}};
  folder.write (stem + ".json", jsonText (json, 1));
}

} // namespace pcl::cosection
