// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/simulation/simulated_scene.h>

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/volume/mesh_distance.h>

#include "analytic_shape.h"
#include "pcl_cosection/mesh/mesh_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr int grid_resolution = 96; // voxels along the longest side of a mesh
constexpr int grid_margin = 4;      // voxels around it
constexpr double band_voxels = 12;  // up to which its distance is exact

class MeshShape : public Shape
{
public:
  MeshShape (TriangleMesh mesh, double scale) : mesh_ (std::move (mesh))
  {
    positive (scale, "scale");
    if (mesh_.empty ())
      throw InvalidArgument ("the mesh has no triangles");
    Eigen::AlignedBox3d box;
    for (Eigen::Vector3f& v : mesh_.vertices)
    {
      v *= static_cast<float> (scale);
      if (!v.allFinite ())
        throw InvalidArgument ("the mesh has a vertex that is not finite");
    }
    checkMesh (mesh_);
    for (const TriangleMesh::Triangle& t : mesh_.triangles)
      for (const std::uint32_t v : t)
        box.extend (mesh_.vertices[v].cast<double> ());
    const double longest = box.sizes ().maxCoeff ();
    if (!(longest > 0.0))
      throw InvalidArgument ("the mesh has no extent");
    VoxelGrid grid;
    grid.voxel_size_m = longest / grid_resolution;
    grid.origin_m = box.min () - Eigen::Vector3d::Constant (grid_margin * grid.voxel_size_m);
    grid.dims = ((box.sizes () / grid.voxel_size_m).array ().ceil ().cast<int> () + 2 * grid_margin + 1).matrix ();
    try
    {
      field_ = sampleSignedDistance (mesh_, grid, band_voxels * grid.voxel_size_m);
    }
    catch (const InvalidArgument&)
    {
      field_.values.clear (); // its triangles disagree on what is outside
    }
  }

  double distance (const Eigen::Vector3d& p) const override
  {
    if (field_.values.empty ())
      return std::numeric_limits<double>::infinity ();
    const Eigen::Vector3d low = field_.grid.center (0, 0, 0);
    const Eigen::Vector3i last = field_.grid.dims - Eigen::Vector3i::Ones ();
    const Eigen::Vector3d high = field_.grid.center (last.x (), last.y (), last.z ());
    const Eigen::Vector3d inside = p.cwiseMax (low).cwiseMin (high);
    return field_.sample (inside).value_or (std::numeric_limits<float>::infinity ()) + (p - inside).norm ();
  }

  bool isSupported (const Eigen::Vector3d& p) const override
  {
    return !field_.values.empty () && field_.sampleSupported (p).has_value ();
  }

  bool isAnalytic () const override { return false; }

  TriangleMesh tessellate (double) const override { return mesh_; }

private:
  TriangleMesh mesh_;
  SignedDistanceField field_; // empty: nothing is known to be inside
};

} // namespace

Shape::~Shape () = default;

bool
Shape::isSupported (const Eigen::Vector3d&) const
{
  return true;
}

Shape::ConstPtr
makeMeshShape (TriangleMesh mesh, double scale)
{
  return std::make_shared<MeshShape> (std::move (mesh), scale);
}

} // namespace pcl::cosection
