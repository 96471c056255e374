// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mesh_alignment.h"

#include "pcl_cosection/common/directions.h"
#include "pcl_cosection/common/parallel.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr int start_directions = 162; // in which the mesh is seen ...
constexpr int start_turns = 18;       // ... and turned
constexpr std::size_t starts_kept = 48;
constexpr std::size_t finalists = 8;
constexpr Eigen::Index few = 100; // points and samples that judge a start
constexpr Eigen::Index some = 250;
constexpr int coarse_steps = 10;
constexpr int fine_steps = 15;
constexpr double normal_weight = 0.1;  // of 1 - cosine against squared distances in units of the size
constexpr double most_cost = 0.15;     // of one point at the start
constexpr double along_surface = 0.05; // weight of the distance along a surface against that across
constexpr double border_cells = 1.0;
constexpr double scale_range = 1.6; // of the scale that extents suggest; more is another object

/** \brief A pair of places that should be one. */
struct Match
{
  Eigen::Vector3d from; ///< on the mesh, in the object's frame
  Eigen::Vector3d to;
  Eigen::Vector3d normal;
  double weight = 0.0;
};

class Alignment : public MeshEvidence
{
public:
  using MeshEvidence::MeshEvidence;

  ProposalFit best (int threads) const
  {
    std::vector<std::pair<double, Similarity>> starts (static_cast<std::size_t> (start_directions) * start_turns);
    parallelFor (0, static_cast<int> (starts.size ()), threads, [&] (int n) { starts[n] = start (n); });
    keep (starts, starts_kept);
    parallelFor (0, static_cast<int> (starts.size ()), threads, [&] (int n) {
      starts[n].second = refined (starts[n].second, points_.few (some), some, coarse_steps, 0.5 * size_m_,
                                  0.1 * size_m_);
      starts[n].first = costOf (starts[n].second, some);
    });
    keep (starts, finalists);
    const double fine_m = std::max (3.0 * object_.noise_m, 0.03 * size_m_);
    parallelFor (0, static_cast<int> (starts.size ()), threads, [&] (int n) {
      starts[n].second = refined (starts[n].second, points_, SampledMesh::matched, fine_steps, 0.15 * size_m_, fine_m);
      starts[n].first = costOf (starts[n].second, SampledMesh::matched);
    });
    keep (starts, 1);
    const Similarity& similarity = starts.front ().second;
    ProposalFit result = fit (similarity);
    result.scale = similarity.scale / mesh_.unit ();
    result.T_object_proposal.linear () = similarity.scale * similarity.R / mesh_.unit ();
    result.T_object_proposal.translation () = similarity * (-mesh_.middle () / mesh_.unit ());
    return result;
  }

private:
  static void keep (std::vector<std::pair<double, Similarity>>& starts, std::size_t count)
  {
    std::stable_sort (starts.begin (), starts.end (), [] (const auto& a, const auto& b) { return a.first < b.first; });
    starts.resize (std::min (starts.size (), count));
  }

  OrientedColumns moved (const Similarity& to, const std::vector<Eigen::Index>& samples) const
  {
    OrientedColumns result;
    result.positions.resize (3, static_cast<Eigen::Index> (samples.size ()));
    result.normals.resize (3, static_cast<Eigen::Index> (samples.size ()));
    for (std::size_t n = 0; n < samples.size (); ++n)
    {
      result.positions.col (static_cast<Eigen::Index> (n)) = to * mesh_.position (samples[n]);
      result.normals.col (static_cast<Eigen::Index> (n)) = to.R * mesh_.normal (samples[n]);
    }
    return result;
  }

