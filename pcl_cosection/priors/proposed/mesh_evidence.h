// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/priors/occlusion_map.h"
#include "sampled_mesh.h"
#include "thinned_points.h"
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/surface/co_section.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <vector>

namespace pcl::cosection {

/** \brief What a mesh is compared with, in the object's frame, metres. */
struct MeasuredObject
{
  const std::vector<OrientedPoint>& points;
  const OcclusionMap::Views& views;            ///< what they see free is not of the object
  const OcclusionMap& hidden;                  ///< where other things hide the object
  const std::vector<Eigen::Vector4d>& resting; ///< planes on which it rests: n.x + d = 0, unit n towards it
  double noise_m;                              ///< how far points may be from the surface
};

/** \brief A rotation, one scale and a translation. */
struct Similarity
{
  double scale = 1.0;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity ();
  Eigen::Vector3d t = Eigen::Vector3d::Zero ();

  Eigen::Vector3d operator* (const Eigen::Vector3d& p) const { return scale * (R * p) + t; }
};

/** \brief Judges a mesh by what was measured of an object. Similarities take the normalised mesh to the object. */
class MeshEvidence
{
public:
  static constexpr std::size_t least_points = 30;

  /** \param[in] mesh of any size, not empty */
  MeshEvidence (const TriangleMesh& mesh, const MeasuredObject& object);

  /** \brief Whether there are enough points. */
  bool isPossible () const;

  /** \brief How well the mesh fits, without its pose. \param[in] samples how many of the mesh's points are looked at */
  ProposalFit fit (const Similarity& similarity, Eigen::Index samples = SampledMesh::matched) const;

  /** \brief The similarity that leaves the mesh where it is. */
  Similarity inPlace () const;

protected:
  /** \brief Which samples the views should see, if nothing hides the object. */
  std::vector<Eigen::Index> visibleSamples (const Eigen::Matrix3d& R, Eigen::Index count) const;

  /** \brief Whether the views say nothing about a place on the mesh: something else hides it, or there is no reading.
   */
  bool isUnknown (const Eigen::Vector3d& p) const;

  /** \brief Whether a view looks through a place, also beside its pixel: readings at edges are mixed. */
  bool isFree (const Eigen::Vector3d& p, double margin_m) const;

  static constexpr double least_cosine = 0.3; // of normals that are of the same surface

  const MeasuredObject& object_;
  SampledMesh mesh_;
  OrientedColumns points_;
  double size_m_;
  double cell_m_; // between neighbouring points

private:
  std::vector<Eigen::Vector3d> sensors_; // from the middle of the points
};

/** \brief How well a mesh in an object's frame explains it; not at all if there are too few points. */
ProposalFit fitInPlace (const TriangleMesh& mesh, const MeasuredObject& object);

} // namespace pcl::cosection
