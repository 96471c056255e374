// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "resting_objects.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/common/robust_weights.h"

#include <pcl/cosection/common/camera.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr int rounds = 2; // of association
constexpr int steps = 6;  // in each
constexpr std::size_t min_points = 30;
constexpr SampleOptions background_samples{5000, 0.0, true};
constexpr SampleOptions object_samples{300, 1.5};
constexpr double huber_share = 0.2;  // of the truncation distance
constexpr double least_share = 0.01; // of the samples' weight, from which on a direction is observed
// A share of the objects' weight: where the background observes a direction by less, and fits badly, objects are used.
constexpr double share_of_objects = 0.5;
constexpr double bad_fit = 0.5;     // of a voxel of the background
constexpr double least_error = 0.1; // the same
constexpr double short_step = 0.02; // voxels

using Directions = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6>;
using VectorXd = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
using MatrixXd = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

/** \brief An object that is believed to rest, or a part of the background, with its points. */
struct Piece
{
  const TsdfVolume* volume;
  Eigen::Isometry3d T_world_object;
  double tolerance_m = 0.0; // largest error that is expected
  std::vector<Eigen::Vector3f> points = {};
  std::vector<float> weights = {};
  double votes = 0.0;
};

using Pieces = std::vector<const Piece*>;

/** \brief Samples of all pieces, world frame. */
std::vector<SurfaceSample>
samplesOf (const Pieces& pieces, const Eigen::Isometry3d& T_world_camera)
{
  std::vector<SurfaceSample> all;
  for (const Piece* piece : pieces)
  {
    const double huber = huber_share * piece->volume->truncation ();
    for (SurfaceSample sample : sampleSurface (piece->points, piece->weights, *piece->volume,
                                               piece->T_world_object.inverse () * T_world_camera, object_samples))
    {
      sample.position = piece->T_world_object * sample.position;
      sample.normal = piece->T_world_object.linear () * sample.normal;
      sample.weight *= huberWeight (std::abs (sample.distance), huber) / (piece->tolerance_m * piece->tolerance_m);
      all.push_back (sample);
    }
  }
  return all;
}

/** \brief Whether the readings that observe a direction do not fit the background: depth edges are noisy, walls not. */
bool
isNoisy (const std::vector<SurfaceSample>& samples, const MotionChart& chart, const Vector6d& direction,
         double largest_spread_m)
{
  std::vector<double> sizes; // of distances
  for (const SurfaceSample& sample : samples)
    if (std::abs (chart.slope (sample).dot (direction)) >= sample.facing)
      sizes.push_back (std::abs (sample.distance));
  return !sizes.empty () && sigmaOfSizes (sizes) > largest_spread_m;
}

/** \brief The motions that the background does not observe, or by less than \a enough weight of noisy readings. */
Directions
openDirections (const std::vector<SurfaceSample>& samples, const MotionChart& chart, double enough,
                double largest_spread_m)
{
  Directions open (6, 0);
  for (const auto& [direction, curvature, support, observed] : principalDirections (samples, chart))
  {
    if (observed && (support >= enough || !isNoisy (samples, chart, direction, largest_spread_m)))
      continue;
    open.conservativeResize (Eigen::NoChange, open.cols () + 1);
    open.rightCols<1> () = direction;
  }
  return open;
}

/** \brief Coordinates of motions along open directions, by which certain samples move. */
struct OpenMotions
{
  /** \param[in] open directions in the chart of the background */
  OpenMotions (const std::vector<SurfaceSample>& samples, const Directions& open, const MotionChart& background)
      : chart (samples)
  {
    constexpr double small = 1e-4; // metres: such motions add up
    Directions directions (6, open.cols ());
    for (int k = 0; k < open.cols (); ++k)
      directions.col (k) = chart.coordinates (background.motion (small * open.col (k))) / small;
    basis = Eigen::HouseholderQR<Directions> (directions).householderQ () * Directions::Identity (6, open.cols ());
  }

  VectorXd coordinates (const Eigen::Isometry3d& motion) const
  {
    return basis.transpose () * chart.coordinates (motion);
  }

  Eigen::Isometry3d motion (const VectorXd& x) const { return chart.motion (basis * x); }

  MotionChart chart;
  Directions basis;
};

