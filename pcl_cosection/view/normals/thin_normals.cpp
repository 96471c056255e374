// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "thin_normals.h"

#include "label_window.h"
#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/view/visibility/depth_edges.h"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <optional>
#include <vector>

namespace pcl::cosection {
namespace {

// As in computeOrganizedNormals ():
constexpr std::size_t least_points = 6;
constexpr double widest = 1.0 / 3.0; // share of the window that a label has at a band; with more there are planes

// Completeness of scanned things seen from above: 2.1 mm with 0.3 and 0.5, and 2.6 mm with 0.7; with 1.5 and 2 for the
// next one 2.1 mm, with 3 2.6 mm. Accuracy of real views: 2.85 mm, but 2.87 mm with 1.5.
constexpr double together = 0.5;   // share of the label's readings there that are near in space
constexpr double longish = 2.0;    // standard deviation along a band, in those across it, in the image and in space
constexpr double steepest = 0.966; // sine of 75 degrees, as largestSurfaceStep () has it: beyond, a line is noise

/** \brief Count, mean and covariance of places. */
template <int dimensions> struct Spread
{
  using Place = Eigen::Matrix<double, dimensions, 1>;
  using Square = Eigen::Matrix<double, dimensions, dimensions>;

  std::size_t count = 0;
  Place sum = Place::Zero ();
  Square squares = Square::Zero ();

  void add (const Place& place)
  {
    ++count;
    sum += place;
    squares += place * place.transpose ();
  }

  /** \brief The direction in which the places lie along a line, if they do. */
  std::optional<Place> line () const
  {
    const Place mean = sum / static_cast<double> (count);
    Eigen::SelfAdjointEigenSolver<Square> eigen;
    eigen.computeDirect (squares / static_cast<double> (count) - mean * mean.transpose ());
    if (!(eigen.eigenvalues ()[dimensions - 1] >= longish * longish * eigen.eigenvalues ()[dimensions - 2]))
      return std::nullopt;
    return eigen.eigenvectors ().col (dimensions - 1);
  }
};

/** \brief The normal of a band at the reading \a i; NaN if it is on none. */
Eigen::Vector3f
thinNormal (const SensorCloud& cloud, double pixel_pitch, std::size_t i)
{
  const Eigen::Vector3f none = Eigen::Vector3f::Constant (nan_value);
  const Eigen::Vector3f& here = cloud.positions[i];
  const double range = here.norm ();
  Spread<2> labelled; // pixels; what is behind, such as the other edge of a sheet, is no part of the band
  Spread<3> near;     // metres
  visitLabelWindow (cloud, i, [&] (std::size_t j, int du, int dv) {
    const Eigen::Vector2d offset_px (du, dv);
    const double behind = cloud.positions[j].norm () - range;
    const double step = largestSurfaceStep (range, pixel_pitch * range * offset_px.norm (), cloud.working_range_m);
    if (behind > step)
      return;
    labelled.add (offset_px);
    if (behind >= -step)
      near.add ((cloud.positions[j] - here).cast<double> ());
  });
  constexpr int window = (2 * label_window_px + 1) * (2 * label_window_px + 1);
  if (static_cast<double> (labelled.count) > widest * window || near.count < least_points ||
      static_cast<double> (near.count) < together * static_cast<double> (labelled.count))
    return none;
  const Eigen::Vector3d ray = here.cast<double> ().normalized ();
  const std::optional<Eigen::Vector3d> along = near.line ();
  if (!along || std::abs (ray.dot (*along)) > steepest || !labelled.line ()) // as at the corners of what is wide
    return none;
  return (ray.dot (*along) * *along - ray).normalized ().cast<float> ();
}

} // namespace

void
addThinNormals (int threads, const PinholeCamera& camera, const Members& members, SensorCloud& cloud)
{
  const std::vector<std::size_t> candidates = objectReadingsWithoutNormals (members, cloud);
  parallelFor (0, static_cast<int> (candidates.size ()), threads,
               [&] (int k) { cloud.normals[candidates[k]] = thinNormal (cloud, 1.0 / camera.fx, candidates[k]); });
}

} // namespace pcl::cosection
