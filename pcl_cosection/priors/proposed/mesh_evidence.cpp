// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mesh_evidence.h"

#include "pcl_cosection/common/plane_height.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/view/visibility/visibility.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pcl::cosection {
namespace {

constexpr std::array<std::array<int, 2>, 5> edge_pixels = {{{0, 0}, {-2, 0}, {2, 0}, {0, -2}, {0, 2}}};

/** \brief Near counts 1, farther than the tolerance 0. */
double
nearness (double distance, double tolerance)
{
  return std::max (0.0, 1.0 - distance * distance / (tolerance * tolerance));
}

} // namespace

MeshEvidence::MeshEvidence (const TriangleMesh& mesh, const MeasuredObject& object)
    : object_ (object)
    , mesh_ (mesh)
    , points_ (thinToCells (object.points, thinnedSpacing (object.points)))
    , size_m_ (spreadOf (points_.positions))
    , cell_m_ (thinnedSpacing (object.points))
{
  const Eigen::Vector3d middle = points_.positions.rowwise ().mean ();
  for (const auto& [view, T_object_sensor] : object.views)
    sensors_.push_back (T_object_sensor.translation () - middle);
}

bool
MeshEvidence::isPossible () const
{
  return points_.size () >= static_cast<Eigen::Index> (least_points) && size_m_ > 0.0;
}

Similarity
MeshEvidence::inPlace () const
{
  Similarity similarity;
  similarity.scale = mesh_.unit ();
  similarity.t = mesh_.middle ();
  return similarity;
}

std::vector<Eigen::Index>
MeshEvidence::visibleSamples (const Eigen::Matrix3d& R, Eigen::Index count) const
{
  std::vector<const std::vector<std::uint8_t>*> by_view;
  for (const Eigen::Vector3d& sensor : sensors_)
    by_view.push_back (&mesh_.visibleFrom (R.transpose () * sensor));
  std::vector<Eigen::Index> result;
  const Eigen::Index step = std::max<Eigen::Index> (1, SampledMesh::matched / count);
  for (Eigen::Index n = 0; n < SampledMesh::matched; n += step)
    if (by_view.empty () || std::any_of (by_view.begin (), by_view.end (),
                                         [n] (const auto* seen) { return (*seen)[static_cast<std::size_t> (n)] != 0; }))
      result.push_back (n);
  return result;
}

bool
MeshEvidence::isUnknown (const Eigen::Vector3d& p) const
{
  bool judged = object_.views.empty ();
  for (const auto& [view, T_object_sensor] : object_.views)
  {
    const PointVisibility seen = visibilityOf (T_object_sensor.inverse () * p, *view, object_.noise_m);
    judged |= seen != PointVisibility::Outside && seen != PointVisibility::NoReading;
  }
  return !judged || object_.hidden.at (p) == Hidden::ByOther;
}

bool
MeshEvidence::isFree (const Eigen::Vector3d& p, double margin_m) const
{
  return std::any_of (object_.views.begin (), object_.views.end (), [&] (const auto& view) {
    const auto& [depth, T_object_sensor] = view;
    const Eigen::Vector3d in_sensor = T_object_sensor.inverse () * p;
    const auto pixel = pixelOf (depth->camera, in_sensor);
    return pixel && std::all_of (edge_pixels.begin (), edge_pixels.end (), [&, &depth = depth] (const auto& offset) {
             const int u = pixel->x () + offset[0], v = pixel->y () + offset[1];
             return u >= 0 && v >= 0 && u < depth->camera.width && v < depth->camera.height &&
                    compareWithReading (in_sensor.z (), depth->at (u, v), margin_m) == PointVisibility::Free;
           });
  });
}

ProposalFit
MeshEvidence::fit (const Similarity& similarity, Eigen::Index samples) const
{
  ProposalFit result;
  const double tolerance_m = std::max (2.0 * object_.noise_m, 0.03 * size_m_);
  std::vector<double> distances;
  for (Eigen::Index n = 0; n < points_.size (); ++n)
  {
    const Eigen::Vector3d p = points_.positions.col (n);
    const auto [q, normal] = mesh_.nearest (similarity.R.transpose () * (p - similarity.t) / similarity.scale);
    distances.push_back ((similarity * q - p).norm ());
    if ((similarity.R * normal).dot (points_.normals.col (n)) > least_cosine)
      result.explained += nearness (distances.back (), tolerance_m);
  }
  result.explained /= static_cast<double> (points_.size ());
  result.distance_m = quantile (distances, 0.5);

  double judged = 0.0;
  for (const Eigen::Index n : visibleSamples (similarity.R, samples))
  {
    const Eigen::Vector3d p = similarity * mesh_.position (n), normal = similarity.R * mesh_.normal (n);
    if (isUnknown (p))
      continue;
    Eigen::Index nearest = 0;
    const double squared = (points_.positions.colwise () - p).colwise ().squaredNorm ().minCoeff (&nearest);
    const double across = std::abs (points_.normals.col (nearest).dot (points_.positions.col (nearest) - p));
    judged += 1.0;
    // Points are a cell apart: along the surface they may be so far.
    if (points_.normals.col (nearest).dot (normal) > least_cosine && std::sqrt (squared) < 3.0 * tolerance_m)
      result.confirmed += nearness (across, tolerance_m);
  }
  result.confirmed = judged > 0.0 ? result.confirmed / judged : 0.0;

  const Eigen::Index step = std::max<Eigen::Index> (1, SampledMesh::matched / samples);
  double all = 0.0;
  for (Eigen::Index n = 0; n < SampledMesh::matched; n += step)
  {
    const Eigen::Vector3d p = similarity * mesh_.position (n);
    all += 1.0;
    result.contradicted += isFree (p, tolerance_m) ||
                           std::any_of (object_.resting.begin (), object_.resting.end (),
                                        [&] (const auto& plane) { return heightOver (plane, p) < -tolerance_m; });
  }
  result.contradicted /= all;
  return result;
}

ProposalFit
fitInPlace (const TriangleMesh& mesh, const MeasuredObject& object)
{
  if (object.points.size () < MeshEvidence::least_points)
    return {};
  const MeshEvidence evidence (mesh, object);
  return evidence.isPossible () ? evidence.fit (evidence.inPlace ()) : ProposalFit ();
}

} // namespace pcl::cosection
