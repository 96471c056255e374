// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "copies.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/priors/shape/axes.h"
#include "pcl_cosection/priors/shape/flat_faces.h"
#include "pcl_cosection/priors/shape/half_spaces.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr float free_vox = 1.5f;       // a voxel at least so far from everything observed is free
constexpr float gap_vox = 2.0f;        // nothing is expected nearer to data
constexpr float far_vox = 6.0f;        // largest expected distance
constexpr float copy_weight = 10.0f;   // in multiples of beta_extent
constexpr std::size_t many = 4;        // of more motions, some may be wrong about a place
constexpr double of_many = 0.7;        // quantile of the distances that they give; of fewer the largest one counts
constexpr std::size_t least_known = 8; // of the motions: one in so many must know a place
constexpr int directions = 162;
constexpr std::size_t most_points = 2000; // for the convex hull
constexpr double outlier_share = 0.005;   // of the points, beyond each side of the hull
constexpr double hull_margin = 0.02;      // of the middle extent
constexpr double least_depth = 0.25;      // of an object, of the middle extent
constexpr double facing = -0.05;          // cosine from which a sensor sees where a side ends, or one of its copies
constexpr double downwards = -0.05;       // component upwards of the normals of sides that do not bound what stands on
                                          // a plane: other things may hide its foot

/** \brief What the motions tell of one place. */
struct CopiesAt
{
  double measured_sum = 0.0; // signed distances to copied surface, voxels
  int measured = 0, free = 0;
  std::vector<float> known; // signed distances of all motions that tell something

  bool isSurface () const { return measured > 0 && free <= measured; }
  float surfaceDistance () const { return static_cast<float> (measured_sum / measured); }

  /** \brief Distance that the surface has at least; nothing is known: 0. */
  float leastDistance (std::size_t motions)
  {
    if (known.empty () || (motions > many && known.size () * least_known < motions))
      return 0.0f;
    const std::size_t rank = motions > many ? static_cast<std::size_t> (of_many * static_cast<double> (known.size ()))
                                            : known.size () - 1;
    std::nth_element (known.begin (), known.begin () + static_cast<std::ptrdiff_t> (rank), known.end ());
    return std::max (0.0f, known[rank]);
  }
};

/** \brief What motions in voxel coordinates tell of a voxel. */
CopiesAt
copiesAt (const BodyEnergy& energy, const MeasuredShape& shape, const Motions& motions, const Eigen::Vector3d& voxel)
{
  CopiesAt copies;
  const Eigen::Array3d end = energy.grid.dims.cast<double> ().array () - 0.5;
  for (const Eigen::Affine3d& motion : motions)
  {
    const Eigen::Vector3d from = motion * voxel;
    if (!((from.array () >= -0.5).all () && (from.array () < end).all ()))
      continue;
    const Eigen::Array3i at = (from.array () + 0.5).cast<int> ();
    const std::size_t n = energy.grid.index (at.x (), at.y (), at.z ());
    if (!energy.data[n] && !shape.known[n])
      continue;
    const auto value = shape.field.sampleVoxel (from);
    if (value && energy.data[n])
    {
      copies.measured_sum += *value;
      ++copies.measured;
    }
    else if (shape.known[n] && shape.field.values[n] > free_vox)
      ++copies.free;
    if (value && shape.known[n])
      copies.known.push_back (*value);
  }
  return copies;
}

/** \brief Unit vectors from the middle of an object to the sensors that saw it. */
std::vector<Eigen::Vector3d>
towardsSensors (const Observation& object)
{
  std::vector<Eigen::Vector3d> towards;
  for (const auto& [view, T_object_sensor] : object.views)
    towards.push_back ((T_object_sensor.translation () - object.box.center ()).normalized ());
  return towards;
}

/** \brief Half-spaces n.x <= s that hold the points and their copies but for a few outliers, for those directions along
 * which a sensor saw how far the object reaches, or how far a copy does; all, if no sensor is known. \param[in] up of
 * what stands on a plane, or zeros */
