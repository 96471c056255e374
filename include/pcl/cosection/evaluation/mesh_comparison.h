// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief How to compare meshes. */
struct PCL_COSECTION_EXPORT MeshComparisonOptions
{
  std::size_t samples = 10000; ///< on each mesh
  std::uint64_t seed = 0;      ///< of the samples
  double f_threshold_m = 0.01; ///< of precision, recall and F-score
  int threads = 0;             ///< 0: all

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief What distances, or angles, of a set are like; of none, all are 0. */
struct PCL_COSECTION_EXPORT ErrorStatistics
{
  double mean = 0.0;   ///< arithmetic mean
  double rmse = 0.0;   ///< root of the mean square
  double median = 0.0; ///< 50 % are at most this large
  double p95 = 0.0;    ///< 95 % are at most this large
  double max = 0.0;    ///< the largest
};

/** \brief Quantiles are interpolated linearly between the sorted values. */
PCL_COSECTION_EXPORT ErrorStatistics errorStatistics (std::vector<double> values);

/** \brief How near two surfaces are to each other, metres. */
struct PCL_COSECTION_EXPORT MeshComparison
{
  ErrorStatistics accuracy;     ///< from samples of the reconstruction to the truth
  ErrorStatistics completeness; ///< from samples of the truth to the reconstruction
  double precision = 0.0;       ///< share of the reconstruction's samples nearer than the threshold
  double recall = 0.0;          ///< share of the truth's samples nearer than the threshold
  double f_score = 0.0;         ///< harmonic mean of the two
};

/** \brief Accuracy and completeness of a reconstruction: the mean exact distances of area-uniform samples of one mesh
 * to the triangles of the other (D. Stutz, A. Geiger, "Learning 3D Shape Completion Under Weak Supervision", IJCV
 * 2020), and the F-score (A. Knapitsch et al., "Tanks and Temples", TOG 2017), which has samples within the threshold,
 * it included.
 *
 * \code
 * const MeshComparison comparison = compareMeshes (loadMesh ("truth.ply"), loadMesh ("completed.ply"));
 * std::cout << comparison.accuracy.mean << " m, " << comparison.completeness.mean << " m, " << comparison.f_score;
 * \endcode
 *
 * A mesh of vertices without triangles, as a scan, is a set of points: its samples are points of it, evenly along their
 * order, and distances to it are those to its nearest point, which are no smaller than about half of their spacing.
 *
 * Both meshes are in one frame; they may be open. The result is the same for any number of threads.
 * \throws InvalidArgument if a triangle refers to no vertex, a vertex is not finite, or an option is outside its domain
 * \throws DegenerateInput if a mesh has no area */
PCL_COSECTION_EXPORT MeshComparison compareMeshes (const TriangleMesh& truth, const TriangleMesh& reconstruction,
                                                   const MeshComparisonOptions& options = {});

/** \brief What a mesh is like by itself. */
struct PCL_COSECTION_EXPORT MeshSummary
{
  std::size_t vertices = 0;              ///< that triangles refer to
  std::size_t triangles = 0;             ///< number of them
  MeshTopology topology;                 ///< what the connectivity says
  double area_m2 = 0.0;                  ///< of all triangles
  std::optional<double> volume_m3;       ///< of a closed manifold only
  std::optional<double> point_spacing_m; ///< of a set of points: median distance to the nearest other one
  Eigen::AlignedBox3d box;               ///< metres
};

/** \brief Describe a mesh, or a set of points. \throws InvalidArgument, DegenerateInput as compareMeshes () */
PCL_COSECTION_EXPORT MeshSummary summarizeMesh (const TriangleMesh& mesh);

/** \brief Lines that say why a comparison may mean nothing: the boxes do not overlap, or one mesh is about a thousand
 * times as large as the other (metres and millimetres). Empty if all is well. */
PCL_COSECTION_EXPORT std::vector<std::string> frameWarnings (const MeshSummary& truth,
                                                             const MeshSummary& reconstruction);

/** \brief The mesh in another frame: vertices and normals. */
PCL_COSECTION_EXPORT TriangleMesh transformMesh (TriangleMesh mesh, const Eigen::Isometry3d& T_target_mesh);

} // namespace pcl::cosection
