// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "brightness_tracking.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/common/robust_weights.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr int lights = 5; // that change all brightness: a factor, an offset, a slope along each axis
using VectorXd = Eigen::Matrix<double, 6 + lights, 1>;
using MatrixXd = Eigen::Matrix<double, 6 + lights, 6 + lights>;

constexpr std::size_t most_points = 4000;
constexpr std::size_t least_points = 60;
constexpr float least_probability = 0.5f;
constexpr int steps = 6; // of each level
constexpr double short_step_m = 2e-5;
constexpr double least_sigma = 2.0; // of 256
constexpr double as_bright = 8.0;   // the same: what differs by more is something else, or in another light
constexpr double huber_sigmas = 1.345;
// Points whose errors are correlated: pixels are smoothed, and brightness is not quite constant.
constexpr double correlated = 48.0;
constexpr double factor_unit = 64.0;       // of 256, so that the factor changes brightness about as much as the offset
constexpr double reference_sigma_m = 3e-4; // of the reference's pose, and of depth against colour
constexpr double shape_sigma_m = 1e-4;     // of the model's shape, by which many readings err together
constexpr double hidden_sigmas = 4.0;      // of depth
constexpr double hidden_share = 0.01;      // of depth: shapes and poses err, too
constexpr double least_agreeing = 0.5;     // of the points, for brightness to be believed
constexpr int least_directions = 3;        // that a texture observes; uneven shading may seem to observe one or two
constexpr double worn = 0.8;               // agreement below which another frame becomes the reference
constexpr double largest_turn_rad = 0.35;  // from the reference: light falls differently then
constexpr double known_sigma_m = 2e-3;     // of a direction that counts as observed

/** \brief A place of the first level in another level, each half the size of the one before. */
Eigen::Vector2d
atLevel (const Eigen::Vector2d& pixel, std::size_t level)
{
  const double scale = static_cast<double> (1 << level);
  return (pixel.array () + 0.5) / scale - 0.5;
}

/** \brief Projection onto the directions that are observed. */
Matrix6d
observedBy (const Matrix6d& precision)
{
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver (precision);
  Matrix6d observed = Matrix6d::Zero ();
  for (int k = 0; k < 6; ++k)
    if (solver.eigenvalues ()[k] * known_sigma_m * known_sigma_m > 1.0)
      observed += solver.eigenvectors ().col (k) * solver.eigenvectors ().col (k).transpose ();
  return observed;
}

/** \brief A shape's precision with the errors of the model itself: the fewer readings observe a direction, relative to
 * the best observed one, the more likely they are a misplaced edge and wrong together. */
Matrix6d
withErrorsOfModel (const Matrix6d& precision)
{
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver (precision);
  const Vector6d& of_readings = solver.eigenvalues ();
  Vector6d result = Vector6d::Zero ();
  for (int k = 0; k < 6; ++k)
    if (of_readings[k] > 0.0)
    {
      const double sigma = shape_sigma_m * of_readings[5] / of_readings[k];
      result[k] = 1.0 / (1.0 / of_readings[k] + sigma * sigma);
    }
  return solver.eigenvectors () * result.asDiagonal () * solver.eigenvectors ().transpose ();
}

/** \brief A point's brightness in the frame and in the reference, and how it changes with the model's motion. */
struct Comparison
{
  Vector6d slope;
  Eigen::Vector3d place; // in the chart
  double now;
  double then;
};

/** \brief The normal equations of the points at a pose. */
struct Sums
{
  explicit Sums (const std::vector<Comparison>& points) : seen (points.size ())
  {
    if (seen < least_points)
      return;
    std::vector<double> differences (seen);
    std::transform (points.begin (), points.end (), differences.begin (),
                    [] (const Comparison& point) { return point.now - point.then; });
    const double offset = upperMedian (differences);
    for (double& difference : differences)
      difference = std::abs (difference - offset);
    sigma = std::max (least_sigma, sigmaOfSizes (differences));
    double mean = 0.0;
    for (const Comparison& point : points)
      mean += point.then / static_cast<double> (seen);

    const double huber = huber_sigmas * sigma;
    for (const Comparison& point : points)
    {
      const double difference = point.now - point.then - offset, size = std::abs (difference);
      const double weight = huberWeight (size, huber);
      VectorXd change;
      change << point.slope, (point.then - mean) / factor_unit, 1.0, point.place;
      squares += weight * change * change.transpose ();
      gradient += weight * difference * change;
      cost += huberCost (size, huber);
      agreeing += size <= as_bright;
    }
    cost /= static_cast<double> (seen);
    leaveOutLight ();
  }