HalfSpaces
hullOfCopies (const Observation& object, const Motions& motions, const Eigen::Vector3d& up)
{
  const std::vector<OrientedPoint>& points = object.points ();
  std::vector<Eigen::Vector3d> some;
  for (std::size_t p = 0; p < points.size (); p += points.size () / most_points + 1)
    some.push_back (points[p].position.cast<double> ());
  Motions all = motions;
  all.push_back (Eigen::Affine3d::Identity ());
  const std::vector<Eigen::Vector3d> towards = towardsSensors (object);
  const auto rank = static_cast<std::ptrdiff_t> (outlier_share * static_cast<double> (some.size ()));
  HalfSpaces hull;
  std::vector<double> along (some.size ());
  const Eigen::Matrix3d axes = principalAxes (points,
                                              up.isZero () ? std::nullopt : std::optional<Eigen::Vector3d> (up));
  for (const Eigen::Vector3d& n : evenDirections (directions, axes))
  {
    const bool is_round = up.isZero () && motions.size () > many; // its profile was seen, ends and all
    const bool seen = is_round ||
                      (n.dot (up) >= downwards &&
                       (towards.empty () || std::any_of (all.begin (), all.end (), [&] (const Eigen::Affine3d& motion) {
                          const Eigen::Vector3d turned = motion.linear ().transpose () * n;
                          return std::any_of (towards.begin (), towards.end (), [&] (const Eigen::Vector3d& sensor) {
                            return turned.dot (sensor) > facing;
                          });
                        })));
    if (!seen)
      continue;
    double farthest = -std::numeric_limits<double>::infinity ();
    for (const Eigen::Affine3d& motion : all)
    {
      const Eigen::Vector3d turned = motion.linear ().transpose () * n;
      std::transform (some.begin (), some.end (), along.begin (),
                      [&] (const Eigen::Vector3d& p) { return turned.dot (p); });
      if (rank > 0)
        std::nth_element (along.begin (), along.begin () + rank, along.end (), std::greater<> ());
      const double reach = rank > 0 ? along[static_cast<std::size_t> (rank)]
                                    : *std::max_element (along.begin (), along.end ());
      farthest = std::max (farthest, reach + n.dot (motion.translation ()));
    }
    hull.add (n, farthest);
  }
  return hull;
}

} // namespace

void
addCopies (const BodyEnergy& energy, const MeasuredShape& shape, const Motions& motions, const Observation& object,
           const Eigen::Vector4d& plane, Proposal& proposal)
{
  const VoxelGrid& grid = energy.grid;
  const Eigen::Vector3d& extents_m = object.extents_m;
  const HalfSpaces hull = hullOfCopies (object, motions, plane.head<3> ());
  const double margin_m = std::max (hull_margin * extents_m[1],
                                    object.views.empty () ? 0.0 : least_depth * extents_m[1] - extents_m[2]);
  const float weight = copy_weight * static_cast<float> (energy.options.beta_extent);
  Eigen::Affine3d T_object_voxel = Eigen::Affine3d::Identity ();
  T_object_voxel.linear () *= grid.voxel_size_m;
  T_object_voxel.translation () = grid.origin_m;
  Motions in_voxels;
  for (const Eigen::Affine3d& motion : motions)
    in_voxels.push_back (T_object_voxel.inverse () * motion * T_object_voxel);
  parallelFor (0, grid.dims.z (), energy.options.threads, [&] (int k) {
    for (int j = 0; j < grid.dims.y (); ++j)
    {
      const std::vector<float> beyond_m = hull.beyond (grid, j, k);
      for (int i = 0; i < grid.dims.x (); ++i)
      {
        const std::size_t n = grid.index (i, j, k);
        if (energy.empty[n])
          continue;
        const auto beyond_vox = static_cast<float> ((beyond_m[static_cast<std::size_t> (i)] - margin_m) /
                                                    grid.voxel_size_m);
        proposal.least[n] = std::max (proposal.least[n], beyond_vox);
        if (beyond_vox >= far_vox) // there is no copy
          continue;
        CopiesAt copies = copiesAt (energy, shape, in_voxels, Eigen::Vector3d (i, j, k));
        proposal.surface[n] |= copies.isSurface ();
        if (energy.data_distance_vox[n] >= gap_vox)
        {
          if (copies.isSurface ())
          {
            proposal.weight[n] = weight;
            proposal.target[n] = std::min (copies.surfaceDistance (), far_vox);
          }
          else
            proposal.least[n] = std::max (proposal.least[n],
                                          std::min (copies.leastDistance (motions.size ()), far_vox));
        }
      }
    }
  });
}

} // namespace pcl::cosection