/** \brief A Gauss-Newton step. Directions that hardly any sample observes are left out. */
struct OpenStep
{
  OpenStep (const std::vector<SurfaceSample>& samples, const OpenMotions& open)
  {
    const auto k = open.basis.cols ();
    MatrixXd curvature = MatrixXd::Zero (k, k);
    VectorXd gradient = VectorXd::Zero (k);
    double total = 0.0;
    for (const SurfaceSample& sample : samples)
    {
      const VectorXd slope = open.basis.transpose () * open.chart.slope (sample);
      curvature += sample.weight * slope * slope.transpose ();
      gradient += sample.weight * sample.distance * slope;
      total += sample.weight;
    }
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver (curvature);
    observed = MatrixXd::Zero (k, k);
    step = VectorXd::Zero (k);
    for (int n = 0; n < k; ++n)
    {
      const VectorXd direction = solver.eigenvectors ().col (n);
      if (!(directionSupport (samples, open.chart, open.basis * direction).all > least_share * total))
        continue;
      step -= direction.dot (gradient) / solver.eigenvalues ()[n] * direction;
      observed += direction * direction.transpose ();
      ++directions;
    }
  }

  VectorXd step;
  MatrixXd observed; // projection
  int directions = 0;
};

/** \brief Finds poses along the open directions of the background by pieces. */
struct PoseByPieces
{
  /** \brief The pose by these pieces, from a pose nearby. \param[in] default_pose along directions that they do not
   * observe */
  HeldPose solve (const Pieces& pieces, const Eigen::Isometry3d& start, const Eigen::Isometry3d& default_pose) const
  {
    HeldPose result;
    result.T_world_camera = start;
    for (int n = 0; n < steps; ++n)
    {
      const std::vector<SurfaceSample> samples = samplesOf (pieces, result.T_world_camera);
      const OpenMotions motions (samples, open, chart);
      const OpenStep next (samples, motions);
      const VectorXd x = motions.coordinates (result.T_world_camera * default_pose.inverse ());
      result.T_world_camera = motions.motion (next.step) * motions.motion (next.observed * x) * default_pose;
      result.directions = next.directions;
      if (next.step.norm () < short_step * pieces[0]->volume->grid ().voxel_size_m)
        break;
    }
    return result;
  }

  /** \brief Whether a piece would hardly move the camera. */
  bool agrees (const Piece& piece, const Eigen::Isometry3d& T_world_camera) const
  {
    const std::vector<SurfaceSample> samples = samplesOf ({&piece}, T_world_camera);
    double counted = 0.0;
    for (const SurfaceSample& sample : samples)
      counted += sample.points;
    return 2.0 * counted >= static_cast<double> (piece.points.size ()) &&
           OpenStep (samples, OpenMotions (samples, open, chart)).step.norm () < piece.tolerance_m;
  }

  const MotionChart& chart;
  const Directions& open;
};

/** \brief The pieces that agree with the pose that most agree with. \param[in] steady T_world_camera if the camera goes
 * on as before */
Pieces
mostThatAgree (const std::vector<Piece>& pieces, const PoseByPieces& poses, const Eigen::Isometry3d& steady)
{
  Pieces all;
  double largest = 0.0, tolerance_m = 0.0;
  for (const Piece& piece : pieces)
  {
    all.push_back (&piece);
    largest = std::max (largest, piece.votes);
    tolerance_m = std::max (tolerance_m, piece.tolerance_m);
  }
  Pieces best;
  double most = 0.0;
  const auto consider = [&] (const Pieces& some) {
    const Eigen::Isometry3d pose = poses.solve (some, steady, steady).T_world_camera;
    const OpenMotions motions (samplesOf (all, pose), poses.open, poses.chart);
    double support = motions.coordinates (pose * steady.inverse ()).norm () < tolerance_m ? largest : 0.0;
    Pieces agreeing;
    for (const Piece* piece : all)
      if (poses.agrees (*piece, pose))
      {
        agreeing.push_back (piece);
        support += piece->votes;
      }
    if (agreeing.empty () || support <= most)
      return;
    most = support;
    best = std::move (agreeing);
  };
  consider (all);
  if (best.size () < all.size ())
    for (const Piece* piece : all)
      consider ({piece});
  return best;
}

/** \brief The objects that rest, with their points. \param[in] T_world_expected camera of \a scene
 * \param[in] T_world_camera from where they are seen */
