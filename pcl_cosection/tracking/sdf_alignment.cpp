// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/tracking/sdf_alignment.h>

#include "sdf_residuals.h"

#include <pcl/cosection/common/error.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pcl::cosection {
namespace {

using Vector6d = SdfAlignmentResult::Vector6d;
using Matrix6d = SdfAlignmentResult::Matrix6d;

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

Eigen::Matrix3d
crossMatrix (const Eigen::Vector3d& v)
{
  Eigen::Matrix3d m;
  m << 0.0, -v.z (), v.y (), v.z (), 0.0, -v.x (), -v.y (), v.x (), 0.0;
  return m;
}

/** \brief Takes (t, scale omega) about \a center to (t', new_scale omega) about \a new_center: the same motion. */
Matrix6d
changeOfCenter (const Eigen::Vector3d& center, double scale, const Eigen::Vector3d& new_center, double new_scale)
{
  Matrix6d change = Matrix6d::Identity ();
  change.topRightCorner<3, 3> () = crossMatrix (center - new_center) / scale;
  change.bottomRightCorner<3, 3> () *= new_scale / scale;
  return change;
}

/** \brief The normal equations of a pose, in coordinates in which its six directions are comparable: about the centroid
 * of the points, rotations in units of their root mean square distance from it. */
class PoseStep
{
public:
  /** \param[in] min_observability directions whose eigenvalue is a smaller fraction of the largest are held */
  PoseStep (const ResidualSums& sums, const SampledVolume& volume, double min_observability)
      : min_observability_ (min_observability)
  {
    Matrix6d squares;
    int entry = 0;
    for (int row = 0; row < 6; ++row)
      for (int column = row; column < 6; ++column)
        squares (row, column) = squares (column, row) = sums.squares[entry++];
    const Vector6d gradient = Eigen::Map<const Vector6d> (sums.gradient.data ());

    const double weight = std::max (sums.robust_weight, 1e-300);
    const Eigen::Vector3d lever = Eigen::Map<const Eigen::Vector3d> (sums.lever.data ()) / weight;
    const double spread = std::sqrt (std::max (0.0, sums.squared_lever / weight - lever.squaredNorm ()));
    centroid_ = volume.center () + volume.radius () * lever;
    radius_m_ = std::max (volume.radius () * spread, volume.voxel_size_m);

    const Matrix6d change = changeOfCenter (centroid_, radius_m_, volume.center (), volume.radius ());
    squares_ = change.transpose () * squares * change;
    gradient_ = change.transpose () * gradient;
    const Eigen::SelfAdjointEigenSolver<Matrix6d> solver (squares_);
    eigenvalues_ = solver.eigenvalues ().cwiseMax (0.0);
    directions_ = solver.eigenvectors ();
  }

  /** \brief Whether any direction is determined. */
  bool solvable () const { return eigenvalues_[5] > 0.0; }

  /** \brief A Levenberg-Marquardt step: what takes the present pose to the next, from the left.
   * \param[in] damping as a fraction of the largest eigenvalue
   * \param[out] length root mean square of how far it moves the points, metres */
  Eigen::Isometry3d solve (double damping, double& length) const
  {
    const Vector6d along = directions_.transpose () * gradient_;
    Vector6d step = Vector6d::Zero ();
    for (int n = 6 - observed (); n < 6; ++n)
      step -= along[n] / (eigenvalues_[n] + damping * eigenvalues_[5]) * directions_.col (n);
    length = step.norm ();

    const Eigen::Vector3d omega = step.tail<3> () / radius_m_;
    const double angle = omega.norm ();
    const Eigen::AngleAxisd turn (angle, angle > 0.0 ? Eigen::Vector3d (omega / angle) : Eigen::Vector3d::UnitX ());
    return Eigen::Translation3d (centroid_ + step.head<3> ()) * turn * Eigen::Translation3d (-centroid_);
  }

  /** \brief As SdfAlignmentResult::observability. */
  Vector6d observability () const
  {
    return solvable () ? Vector6d (eigenvalues_ / eigenvalues_[5]) : Vector6d::Zero ();
  }

  /** \brief Directions that are not held. */
  int observed () const
  {
    const auto values = eigenvalues_.array ();
    return static_cast<int> ((values >= min_observability_ * values[5] && values > 0.0).count ());
  }

  /** \brief As SdfAlignmentResult::information. */
  Matrix6d information () const
  {
    const Matrix6d change = changeOfCenter (Eigen::Vector3d::Zero (), 1.0, centroid_, radius_m_);
    return change.transpose () * squares_ * change;
  }

private:
  Eigen::Vector3d centroid_; // grid frame
  double radius_m_;
  Matrix6d squares_; // in coordinates (t, radius * omega) about the centroid
  Vector6d gradient_;
  Vector6d eigenvalues_;
  Matrix6d directions_;
  double min_observability_;
};

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
                            const SdfTarget& target, const Eigen::Isometry3d& guess)
  {
    constexpr double tolerance = 1e-3; // of poses kept in single precision
    check (weights.empty () || weights.size () == input.size (), "there must be one weight per point, or none");
    check (guess.matrix ().allFinite () && guess.linear ().isUnitary (tolerance) &&
               guess.linear ().determinant () > 0.0,
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

  void sample (const SdfTarget& target)
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

  /** \brief Sums at \a pose, compared with the last accepted ones. */
  ResidualSums evaluate (std::size_t count, const Eigen::Isometry3d& pose)
  {
    return residuals.evaluate (points, count, volume, pose, robust, options.threads, accepted, tried);
  }

  /** \brief Minimise over the first \a count points from the result's pose. */
  void solveLevel (std::size_t count, int max_steps, double tolerance_m, SdfAlignmentResult& result)
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

  SdfAlignmentOptions options;
  PointLevels points;
  SdfResiduals residuals;
  PointCosts accepted;
  PointCosts tried;
  std::vector<float> marks; // of a field that is not supported everywhere
  SampledVolume volume;
  RobustWeights robust{};
};

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