  /** \brief Eliminate the light: precision and slope of the pose, whatever the light is. */
  void leaveOutLight ()
  {
    constexpr double least_contrast = 1e-6;
    const double scale = 1.0 / (sigma * sigma * correlated);
    const Eigen::Matrix<double, lights, lights> of_light = squares.bottomRightCorner<lights, lights> () +
                                                           least_contrast * static_cast<double> (seen) *
                                                               Eigen::Matrix<double, lights, lights>::Identity ();
    const Eigen::Matrix<double, 6, lights> mixed = squares.topRightCorner<6, lights> () * of_light.inverse ();
    const Matrix6d of_pixels = scale *
                               (squares.topLeftCorner<6, 6> () - mixed * squares.bottomLeftCorner<lights, 6> ());
    const Matrix6d observed = observedBy (of_pixels); // along other directions the pixels say little of worth
    const Matrix6d share = (Matrix6d::Identity () + reference_sigma_m * reference_sigma_m * of_pixels).inverse ();
    precision = share * observed * of_pixels;
    slope = scale * share * observed * (gradient.head<6> () - mixed * gradient.tail<lights> ());
  }

  MatrixXd squares = MatrixXd::Zero (); // six of the pose, and the lights
  VectorXd gradient = VectorXd::Zero ();
  Matrix6d precision = Matrix6d::Zero (); // with the errors of the reference
  Vector6d slope = Vector6d::Zero ();     // of half the square of the differences, in standard deviations
  double cost = 0.0;                      // Huber's, mean, of 256
  double sigma = 0.0;                     // of 256
  std::size_t seen;
  std::size_t agreeing = 0;
};

Sums
compare (const BrightnessReference& reference, const FrameCloud& cloud, std::size_t level, const MotionChart& chart,
         const Eigen::Isometry3d& T_model_camera)
{
  const PinholeCamera& camera = cloud.camera;
  const Image<float>& image = cloud.brightness[level];
  const double per_pixel = 1.0 / static_cast<double> (1 << level);
  const Eigen::Isometry3d T_camera_model = T_model_camera.inverse ();
  std::vector<Comparison> seen;
  seen.reserve (reference.points.size ());
  for (const BrightnessReference::Point& point : reference.points)
  {
    const Eigen::Vector3d p = T_camera_model * point.position;
    if (!(p.z () > 0.0))
      continue;
    const Eigen::Vector2d pixel = camera.project (p), place = atLevel (pixel, level);
    if (!isWithin (cloud.depth, pixel) || !isWithin (image, place))
      continue;
    const int u = static_cast<int> (std::lround (pixel.x ())), v = static_cast<int> (std::lround (pixel.y ()));
    const double z = cloud.depth.at (u, v);
    if (!cloud.unmixed.at (u, v) ||
        !(std::abs (z - p.z ()) < hidden_sigmas * depthNoiseSigma (p.z ()) + hidden_share * p.z ()))
      continue;
    const BrightnessReading reading = readBrightness (image, place);
    const double du = per_pixel * camera.fx * reading.du / p.z (), dv = per_pixel * camera.fy * reading.dv / p.z ();
    const Eigen::Vector3d by_point (du, dv, -(du * p.x () + dv * p.y ()) / p.z ());
    // A motion of the camera in the model's frame moves points the other way before it.
    seen.push_back ({chart.slope (point.position, -(T_model_camera.linear () * by_point)), chart.place (point.position),
                     reading.value, point.brightness[level]});
  }
  return Sums (seen);
}

} // namespace

int
UncertainPose::directions () const
{
  return static_cast<int> (std::lround (observedBy (precision).trace ()));
}

