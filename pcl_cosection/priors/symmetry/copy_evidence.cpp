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

constexpr std::size_t least_samples = 20, most_samples = 1500;
constexpr double first_cell_vox = 2.0;  // a sample per cell; cells grow until there are few enough samples
constexpr double surface_vox = 1.5;     // distance of a copy that is on the surface
constexpr double surely_free_vox = 3.0; // distance from which a copy begins to be in free space ...
constexpr double free_range_vox = 1.5;  // ... and is so, after as much more
constexpr double free_sigmas = 5.0;     // the same in front of a reading, standard deviations of its depth ...
constexpr double free_range_sigmas = 3.0;
constexpr double least_noise = 0.4;   // of a sensor's working range: the depth with the least noise
constexpr double largely_free = 0.3;  // a copy that is on the surface otherwise is in free space
constexpr double alike_cosine = 0.7;  // of two normals of one surface
constexpr double across_cosine = 0.3; // below it they are of two, ...
constexpr double other_side = -0.5;   // ... unless they are of two sides of a wall
constexpr double ramp_width = 0.2;    // around these cosines
constexpr double across_weight = 0.5; // of a copy on surface across it, as a contradiction

enum Known : std::uint8_t
{
  None,
  Some,
  All
};

/** \brief What a measured shape says of a place, interpolated between voxels. */
struct Interpolated
{
  double distance_vox = 0.0, known = 0.0; // known: share of the voxels around that are; 0 outside the grid
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero ();
};

/** \brief The trilinear function of the values at the corners of a voxel, x fastest, and its gradient.
 * \param[in] share of the way from the lowest corner to the highest */
inline std::pair<double, Eigen::Vector3d>
trilinear (const std::array<double, 8>& values, const Eigen::Vector3d& share)
{
  std::array<double, 4> along, slopes; // of the edges along x
  for (std::size_t edge = 0; edge < 4; ++edge)
  {
    slopes[edge] = values[2 * edge + 1] - values[2 * edge];
    along[edge] = values[2 * edge] + share.x () * slopes[edge];
  }
  const auto between = [] (double low, double high, double by) { return low + by * (high - low); };
  const double low = between (along[0], along[1], share.y ()), high = between (along[2], along[3], share.y ());
  return {between (low, high, share.z ()),
          {between (between (slopes[0], slopes[1], share.y ()), between (slopes[2], slopes[3], share.y ()), share.z ()),
           between (along[1] - along[0], along[3] - along[2], share.z ()), high - low}};
}

inline Interpolated
interpolate (const MeasuredShape& shape, const std::vector<std::uint8_t>& known_between, const Eigen::Vector3d& place)
{
  const VoxelGrid& grid = shape.field.grid;
  const Eigen::Vector3d at = (place - grid.origin_m) * (1.0 / grid.voxel_size_m);
  if (!((at.array () >= 0.0).all () && (at.array () < (grid.dims.array () - 1).cast<double> ()).all ()))
    return {};
  const Eigen::Vector3i low = at.cast<int> ();
  const std::size_t first = grid.index (low.x (), low.y (), low.z ()), row = static_cast<std::size_t> (grid.dims.x ()),
                    layer = row * static_cast<std::size_t> (grid.dims.y ());
  const std::uint8_t known = known_between[first];
  if (known == Known::None)
    return {};
  const std::array<std::size_t, 8> corners = {
      first,         first + 1,         first + row,         first + row + 1,
      first + layer, first + layer + 1, first + layer + row, first + layer + row + 1};
  std::array<double, 8> values;
  std::transform (corners.begin (), corners.end (), values.begin (),
                  [&] (std::size_t n) { return static_cast<double> (shape.field.values[n]); });
  const Eigen::Vector3d share = at - low.cast<double> ();
  const auto [distance_vox, gradient] = trilinear (values, share);
  if (known == Known::All)
    return {distance_vox, 1.0, gradient};
  std::transform (corners.begin (), corners.end (), values.begin (),
                  [&] (std::size_t n) { return static_cast<double> (shape.known[n]); });
  return {distance_vox, trilinear (values, share).first, gradient};
}