  /** \brief The n-th rotation, with scale and translation by the moments of what the views should see. */
  std::pair<double, Similarity> start (int n) const
  {
    Similarity similarity;
    const Eigen::Vector3d axis = sphereDirection (n / start_turns, start_directions).cast<double> ();
    similarity.R = Eigen::AngleAxisd (2.0 * M_PI * (n % start_turns) / start_turns, axis).toRotationMatrix () *
                   Eigen::Quaterniond::FromTwoVectors (Eigen::Vector3d::UnitZ (), axis).toRotationMatrix ();
    const std::vector<Eigen::Index> samples = visibleSamples (similarity.R, few);
    if (samples.size () < 3)
      return {std::numeric_limits<double>::infinity (), similarity};
    const OrientedColumns seen = moved (similarity, samples);
    similarity.scale = size_m_ / std::max (spreadOf (seen.positions), 1e-6);
    similarity.t = points_.positions.rowwise ().mean () - similarity.scale * seen.positions.rowwise ().mean ();
    const OrientedColumns placed = moved (similarity, samples);
    const OrientedColumns points = points_.few (few);
    return {startCost (points, placed) + startCost (placed, points), similarity};
  }

  double startCost (const OrientedColumns& from, const OrientedColumns& to) const
  {
    double sum = 0.0;
    for (Eigen::Index n = 0; n < from.size (); ++n)
    {
      const auto squared = (to.positions.colwise () - from.positions.col (n)).colwise ().squaredNorm () /
                           (size_m_ * size_m_);
      const auto turned = (1.0 - (from.normals.col (n).transpose () * to.normals).array ()) * normal_weight;
      sum += std::min (most_cost, (squared.array () + turned).minCoeff ());
    }
    return sum / static_cast<double> (from.size ());
  }

  /** \brief Pairs from points to the mesh, from the mesh to points, and from the mesh to the planes. */
  std::vector<Match> matches (const Similarity& now, const OrientedColumns& points, Eigen::Index samples,
                              double reach_m) const
  {
    std::vector<Match> result;
    const auto weightOf = [reach_m] (double distance_m, double cosine) {
      const double by_distance = 1.0 / (1.0 + distance_m * distance_m / (reach_m * reach_m));
      return cosine > least_cosine ? by_distance * by_distance : 0.1 * by_distance * by_distance;
    };
    for (Eigen::Index n = 0; n < points.size (); ++n)
    {
      const Eigen::Vector3d p = points.positions.col (n);
      const auto [q, normal] = mesh_.nearest (now.R.transpose () * (p - now.t) / now.scale);
      const Eigen::Vector3d at = now * q, turned = now.R * normal;
      result.push_back ({at, p, turned, weightOf ((at - p).norm (), turned.dot (points.normals.col (n)))});
    }
    const double each = static_cast<double> (points.size ());
    const std::size_t first = result.size ();
    const std::vector<Eigen::Index> visible = visibleSamples (now.R, samples);
    for (const Eigen::Index n : visible)
    {
      const Eigen::Vector3d p = now * mesh_.position (n), normal = now.R * mesh_.normal (n);
      if (isUnknown (p))
        continue;
      Eigen::Index nearest = 0;
      const double squared = (points.positions.colwise () - p).colwise ().squaredNorm ().minCoeff (&nearest);
      const Eigen::Vector3d to = points.normals.col (nearest), away = p - points.positions.col (nearest);
      // Beyond the border of the points, where readings at edges are missing, it is unknown where the surface is.
      if ((away - to.dot (away) * to).norm () > border_cells * cell_m_ && !isFree (p, 2.0 * object_.noise_m))
        continue;
      result.push_back ({p, points.positions.col (nearest), to, weightOf (std::sqrt (squared), to.dot (normal))});
    }
    const double share = each / std::max (1.0, static_cast<double> (result.size () - first));
    for (std::size_t n = first; n < result.size (); ++n)
      result[n].weight *= share;
    addPlanes (now, samples, each, result);
    return result;
  }

