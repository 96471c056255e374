// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "learned_completion.h"

#include "completion_cube.h"
#include "pcl_cosection/mesh/mesh_parts.h"
#include "pcl_cosection/mesh/moved_mesh.h"
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

} // namespace

CompletionNetwork::~CompletionNetwork () = default;

TriangleMesh
completedByNetwork (const CompletionNetwork& network, const std::vector<OrientedPoint>& points,
                    const SensorViews& views, const Eigen::Vector4d& plane)
{
  const std::optional<CompletionCube> cube = completionCube (points, views, plane);
  if (!cube)
    return {};
  const CompletionInputs inputs = completionInputs (*cube, points, views);
  const std::vector<float> logits = network.complete (observedValues (inputs, false));
  const std::vector<float> of_mirror = network.complete (observedValues (inputs, true));
  if (logits.size () != CompletionCube::voxels || of_mirror.size () != CompletionCube::voxels)
    throw InvalidArgument ("the completion network answers with " + std::to_string (logits.size ()) + " values; " +
                           std::to_string (CompletionCube::voxels) + " are needed");
  SignedDistanceField field;
  field.grid.dims.setConstant (N);
  field.grid.voxel_size_m = cube->voxel_size_m;
  field.grid.origin_m = Eigen::Vector3d::Constant (0.5 * cube->voxel_size_m);
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
  return movedMesh (std::move (mesh), cube->T_object_cube);
}

} // namespace pcl::cosection
