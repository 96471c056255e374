// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "pcl_cosection/energy/data/shape_evidence.h"
#include "pcl_cosection/priors/normal_bin_occupancy.h"
#include "pcl_cosection/priors/occlusion_map.h"
#include "quarter_resolution.h"

#include "pcl_cosection/priors/extent_prior.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/surface/options.h>
#include <pcl/cosection/surface/solver.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <Eigen/Geometry>

#include <utility>
#include <vector>

namespace pcl::cosection
{

/** \brief A plane to be continued where it was not seen, and the region in which to do so. */
struct PlaneContinuation
{
  Eigen::Vector4d plane;      // unit normal towards free space, the grid's frame
  Eigen::AlignedBox3d region; // the grid's frame
};

/** \brief How finely a body is solved. */
enum class Resolution
{
  Half, ///< a step on the way, eight times cheaper
  Full,
};

/** \brief One body, an object or a piece of background, from what was measured of it to a mesh: its energy on its
 * grid, and the field that minimises it. Everything is in the grid's frame.
 *
 * Use: prepare (); then any number of setIntersection () and solve (), each warm-started from the last; then
 * closedMesh (). All of it again when there is more evidence. */
class ShapeVolume
{
public:
  ShapeVolume (const VoxelGrid& grid, const CoSectionOptions& options);

  /** \brief Bytes that a volume of so many voxels needs at its peak, generously. */
  static std::size_t estimateBytes (const VoxelGrid& grid);

  /** \brief Start from the shape of another volume, whose lattice is the same. */
  void startFrom (const ShapeVolume& other);

  /** \brief Turn the measurements into the energy's terms, instead of earlier ones. */
  void prepare (const ShapeEvidence& evidence, const std::vector<PlaneContinuation>& planes = {});

  /** \brief Expect nothing where views show that the object is not, though they have no readings there: 1 per such
   * voxel; after prepare (). */
  void setRaysWithoutReturn (const std::vector<std::uint8_t>& open);

  /** \brief Add the pull that prevents swelling; after prepare (). \param[in] extents_m observedExtents () of the
   * points */
  void addExtentPrior (const ExtentPrior& prior, const Eigen::Vector3d& extents_m, OcclusionMap& places,
                       const std::vector<SymmetricExtent>& plausible);

  /** \brief Prefer surface where copies of the points make it likely, weakly, where nothing was seen; after prepare ().
   */
  void addHiddenSide (const SymmetricExtent& plausible, const std::vector<OrientedPoint>& points);

  /** \brief Let the object rest on a support plane where that is hidden; after prepare (). */
  void addContactPrior (const std::vector<OrientedPoint>& points, const Eigen::Vector4d& plane,
                        const Eigen::Vector3d& center);

  void setIntersection (std::vector<LowerBound> bounds);

  /** \brief Minimise, from the last solution if there is one. */
  SolverSummary solve (Resolution resolution, const ProgressCallback& progress);

  /** \brief The same after more evidence, for a body of which only what is near data is used: everywhere on voxels of
   * four times the size, and at full resolution near data where that has changed. The first time, or where most has
   * changed, as solve (). */
  SolverSummary follow (const ProgressCallback& progress);

  /** \brief How large a part of the voxels the last follow () solved at full resolution. */
  double solvedShare () const { return solved_share_; }

  /** \brief 1 where seen free. */
  const std::vector<std::uint8_t>& freeSpace () const { return free_space_; }

  const VoxelGrid& grid () const { return grid_; }

  const CoSectionOptions& options () const { return options_; }

  /** \brief Whether solve () has been called for this resolution, or a finer one. */
  bool solved (Resolution resolution) const
  {
    return !u_.empty () && (resolution == Resolution::Half || solved_fully_);
  }

  /** \brief Whether the energy has changed since solve (). */
  bool changed () const { return changed_; }

  bool hasData () const;

  /** \brief sum w f / sum w, supported where there is data: what the measurements alone say. */
  SignedDistanceField measuredField () const;

  /** \brief The minimiser, less what was carved off; supported within reach of data and where not seen free. */
  SignedDistanceField solvedField () const;

  /** \brief Closed mesh of the minimiser with provenance and confidence; without parts that have no data. */
  TriangleMesh closedMesh () const;

  /** \brief Closed mesh of the part of the minimiser's body that lies just behind points. */
  TriangleMesh innerMesh (const std::vector<OrientedPoint>& points) const;

  /** \brief Open mesh of the minimiser where it is supported, no farther from \a points and continued planes than
   * evidence reaches. */
  TriangleMesh trimmedMesh (const std::vector<OrientedPoint>& points) const;

private:
  /** \brief Voxels, to data, or to where walls are expected behind others, and to what they enclose. */
  std::vector<float> distanceToExpected (const std::vector<SymmetricExtent>& plausible) const;
  /** \brief f (index) for every voxel, planes of them on several threads. */
  template <typename Function> void forEachVoxel (Function&& f) const;
  float carvedValue (std::size_t n) const;
  /** \brief Zero set of a field, value (n) in voxels. */
  template <typename Value> TriangleMesh closedMeshOf (Value&& value) const;
  /** \brief Without parts that have no data, and without small_components. */
  TriangleMesh observedParts (const TriangleMesh& mesh) const;
  std::vector<std::uint8_t> supported () const;
  void attachEvidence (TriangleMesh& mesh) const;

  VoxelGrid grid_;
  CoSectionOptions options_;
  EnergyProblem problem_;
  std::vector<std::uint8_t> free_space_;
  std::vector<std::uint8_t> empty_;     // there, and where nothing is expected
  std::vector<std::uint8_t> data_;      // 1 where points are near
  std::vector<std::uint8_t> continued_; // 1 on continued planes; empty: there are none
  std::vector<float> data_distance_vox_;
  NormalBinOccupancy facing_; // of thin walls; or empty
  std::vector<float> carved_; // signed distance to free space, voxels; or empty
  std::vector<float> half_u_; // at half the resolution, voxels of grid_
  QuarterResolution quarter_; // of follow ()
  std::vector<float> u_;      // voxels
  bool solved_fully_ = false;
  double solved_share_ = 1.0;
  bool changed_ = true;
};

} // namespace pcl::cosection
