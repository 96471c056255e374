// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "copy_evidence.h"

#include "pcl_cosection/common/lattice_cells.h"
#include "pcl_cosection/common/robust_weights.h"
#include "pcl_cosection/view/visibility/visibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr std::size_t most_samples = 1500;
constexpr double first_cell_vox = 2.0;  // a sample per cell; cells grow until there are few enough samples
constexpr double surface_vox = 1.5;     // distance of a copy that is on the surface
constexpr double surely_free_vox = 3.0; // distance from which a copy begins to be in free space ...
constexpr double free_range_vox = 1.5;  // ... and is so, after as much more
constexpr double free_sigmas = 5.0;     // the same in front of a reading, standard deviations of its depth ...
constexpr double free_range_sigmas = 3.0;
constexpr double largely_free = 0.3;  // a copy that is on the surface otherwise is in free space
constexpr double alike_cosine = 0.7;  // of two normals of one surface
constexpr double across_cosine = 0.3; // below it they are of two, ...
constexpr double other_side = -0.5;   // ... unless they are of two sides of a wall
constexpr double ramp_width = 0.2;    // around these cosines
constexpr double across_weight = 0.5; // of a copy on surface across it, as a contradiction

/** \brief What a measured shape says of a place, interpolated between voxels. */
struct Interpolated
{
  double distance_vox = 0.0, known = 0.0; // known: share of the voxels around that are; 0 outside the grid
  std::array<double, 8> values{};
  Eigen::Array3d share = Eigen::Array3d::Zero ();

  /** \brief Of unit length. */
  Eigen::Vector3d gradient () const
  {
    const auto difference = [&] (int along, int u, int v) {
      double sum = 0.0;
      for (const int i : {0, 1})
        for (const int j : {0, 1})
          sum += (i ? share[u] : 1.0 - share[u]) * (j ? share[v] : 1.0 - share[v]) *
                 (values[(1 << along) + (i << u) + (j << v)] - values[(i << u) + (j << v)]);
      return sum;
    };
    return Eigen::Vector3d (difference (0, 1, 2), difference (1, 0, 2), difference (2, 0, 1)).normalized ();
  }
};

Interpolated
interpolate (const MeasuredShape& shape, const Eigen::Vector3d& place)
{
  const VoxelGrid& grid = shape.field.grid;
  const Eigen::Vector3d at = grid.toVoxel (place);
  if (!((at.array () >= 0.0).all () && (at.array () < (grid.dims.array () - 1).cast<double> ()).all ()))
    return {};
  const Eigen::Vector3i low = at.cast<int> ();
  Interpolated result;
  result.share = at - low.cast<double> ();
  const Eigen::Array3d rest = 1.0 - result.share;
  const std::size_t first = grid.index (low.x (), low.y (), low.z ()), row = static_cast<std::size_t> (grid.dims.x ()),
                    layer = row * static_cast<std::size_t> (grid.dims.y ());
  const auto isKnown = [&] (std::size_t n) { return shape.known[n] || shape.known[n + 1]; };
  if (!isKnown (first) && !isKnown (first + row) && !isKnown (first + layer) && !isKnown (first + row + layer))
    return {};
  for (int corner = 0; corner < 8; ++corner)
  {
    const bool x = (corner & 1) != 0, y = (corner & 2) != 0, z = (corner & 4) != 0;
    const std::size_t n = first + (x ? 1 : 0) + (y ? row : 0) + (z ? layer : 0);
    const double weight = (x ? result.share.x () : rest.x ()) * (y ? result.share.y () : rest.y ()) *
                          (z ? result.share.z () : rest.z ());
    result.values[corner] = shape.field.values[n];
    result.distance_vox += weight * result.values[corner];
    result.known += weight * shape.known[n];
  }
  return result;
}

/** \brief From 0 to 1 around a cosine. */
double
ramp (double cosine, double around)
{
  return std::clamp (0.5 + (cosine - around) / ramp_width, 0.0, 1.0);
}

} // namespace

CopyJudge::CopyJudge (const MeasuredShape& shape, const std::vector<OrientedPoint>& points,
                      const Eigen::Vector4d& plane, const OcclusionMap::Views& views)
    : shape_ (shape)
    , plane_ (plane)
    , views_ (views)
{
  for (const auto& [view, T_object_sensor] : views)
  {
    T_sensor_object_.push_back (T_object_sensor.inverse ());
    nearest_m_.emplace_back (static_cast<std::size_t> (view->camera.width) * view->camera.height, 0.0f);
  }
  const VoxelGrid& grid = shape.field.grid;
  const Eigen::Vector3d middle = 0.5 *
                                 (grid.dims.cast<double> () - Eigen::Vector3d::Ones ()); // cells move with the grid
  for (double cell_vox = first_cell_vox;;
       cell_vox *= std::max (1.05, std::sqrt (static_cast<double> (samples_.size ()) / most_samples)))
  {
    samples_.clear ();
    OccupiedCells cells;
    for (const OrientedPoint& point : points)
    {
      const Eigen::Vector3d p = point.position.cast<double> ();
      if (!grid.nearest (p))
        continue;
      const auto cell = cellOf ((grid.toVoxel (p) - middle) / cell_vox);
      const std::size_t before = cells.size ();
      if (cell && cells.add (*cell) == before)
        samples_.push_back (point);
    }
    if (samples_.size () <= most_samples)
      break;
  }
}