std::vector<Piece>
restingPieces (const std::vector<Eigen::Vector3f>& points, const SceneModels& scene,
               const Eigen::Isometry3d& T_world_expected, const DataAssociation& association,
               const Eigen::Isometry3d& T_world_camera)
{
  std::vector<AssociatedModel> models = scene.models;
  for (std::size_t m = 0; m < models.size (); ++m)
    models[m].T_model_sensor = m > 0 && scene.objects[m - 1]->rests ()
                                   ? Eigen::Isometry3d (scene.objects[m - 1]->T_world_rest.inverse () * T_world_camera)
                                   : Eigen::Isometry3d (models[m].T_model_sensor * T_world_expected.inverse () *
                                                        T_world_camera);
  std::vector<Piece> pieces;
  for (std::size_t m = 1; m < models.size (); ++m)
  {
    if (!scene.objects[m - 1]->rests ())
      continue;
    Piece piece{models[m].volume, scene.objects[m - 1]->T_world_rest};
    const std::vector<float> probabilities = association.probabilities (points, models, m);
    double depths = 0.0;
    for (std::size_t n = 0; n < points.size (); ++n)
      if (probabilities[n] > 0.0f)
      {
        const float z = points[n].z ();
        piece.points.push_back (points[n]);
        piece.weights.push_back (probabilities[n] * readingWeight (z, models[0].volume->grid ().voxel_size_m));
        piece.votes += piece.weights.back ();
        depths += z;
      }
    if (piece.points.size () < min_points)
      continue;
    piece.tolerance_m = std::hypot (piece.volume->grid ().voxel_size_m,
                                    depthNoiseSigma (depths / static_cast<double> (piece.points.size ())));
    pieces.push_back (std::move (piece));
  }
  return pieces;
}

/** \brief The part of the background that observes open directions. Its error is the spread of its readings, so that a
 * part that fits well certainly rests. */
Piece
observingPart (const TsdfVolume& room, const std::vector<SurfaceSample>& samples, const MotionChart& chart,
               const Directions& open, const Eigen::Isometry3d& T_world_camera)
{
  const double voxel_m = room.grid ().voxel_size_m;
  Piece piece{&room, Eigen::Isometry3d::Identity (), voxel_m};
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse ();
  std::vector<double> sizes; // of distances
  for (const SurfaceSample& sample : samples)
    if ((open.transpose () * chart.slope (sample)).norm () >= sample.facing)
    {
      piece.points.push_back ((T_camera_world * sample.position).cast<float> ());
      piece.weights.push_back (static_cast<float> (sample.weight));
      piece.votes += sample.weight;
      sizes.push_back (std::abs (sample.distance));
    }
  if (!sizes.empty ())
    piece.tolerance_m = std::clamp (sigmaOfSizes (sizes), least_error * voxel_m, voxel_m);
  piece.votes *= voxel_m / piece.tolerance_m;
  return piece;
}

} // namespace

HeldPose
holdByRestingObjects (const std::vector<Eigen::Vector3f>& points, const std::vector<float>& weights,
                      const SceneModels& scene, const Eigen::Isometry3d& T_world_camera,
                      const DataAssociation& association, const Eigen::Isometry3d& by_background)
{
  HeldPose result;
  result.T_world_camera = by_background;
  if (std::none_of (scene.objects.begin (), scene.objects.end (),
                    [] (const TrackedObject* object) { return object->rests (); }))
    return result;
  const TsdfVolume& room = *scene.models[0].volume;
  const std::vector<SurfaceSample> samples = sampleSurface (points, weights, room, by_background, background_samples);
  const MotionChart chart (samples);
  double weight = 0.0;
  for (const Piece& piece : restingPieces (points, scene, T_world_camera, association, by_background))
    weight += piece.votes;
  const Directions open = openDirections (samples, chart, share_of_objects * weight,
                                          bad_fit * room.grid ().voxel_size_m);
  if (!(weight > 0.0) || open.cols () == 0)
    return result;
  const PoseByPieces poses{chart, open};
  const VectorXd expected = open.transpose () * chart.coordinates (T_world_camera * by_background.inverse ());
  const Eigen::Isometry3d steady = chart.motion (open * expected) * by_background;
  const Piece part = observingPart (room, samples, chart, open, by_background);
  Eigen::Isometry3d pose = steady;
  for (int round = 0; round < rounds; ++round)
  {
    std::vector<Piece> pieces = restingPieces (points, scene, T_world_camera, association, pose);
    if (pieces.empty ())
      return result;
    if (part.points.size () >= min_points)
      pieces.push_back (part);
    const Pieces agreeing = mostThatAgree (pieces, poses, steady);
    if (agreeing.empty ())
      return result;
    result = poses.solve (agreeing, pose, by_background);
    pose = result.T_world_camera;
  }
  result.directions += 6 - static_cast<int> (open.cols ());
  return result;
}

} // namespace pcl::cosection