/** \brief Per voxel, how many of the eight are known of which it is the lowest. */
std::vector<std::uint8_t>
knownBetween (const MeasuredShape& shape)
{
  std::vector<std::uint8_t> any = shape.known, all = shape.known;
  const auto row = static_cast<std::size_t> (shape.field.grid.dims.x ());
  for (const std::size_t step : {std::size_t (1), row, row * static_cast<std::size_t> (shape.field.grid.dims.y ())})
    for (std::size_t n = 0; n + step < any.size (); ++n)
    {
      any[n] |= any[n + step];
      all[n] &= all[n + step];
    }
  std::transform (any.begin (), any.end (), all.begin (), any.begin (), [] (std::uint8_t one, std::uint8_t every) {
    return static_cast<std::uint8_t> (every ? Known::All : one ? Known::Some : Known::None);
  });
  return any;
}

/** \brief A point moved to the measured surface, which averages the noise of many. A point that noise takes outwards
 * has copies in free space even where the motion is right. */
OrientedPoint
onSurface (const MeasuredShape& shape, const std::vector<std::uint8_t>& known_between, OrientedPoint point)
{
  const Interpolated measured = interpolate (shape, known_between, point.position.cast<double> ());
  if (measured.known > 0.0)
    point.position -= (measured.distance_vox * shape.field.grid.voxel_size_m * measured.gradient.stableNormalized ())
                          .cast<float> ();
  return point;
}

/** \brief Metres; 0 without readings. */
float
farthestReading (const DepthView& view)
{
  float farthest_m = 0.0f;
  for (const float reading_m : view.depth)
    if (isReading (reading_m))
      farthest_m = std::max (farthest_m, reading_m);
  return farthest_m;
}

/** \brief From 0 to 1 around a cosine. */
inline double
ramp (double cosine, double around)
{
  return std::clamp (0.5 + (cosine - around) * (1.0 / ramp_width), 0.0, 1.0);
}

} // namespace

CopyJudge::CopyJudge (const MeasuredShape& shape, const std::vector<OrientedPoint>& points,
                      const Eigen::Vector4d& plane, const OcclusionMap::Views& views)
    : shape_ (shape)
    , plane_ (plane)
    , views_ (views)
    , known_between_ (knownBetween (shape))
{
  for (const auto& [view, T_object_sensor] : views)
  {
    T_sensor_object_.push_back (T_object_sensor.inverse ());
    nearest_m_.emplace_back (static_cast<std::size_t> (view->camera.width) * view->camera.height, 0.0f);
    farthest_m_.push_back (farthestReading (*view));
  }
  std::vector<OrientedPoint> on_surface;
  on_surface.reserve (points.size ());
  for (const OrientedPoint& point : points)
    on_surface.push_back (onSurface (shape, known_between_, point));
  const VoxelGrid& grid = shape.field.grid;
  const Eigen::Vector3d middle = 0.5 *
                                 (grid.dims.cast<double> () - Eigen::Vector3d::Ones ()); // cells move with the grid
  for (double cell_vox = first_cell_vox;;
       cell_vox *= std::max (1.05, std::sqrt (static_cast<double> (samples_.size ()) / most_samples)))
  {
    samples_.clear ();
    OccupiedCells cells;
    for (const OrientedPoint& point : on_surface)
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

bool
CopyJudge::hasEnoughSamples () const
{
  return samples_.size () >= least_samples;
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
    // Readings that are nearer are not asked for: noise grows with the distance from where it is least.
    const double range_m = views_[v].first->working_range_m;
    const double noise_m = p.z () > least_noise * range_m ? depthNoiseSigma (p.z (), range_m) : 0.0;
    if (!(p.z () < farthest_m_[v] - free_sigmas * noise_m))
      continue;
    const auto pixel = pixelOf (views_[v].first->camera, p);
    if (!pixel)
      continue;
    const double reading_m = nearestReading (v, *pixel);
    if (!std::isfinite (reading_m) || !(reading_m > p.z ()))
      continue;
    const double sigmas = (reading_m - p.z ()) / depthNoiseSigma (reading_m, views_[v].first->working_range_m);
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
  const Interpolated measured = interpolate (shape_, known_between_, copy);
  const double distance_vox = measured.distance_vox, known = measured.known;
  if (!(known > 0.0))
    return;
  sums.contradiction += known * std::clamp ((distance_vox - surely_free_vox) * (1.0 / free_range_vox), 0.0, 1.0);
  if (!(std::abs (distance_vox) < surface_vox))
    return;
  const double nearness = known * tukeyWeight (distance_vox * (1.0 / surface_vox));
  const double slope = measured.gradient.norm ();
  const double cosine = slope > 0.0 ? (motion.linear () * sample.normal.cast<double> ()).dot (measured.gradient) / slope
                                    : 0.0;
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
