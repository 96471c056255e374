// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "point_levels.h"
#include "pose_step.h"
#include "sdf_residuals.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/tracking/sdf_alignment.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr double tsdf_huber = 0.2; ///< of the truncation distance
constexpr double field_huber_vox = 2.0;
constexpr float any_distance_m = 1e9f;    ///< squares of it can still be summed up
constexpr double coarse_tolerance = 20.0; ///< of levels that are not the last, in units of the last one's
constexpr double min_common_weight = 0.5; ///< of the points that had a distance: more may not be lost by one step

// Damping, as a fraction of the largest eigenvalue.
constexpr double first_damping = 1e-4;
constexpr double least_damping = 1e-9;
constexpr double damping_after_failure = 1e-2;

void
check (bool good, const char* message)
{
  if (!good)
    throw InvalidArgument (std::string ("alignment with a signed distance: ") + message);
}

} // namespace

void
SdfAlignmentOptions::validate () const
{
  check (huber_m >= 0.0 && std::isfinite (huber_m), "Huber's bound must be positive, in metres, or 0 for the volume's");
  check (max_distance_m >= 0.0 && std::isfinite (max_distance_m),
         "the largest distance must be positive, in metres, or 0 for any");
  check (max_iterations >= 1, "there must be at least 1 iteration");
  check (levels >= 1 && levels <= 10, "there must be 1 to 10 levels");
  check (min_level_points >= 1, "a level must have at least 1 point");
  check (max_points >= 0, "the largest number of points must be positive, or 0 for all");
  check (tolerance_vox > 0.0 && std::isfinite (tolerance_vox), "the tolerance must be positive, in voxels");
  check (min_observability >= 0.0 && min_observability < 1.0, "the least observability must be in [0, 1)");
  check (min_points >= 1, "at least 1 point must have a distance");
  check (threads >= 0, "the number of threads must not be negative");
}

const char*
describe (SdfAlignmentStop stop)
{
  switch (stop)
  {
  case SdfAlignmentStop::Converged:
    return "converged";
  case SdfAlignmentStop::MaxIterations:
    return "the pose still moved in the last iteration";
  case SdfAlignmentStop::TooFewPoints:
    return "too few points have a distance";
  case SdfAlignmentStop::NoGradient:
    return "no point says in which direction the surface is";
  }
  return "";
}

SdfTarget::SdfTarget (const TsdfVolume& volume)
    : field_ (&volume.field ())
    , weights_ (&volume.weights ())
    , max_weight_ (volume.options ().max_weight)
    , huber_m_ (tsdf_huber * volume.truncation ())
{}

SdfTarget::SdfTarget (const SignedDistanceField& field)
    : field_ (&field)
    , huber_m_ (field_huber_vox * field.grid.voxel_size_m)
{
  check ((field.grid.dims.array () > 0).all () && field.grid.voxel_size_m > 0.0 &&
             std::isfinite (field.grid.voxel_size_m) && field.grid.origin_m.allFinite (),
         "the field has no voxels");
  check (field.values.size () == field.grid.size (), "the field must have one value per voxel");
  check (field.supported.empty () || field.supported.size () == field.grid.size (),
         "the field must have one mark per voxel, or none");
}

struct SdfAlignment::Impl
{
  explicit Impl (const SdfAlignmentOptions& options) : options (options) { options.validate (); }

  SdfAlignmentResult align (const std::vector<Eigen::Vector3f>& input, const std::vector<float>& weights,
                            const SdfTarget& target, const Eigen::Isometry3d& guess);

  void sample (const SdfTarget& target);

  /** \brief Sums at \a pose, compared with the last accepted ones. */
  ResidualSums evaluate (std::size_t count, const Eigen::Isometry3d& pose)
  {
    return residuals.evaluate (points, count, volume, pose, robust, options.threads, accepted, tried);
  }

  /** \brief Minimise over the first \a count points from the result's pose. */
  void solveLevel (std::size_t count, int max_steps, double tolerance_m, SdfAlignmentResult& result);

  SdfAlignmentOptions options;
  PointLevels points;
  SdfResiduals residuals;
  PointCosts accepted;
  PointCosts tried;
  std::vector<float> marks; // of a field that is not supported everywhere
  SampledVolume volume;
  RobustWeights robust{};
};

void
SdfAlignment::Impl::sample (const SdfTarget& target)
{
  const SignedDistanceField& field = target.field ();
  volume = SampledVolume ();
  volume.values = field.values.data ();
  volume.dims = field.grid.dims;
  volume.voxel_size_m = field.grid.voxel_size_m;
  volume.origin_m = field.grid.origin_m;
  if (target.weights ())
  {
    volume.weights = target.weights ()->data ();
    volume.weight_scale = static_cast<float> (1.0 / target.maxWeight ());
  }
  else if (!field.supported.empty ())
  {
    marks.assign (field.supported.begin (), field.supported.end ());
    for (float& mark : marks)
      mark = std::min (mark, 1.0f);
    volume.weights = marks.data ();
  }
  robust.huber_m = static_cast<float> (options.huber_m > 0.0 ? options.huber_m : target.huber ());
  robust.max_distance_m = options.max_distance_m > 0.0
                              ? static_cast<float> (std::min<double> (options.max_distance_m, any_distance_m))
                              : any_distance_m;
}

