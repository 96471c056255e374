// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "learned_completion.h"

#include "completion_cube.h"
#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/mesh/mesh_parts.h"
#include "pcl_cosection/mesh/moved_mesh.h"
#include "pcl_cosection/priors/rays_without_return.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/volume/iso_surface.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr int N = CompletionCube::size;
constexpr float soft_vox = 0.4f; // of a logit: SOFT_VOX of tools/prior_training/train.py
constexpr auto truncation = static_cast<float> (CompletionCube::truncation_vox);
// Odds of exp (2) : 1 = 7.4 : 1 that the other priors are right about a place; on scanned things and real views 1 to 5
// make no difference.
constexpr float reliable_vox = 2.0f * soft_vox;
// Networks end early what they do not know. With this real views have an F-score at 1 cm of 0.956, without 0.949.
constexpr float early_vox = 0.25f;
constexpr double least_part = 0.05; // of the largest part's volume: less is a network's noise

/** \brief The voxel that a mirror across the direction of view takes n to. */
std::size_t
mirrored (std::size_t n)
{
  const auto size = static_cast<std::size_t> (N);
  const std::size_t i = n % size, j = n / size % size, rest = n / (size * size);
  return (rest * size + size - 1 - j) * size + i;
}

/** \brief The input of the network. */
std::vector<float>
observedValues (const CompletionInputs& inputs, bool mirror)
{
  std::vector<float> observed (CompletionNetwork::channels * CompletionCube::voxels);
  for (std::size_t n = 0; n < CompletionCube::voxels; ++n)
  {
    const std::size_t m = mirror ? mirrored (n) : n;
    observed[m] = inputs.distance[n];
    observed[CompletionCube::voxels + m] = inputs.is_free[n];
    observed[2 * CompletionCube::voxels + m] = inputs.is_behind[n];
    observed[3 * CompletionCube::voxels + m] = inputs.is_unknown[n];
  }
  return observed;
}

TriangleMesh
withoutSmallParts (const TriangleMesh& mesh)
{
  const std::vector<MeshPart> parts = divideMesh (mesh);
  double largest = 0.0;
  for (const MeshPart& part : parts)
    largest = std::max (largest, part.volume_m3);
  std::vector<std::uint32_t> kept;
  for (const MeshPart& part : parts)
    if (std::abs (part.volume_m3) >= least_part * largest)
      kept.insert (kept.end (), part.triangles.begin (), part.triangles.end ());
  return selectTriangles (mesh, kept);
}

/** \brief Count rays without a reading beside an object that was cut out as free. \param[in] grid in the cube's frame
 */
void
addRaysWithoutReturn (const VoxelGrid& grid, const Eigen::Isometry3d& T_cube_object, std::vector<OrientedPoint> points,
                      const SensorViews& views, CompletionInputs& inputs)
{
  SensorViews in_cube = views;
  for (OrientedPoint& point : points)
    point.position = T_cube_object.cast<float> () * point.position;
  for (auto& [view, T_sensor] : in_cube)
    T_sensor = T_cube_object * T_sensor;
  const std::vector<std::uint8_t> open = findRaysWithoutReturn (grid, in_cube, points, 1);
  for (std::size_t n = CompletionCube::index (0, 0, CompletionCube::below_vox); n < open.size (); ++n)
    if (open[n] && inputs.is_unknown[n])
    {
      inputs.is_free[n] = 1;
      inputs.is_unknown[n] = 0;
    }
}

} // namespace

CompletionNetwork::~CompletionNetwork () = default;

LearnedCompletion
completedByNetwork (const CompletionNetwork& network, const std::vector<OrientedPoint>& points,
                    const SensorViews& views, const Eigen::Vector4d& plane, bool is_cut_out)
{
  LearnedCompletion result;
  const std::optional<CompletionCube> cube = completionCube (points, views, plane);
  if (!cube)
    return result;
  CompletionInputs inputs = completionInputs (*cube, points, views);
  SignedDistanceField& field = result.field;
  field.grid.dims.setConstant (N);
  field.grid.voxel_size_m = cube->voxel_size_m;
  field.grid.origin_m = Eigen::Vector3d::Constant (0.5 * cube->voxel_size_m);
  result.T_cube_object = cube->T_object_cube.inverse ();
  if (is_cut_out)
    addRaysWithoutReturn (field.grid, result.T_cube_object, points, views, inputs);
  const std::vector<float> logits = network.complete (observedValues (inputs, false));
  const std::vector<float> of_mirror = network.complete (observedValues (inputs, true));
  if (logits.size () != CompletionCube::voxels || of_mirror.size () != CompletionCube::voxels)
    throw InvalidArgument ("the completion network answers with " + std::to_string (logits.size ()) + " values; " +
                           std::to_string (CompletionCube::voxels) + " are needed");
  field.values.resize (CompletionCube::voxels);
  const double below_m = CompletionCube::below_vox * cube->voxel_size_m;
  for (std::size_t n = 0; n < CompletionCube::voxels; ++n)
  {
    const float logit = 0.5f * (logits[n] + of_mirror[mirrored (n)]);
    float vox = std::clamp (-soft_vox * logit, -truncation, truncation);
    if (inputs.is_free[n])
      vox = std::max (vox, inputs.distance[n] > 0.0f ? truncation * inputs.distance[n] : 0.5f);
    const double height_m = field.grid.voxel_size_m * (static_cast<double> (n / (N * N)) + 0.5) - below_m;
    vox = std::max (vox, static_cast<float> (-height_m / cube->voxel_size_m));
    field.values[n] = vox * static_cast<float> (cube->voxel_size_m);
  }
  TriangleMesh mesh = withoutSmallParts (extractIsoSurface (field, {true, 1}));
  mesh.normals.clear ();
  result.mesh = movedMesh (std::move (mesh), cube->T_object_cube);
  return result;
}

SignedDistanceField
correctedDistance (const LearnedCompletion& learned, SignedDistanceField expected, int threads)
{
  const VoxelGrid& grid = expected.grid;
  const auto cube_voxel_m = static_cast<float> (learned.field.grid.voxel_size_m);
  const float most_m = reliable_vox * cube_voxel_m, early_m = early_vox * cube_voxel_m;
  parallelFor (0, grid.dims.z (), threadsForVoxels (threads, grid.size ()), [&] (int k) {
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
        if (const auto learned_m = learned.field.sample (learned.T_cube_object * grid.center (i, j, k)))
        {
          // The log odds of a distance d in the cube's voxels are -d / soft_vox.
          float& value_m = expected.values[grid.index (i, j, k)];
          value_m = std::clamp (value_m, -most_m, most_m) + *learned_m - early_m;
        }
  });
  // The sum of two distances grows up to twice as fast as one.
  SignedDistanceField distance = expected;
  parallelFor (0, grid.dims.z (), threadsForVoxels (threads, grid.size ()), [&] (int k) {
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        const auto cell = TrilinearCell<double>::around (expected, grid.center (i, j, k));
        const double slope = cell ? cell->gradient ().norm () : 1.0;
        distance.values[grid.index (i, j, k)] /= static_cast<float> (std::max (1.0, slope));
      }
  });
  return distance;
}

} // namespace pcl::cosection