/** \brief The nearest reading at a pixel and around it, metres; infinite if there is none. */
float
CopyJudge::nearestReading (std::size_t v, const Eigen::Array2i& pixel) const
{
  const DepthView& view = *views_[v].first;
  float& nearest_m = nearest_m_[v][static_cast<std::size_t> (pixel.y ()) * view.camera.width + pixel.x ()];
  if (nearest_m > 0.0f)
    return nearest_m;
  nearest_m = std::numeric_limits<float>::infinity ();
  for (int row = std::max (0, pixel.y () - 1); row <= std::min (view.camera.height - 1, pixel.y () + 1); ++row)
    for (int column = std::max (0, pixel.x () - 1); column <= std::min (view.camera.width - 1, pixel.x () + 1);
         ++column)
      if (const auto reading_m = static_cast<float> (view.at (column, row)); isReading (reading_m))
        nearest_m = std::min (nearest_m, reading_m);
  return nearest_m;
}

/** \brief How surely a view looks through a place: 0 to 1. At a depth edge the nearest reading around counts. */
double
CopyJudge::freeShare (const Eigen::Vector3d& place) const
{
  double most = 0.0;
  for (std::size_t v = 0; v < views_.size () && most < 1.0; ++v)
  {
    const Eigen::Vector3d p = T_sensor_object_[v] * place;
    const auto pixel = pixelOf (views_[v].first->camera, p);
    if (!pixel)
      continue;
    const double reading_m = nearestReading (v, *pixel);
    if (!std::isfinite (reading_m) || !(reading_m > p.z ()))
      continue;
    const double sigmas = (reading_m - p.z ()) / depthNoiseSigma (reading_m);
    most = std::max (most, std::min (1.0, (sigmas - free_sigmas) / free_range_sigmas));
  }
  return most;
}

void
CopyJudge::judge (const OrientedPoint& sample, const Eigen::Affine3d& motion, CopyEvidence& sums) const
{
  const VoxelGrid& grid = shape_.field.grid;
  const Eigen::Vector3d copy = motion * sample.position.cast<double> ();
  if (plane_.head<3> ().dot (copy) + plane_[3] < -surface_vox * grid.voxel_size_m)
  {
    sums.contradiction += 1.0;
    return;
  }
  if (const double free = freeShare (copy); free > largely_free)
  {
    sums.contradiction += free;
    return;
  }
  const Interpolated measured = interpolate (shape_, copy);
  const double distance_vox = measured.distance_vox, known = measured.known;
  if (!(known > 0.0))
    return;
  sums.contradiction += known * std::clamp ((distance_vox - surely_free_vox) / free_range_vox, 0.0, 1.0);
  if (!(std::abs (distance_vox) < surface_vox))
    return;
  const double nearness = known * tukeyWeight (distance_vox / surface_vox);
  const double cosine = (motion.linear () * sample.normal.cast<double> ()).dot (measured.gradient ());
  sums.support += nearness * ramp (cosine, alike_cosine);
  sums.contradiction += across_weight * nearness * (1.0 - ramp (cosine, across_cosine)) * ramp (cosine, other_side);
}

CopyEvidence
CopyJudge::judge (const Motions& motions, std::size_t stride) const
{
  Judgement judgement (motions, *this, stride);
  judgement.goOn (*this, std::numeric_limits<std::size_t>::max ());
  return judgement.evidence ();
}

Judgement::Judgement (Motions motions, const CopyJudge& judge, std::size_t stride)
    : motions_ (std::move (motions))
    , stride_ (stride)
    , copies_ (motions_.size () * ((judge.samples ().size () + stride - 1) / stride))
{}

void
Judgement::goOn (const CopyJudge& judge, std::size_t copies)
{
  for (const std::size_t end = judged_ + std::min (copies, copies_ - judged_); judged_ < end; ++judged_)
  {
    judge.judge (judge.samples_[sample_], motions_[motion_], sums_);
    sample_ += stride_;
    if (sample_ < judge.samples_.size ())
      continue;
    sample_ = 0;
    ++motion_;
  }
}

CopyEvidence
Judgement::evidence () const
{
  const double per_copy = copies_ > 0 ? 1.0 / static_cast<double> (copies_) : 0.0;
  return {per_copy * sums_.support, per_copy * sums_.contradiction};
}

double
Judgement::most () const
{
  constexpr double rounding = 1e-9;
  if (motions_.empty ())
    return -std::numeric_limits<double>::infinity ();
  CopyEvidence most = evidence ();
  if (isDone ())
    return most.logLikelihoodRatio ();
  most.support += static_cast<double> (copies_ - judged_) /
                  static_cast<double> (copies_); // if all that are left support
  return most.logLikelihoodRatio () + rounding;
}

} // namespace pcl::cosection