void
SdfAlignment::Impl::solveLevel (std::size_t count, int max_steps, double tolerance_m, SdfAlignmentResult& result)
{
  const auto enough = [&] (const ResidualSums& sums) { return sums.points >= options.min_points; };
  const auto begin = accepted.weight.begin ();
  std::fill (begin, begin + static_cast<std::ptrdiff_t> (count), 0.0f); // no point had a distance before
  ResidualSums sums = evaluate (count, result.T_grid_sensor);
  std::swap (accepted, tried);
  double damping = first_damping;
  result.stop = enough (sums) ? SdfAlignmentStop::MaxIterations : SdfAlignmentStop::TooFewPoints;
  for (int step = 0; step < max_steps && enough (sums); ++step)
  {
    const PoseStep equations (sums, volume, options.min_observability);
    if (!equations.solvable ())
    {
      result.stop = SdfAlignmentStop::NoGradient;
      break;
    }
    double length_m = 0.0;
    const Eigen::Isometry3d motion = equations.solve (damping, length_m);
    if (length_m < tolerance_m)
    {
      result.stop = SdfAlignmentStop::Converged;
      break;
    }
    const Eigen::Isometry3d pose = motion * result.T_grid_sensor;
    const ResidualSums next = evaluate (count, pose);
    ++result.iterations;
    if (enough (next) && next.common_weight >= min_common_weight * sums.weight && next.cost < next.cost_before)
    {
      result.T_grid_sensor = pose;
      sums = next;
      std::swap (accepted, tried);
      damping = std::max (least_damping, 0.1 * damping);
    }
    else
      damping = std::max (damping_after_failure, 10.0 * damping);
  }

  const PoseStep equations (sums, volume, options.min_observability);
  result.converged = result.stop == SdfAlignmentStop::Converged;
  result.points = count;
  result.points_with_distance = static_cast<std::size_t> (sums.points);
  if (sums.weight > 0.0)
  {
    result.inlier_share = sums.inlier_weight / sums.weight;
    result.rms_m = std::sqrt (sums.squared_distance / sums.weight);
  }
  result.information = equations.information ();
  result.observability = equations.observability ();
  result.observed_directions = equations.observed ();
}

SdfAlignmentResult
SdfAlignment::Impl::align (const std::vector<Eigen::Vector3f>& input, const std::vector<float>& weights,
                           const SdfTarget& target, const Eigen::Isometry3d& guess)
{
  constexpr double tolerance = 1e-3; // of poses kept in single precision
  check (weights.empty () || weights.size () == input.size (), "there must be one weight per point, or none");
  check (guess.matrix ().allFinite () && guess.linear ().isUnitary (tolerance) && guess.linear ().determinant () > 0.0,
         "the first pose must be a finite rigid motion");
  check (target.field ().grid.size () < static_cast<std::size_t> (std::numeric_limits<int>::max ()),
         "the volume has more voxels than can be counted");

  SdfAlignmentResult result;
  result.T_grid_sensor = guess;
  result.T_grid_sensor.linear () = Eigen::Quaterniond (guess.linear ()).normalized ().toRotationMatrix ();
  points.assign (input, weights, {options.levels, options.min_level_points, options.max_points});
  if (points.size () == 0 || target.field ().grid.dims.minCoeff () < 2)
    return result;
  sample (target);
  for (PointCosts* costs : {&accepted, &tried})
  {
    costs->weight.resize (points.size ());
    costs->cost.resize (points.size ());
  }
  const double tolerance_m = options.tolerance_vox * volume.voxel_size_m;
  for (const std::size_t count : points.ends)
  {
    const int left = options.max_iterations - result.iterations;
    const bool last = count == points.size ();
    solveLevel (count, last ? left : left / 2, last ? tolerance_m : coarse_tolerance * tolerance_m, result);
  }
  return result;
}

SdfAlignment::SdfAlignment (const SdfAlignmentOptions& options) : impl_ (std::make_unique<Impl> (options)) {}

SdfAlignment::~SdfAlignment () = default;
SdfAlignment::SdfAlignment (SdfAlignment&& other) noexcept = default;
SdfAlignment& SdfAlignment::operator= (SdfAlignment&& other) noexcept = default;

const SdfAlignmentOptions&
SdfAlignment::options () const
{
  return impl_->options;
}

SdfAlignmentResult
SdfAlignment::align (const std::vector<Eigen::Vector3f>& points, const std::vector<float>& weights,
                     const SdfTarget& target, const Eigen::Isometry3d& guess)
{
  return impl_->align (points, weights, target, guess);
}

} // namespace pcl::cosection
