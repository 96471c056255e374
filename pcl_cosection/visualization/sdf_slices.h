// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Core>

#include <array>

namespace pcl::cosection {

/** \brief The colour of a signed distance: blue inside, white at the surface, red outside from \a limit_m on. */
TriangleMesh::Colour distanceColour (double distance_m, double limit_m);

/** \brief A cut through the signed distance of a body. */
struct PCL_COSECTION_EXPORT SdfSlice
{
  Picture picture; ///< its first pixel is at the first corner, rows go along the way to the second
  std::array<Eigen::Vector3f, 4> corners; ///< around it; metres, the mesh's frame
};

/** \brief The signed distance of a mesh on planes across each axis of its frame, to look into a body. */
class PCL_COSECTION_EXPORT SdfSlices
{
public:
  /** \brief Sample the distance in a box around the mesh, a quarter larger on each side.
   * \param[in] voxels along the longest side \param[in] threads 0: all
   * \throws InvalidArgument as sampleSignedDistance () */
  explicit SdfSlices (const TriangleMesh& mesh, int voxels = 72, int threads = 0);

  /** \brief The plane across an axis (0: x). \param[in] share where: 0 is one side of the box, 1 the other; beyond,
   * that
   * \param[in] pixels along the longer side of the picture */
  SdfSlice slice (int axis, double share, int pixels = 192) const;

private:
  SignedDistanceField field_;
  double limit_m_ = 0.0; ///< at which colours end
};

} // namespace pcl::cosection