  /** \brief The lowest sample touches each plane, and none is below. */
  void addPlanes (const Similarity& now, Eigen::Index samples, double weight, std::vector<Match>& result) const
  {
    for (const Eigen::Vector4d& plane : object_.resting)
    {
      const Eigen::Vector3d up = plane.head<3> ();
      double lowest = std::numeric_limits<double>::infinity ();
      Eigen::Vector3d at = Eigen::Vector3d::Zero ();
      const Eigen::Index step = std::max<Eigen::Index> (1, SampledMesh::matched / samples);
      for (Eigen::Index n = 0; n < SampledMesh::matched; n += step)
        if (const Eigen::Vector3d p = now * mesh_.position (n); up.dot (p) + plane[3] < lowest)
        {
          lowest = up.dot (p) + plane[3];
          at = p;
        }
      result.push_back ({at, at - lowest * up, up, 0.3 * weight});
    }
  }

  /** \brief One step of Gauss and Newton for small turns, shifts and changes of scale about the middle of the points.
   */
  Similarity stepped (const Similarity& now, const std::vector<Match>& pairs) const
  {
    using Vector7 = Eigen::Matrix<double, 7, 1>;
    Eigen::Matrix<double, 7, 7> A = Eigen::Matrix<double, 7, 7>::Zero ();
    Vector7 b = Vector7::Zero ();
    const Eigen::Vector3d middle = points_.positions.rowwise ().mean ();
    const auto add = [&] (const Match& pair, const Eigen::Vector3d& along, double weight) {
      const Eigen::Vector3d arm = (pair.from - middle) / size_m_;
      Vector7 row;
      row << arm.cross (along), along, arm.dot (along);
      A += weight * row * row.transpose ();
      b += weight * row * along.dot (pair.to - pair.from) / size_m_;
    };
    for (const Match& pair : pairs)
    {
      add (pair, pair.normal, pair.weight);
      for (int axis = 0; axis < 3; ++axis)
        add (pair, Eigen::Vector3d::Unit (axis), along_surface * pair.weight);
    }
    A.diagonal ().array () += 1e-9 * A.trace () + 1e-12;
    const Vector7 x = A.ldlt ().solve (b);
    Similarity next = now;
    if (!x.allFinite ())
      return next;
    const double factor = std::exp (std::clamp (x[6], -0.1, 0.1)), angle = x.head<3> ().norm ();
    const Eigen::Matrix3d turn = angle > 0.0 ? Eigen::AngleAxisd (std::min (angle, 0.3), x.head<3> () / angle)
                                                   .toRotationMatrix ()
                                             : Eigen::Matrix3d (Eigen::Matrix3d::Identity ());
    next.scale *= factor;
    next.R = turn * now.R;
    next.t = middle + factor * (turn * (now.t - middle)) + size_m_ * x.segment<3> (3);
    return next;
  }

  Similarity refined (Similarity similarity, const OrientedColumns& points, Eigen::Index samples, int steps,
                      double first_m, double last_m) const
  {
    const double start_scale = similarity.scale;
    for (int n = 0; n < steps; ++n)
    {
      const double reach_m = first_m * std::pow (last_m / first_m, static_cast<double> (n) / (steps - 1));
      similarity = stepped (similarity, matches (similarity, points, samples, reach_m));
      similarity.scale = std::clamp (similarity.scale, start_scale / scale_range, start_scale * scale_range);
    }
    return similarity;
  }

  double costOf (const Similarity& similarity, Eigen::Index samples) const
  {
    const ProposalFit result = fit (similarity, samples);
    return (1.0 - result.explained) + (1.0 - result.confirmed) + 2.0 * result.contradicted;
  }
};

} // namespace

std::optional<ProposalFit>
alignMesh (const TriangleMesh& mesh, const MeasuredObject& object, int threads)
{
  if (object.points.size () < MeshEvidence::least_points)
    return std::nullopt;
  const Alignment alignment (mesh, object);
  if (!alignment.isPossible ())
    return std::nullopt;
  return alignment.best (threads);
}

} // namespace pcl::cosection