BrightnessFit
trackBrightness (const BrightnessReference& reference, const FrameCloud& cloud, const MotionChart& chart,
                 const UncertainPose& shape, const Eigen::Isometry3d& guess)
{
  if (reference.points.size () < least_points || cloud.brightness.size () < brightness_levels ||
      shape.precision.isZero ())
    return {};
  const Sums of_guess = compare (reference, cloud, brightness_levels - 1, chart, guess),
             of_shape = compare (reference, cloud, brightness_levels - 1, chart, shape.T_model_camera);
  const bool begin_there = of_guess.seen >= least_points &&
                           (of_shape.seen < least_points || of_guess.cost < of_shape.cost);
  const Matrix6d by_shape = withErrorsOfModel (shape.precision);
  UncertainPose result;
  result.T_model_camera = begin_there ? guess : shape.T_model_camera;
  for (std::size_t level = brightness_levels; level-- > 0;)
    for (int step = 0; step < steps; ++step)
    {
      const Sums sums = compare (reference, cloud, level, chart, result.T_model_camera);
      if (sums.seen < least_points)
        return {};
      result.precision = sums.precision + by_shape;
      const Vector6d from_shape = chart.coordinates (result.T_model_camera * shape.T_model_camera.inverse ());
      const double ridge = 1e-9 *
                           result.precision.diagonal ().maxCoeff (); // where neither observes a direction, it stays
      const Vector6d
          move = -(result.precision + ridge * Matrix6d::Identity ()).ldlt ().solve (sums.slope + by_shape * from_shape);
      if (!move.allFinite ())
        return {};
      result.T_model_camera = chart.motion (move) * result.T_model_camera;
      if (move.norm () < short_step_m)
        break;
    }
  // Coarse images may have moved it along directions that are not observed in the end.
  const Vector6d moved = chart.coordinates (result.T_model_camera * shape.T_model_camera.inverse ());
  result.T_model_camera = chart.motion (observedBy (result.precision) * moved) * shape.T_model_camera;
  // Small errors of rotations would grow from frame to frame.
  result.T_model_camera
      .linear () = Eigen::Quaterniond (result.T_model_camera.linear ()).normalized ().toRotationMatrix ();
  const Sums sums = compare (reference, cloud, 0, chart, result.T_model_camera);
  BrightnessFit fit;
  fit.agreement = static_cast<double> (sums.agreeing) / static_cast<double> (reference.points.size ());
  if (UncertainPose{result.T_model_camera, sums.precision}.directions () >= least_directions &&
      fit.agreement >= least_agreeing)
    fit.pose = result;
  return fit;
}

BrightnessReference
nextReference (BrightnessReference reference, const FrameCloud& cloud, const TrackedPoints& tracked,
               const Eigen::Isometry3d& T_model_camera)
{
  const std::vector<Eigen::Vector3f>& points = tracked.points;
  const double turn = Eigen::AngleAxisd (reference.T_model_camera.linear ().transpose () * T_model_camera.linear ())
                          .angle ();
  if (cloud.brightness.size () < brightness_levels || (tracked.brightness_agreement >= worn && turn < largest_turn_rad))
    return reference;
  reference.points.clear ();
  reference.T_model_camera = T_model_camera;
  const std::size_t step = std::max<std::size_t> (1, points.size () / most_points);
  for (std::size_t n = 0; n < points.size (); n += step)
  {
    const Eigen::Vector3d p = points[n].cast<double> ();
    const Eigen::Vector2d pixel = cloud.camera.project (p);
    if (!(tracked.probabilities[n] >= least_probability) ||
        !isWithin (cloud.brightness[brightness_levels - 1], atLevel (pixel, brightness_levels - 1)) ||
        !cloud.unmixed.at (static_cast<int> (std::lround (pixel.x ())), static_cast<int> (std::lround (pixel.y ()))))
      continue;
    BrightnessReference::Point point{T_model_camera * p, {}};
    for (std::size_t level = 0; level < brightness_levels; ++level)
      point.brightness[level] = readBrightness (cloud.brightness[level], atLevel (pixel, level)).value;
    reference.points.push_back (point);
  }
  return reference;
}

} // namespace pcl::cosection
