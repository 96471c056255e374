// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "even_samples.h"

#include "area_samples.h"
#include "triangle_shape.h"

#include "pcl_cosection/common/lattice_cells.h"
#include "pcl_cosection/common/parallel.h"

#include <pcl/cosection/common/error.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr std::uint64_t seed = 0;
constexpr std::size_t candidates_per_sample = 5; // more make it more even, and take longer
constexpr std::size_t least_candidates = 1000;
constexpr float opposite_cosine = -0.5f;

/** \brief The mean of what \a valueOf (vertex) says of the corners around a place. */
template <typename ValueOf>
auto
meanAt (const TriangleMesh& mesh, const MeshPlace& place, const ValueOf& valueOf)
{
  const TriangleMesh::Triangle& corners = mesh.triangles[place.triangle];
  decltype (valueOf (0)) sum = place.weights[0] * valueOf (corners[0]);
  for (std::size_t n = 1; n < corners.size (); ++n)
    sum += place.weights[n] * valueOf (corners[n]);
  return sum;
}

Eigen::Vector3f
normalAt (const TriangleMesh& mesh, const MeshPlace& place)
{
  const Eigen::Vector3d flat = areaVector (mesh, mesh.triangles[place.triangle]).stableNormalized ();
  if (mesh.normals.empty ())
    return flat.cast<float> ();
  const auto normalOf = [&] (std::uint32_t v) -> Eigen::Vector3d { return mesh.normals[v].cast<double> (); };
  const Eigen::Vector3d mean = meanAt (mesh, place, normalOf).stableNormalized ();
  return (mean.dot (flat) > 0.0 ? mean : flat).cast<float> (); // the triangle's as well if the mean is not a number
}

/** \brief Where a point may be. */
struct Candidate
{
  Eigen::Vector3f position; // in units of the radius
  Eigen::Vector3f normal;
};

/** \brief Candidates, those in one cell of a lattice together. */
class CandidateSet
{
public:
  /** \param[in] sampler at its beginning \param[in] radius_m within which candidates are neighbours */
  CandidateSet (const TriangleMesh& mesh, AreaSampler sampler, std::size_t count, double radius_m);

  std::uint32_t size () const { return static_cast<std::uint32_t> (candidates_.size ()); }

  /** \brief Which candidate was drawn as number \a n. */
  std::uint32_t drawnAs (std::size_t n) const { return places_[n]; }

  /** \brief Call \a visit (other, distance in units of the radius) for the neighbours of one. */
  template <typename Visit> void forNeighbours (std::uint32_t n, Visit&& visit) const
  {
    const Candidate& one = candidates_[n];
    const std::uint32_t cell = cell_of_[n];
    for (std::uint32_t k = first_near_[cell]; k < first_near_[cell + 1]; ++k)
      for (std::uint32_t m = begin_[near_[k]]; m < begin_[near_[k] + 1]; ++m)
        if (const float squared = (candidates_[m].position - one.position).squaredNorm ();
            squared < 1.0f && m != n && candidates_[m].normal.dot (one.normal) > opposite_cosine)
          visit (m, std::sqrt (squared));
  }

private:
  std::vector<Candidate> candidates_;
  std::vector<std::uint32_t> cell_of_;    // by candidate
  std::vector<std::uint32_t> places_;     // by the order in which they were drawn
  std::vector<std::uint32_t> begin_;      // of each cell's candidates, and their number
  std::vector<std::uint32_t> near_;       // cells at most one away from each, cell by cell
  std::vector<std::uint32_t> first_near_; // of each cell, and their number
};

CandidateSet::CandidateSet (const TriangleMesh& mesh, AreaSampler sampler, std::size_t count, double radius_m)
    : candidates_ (count)
    , cell_of_ (count)
    , places_ (count)
{
  Eigen::AlignedBox3d box;
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle)
      box.extend (mesh.vertices[v].cast<double> ());
  // Cells may be larger than the radius, where a mesh is long and thin.
  const double cell_size = std::max (1.0, box.sizes ().maxCoeff () / radius_m / (farthest_cell - 4.0));
  const auto cellAround = [&] (const Candidate& one) {
    return cellOf (one.position.cast<double> () / cell_size).value ();
  };
  std::vector<Candidate> drawn;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order; // keys of cells, so that near ones are often neighbours
  drawn.reserve (count);
  order.reserve (count);
  for (std::uint32_t n = 0; n < count; ++n)
  {
    const MeshPlace place = sampler.next ();
    drawn.push_back (
        {((place.position - box.min ()) / radius_m).cwiseMax (0.0).cast<float> (), normalAt (mesh, place)});
    order.emplace_back (keyOf (cellAround (drawn.back ())), n);
  }
  std::sort (order.begin (), order.end ());
  OccupiedCells cells;
  for (std::uint32_t place = 0; place < count; ++place)
  {
    const std::uint32_t n = order[place].second;
    places_[n] = place;
    candidates_[place] = drawn[n];
    cell_of_[place] = static_cast<std::uint32_t> (cells.add (cellAround (drawn[n])));
    if (cell_of_[place] == begin_.size ())
      begin_.push_back (place);
  }
  begin_.push_back (size ());
  for (std::size_t cell = 0; cell < cells.size (); ++cell)
  {
    first_near_.push_back (static_cast<std::uint32_t> (near_.size ()));
    cells.forNeighbours (cell, [&] (std::size_t other) { near_.push_back (static_cast<std::uint32_t> (other)); });
  }
  first_near_.push_back (static_cast<std::uint32_t> (near_.size ()));
}

/** \brief Eliminates candidates until \a count are there. \return whether each is, in the order of drawing */
std::vector<bool>
eliminate (const CandidateSet& candidates, std::size_t count, int threads)
{
  // The weights of the paper and their limit, in units of the radius, 2 r_max: (1 - max (d, 2 r_min))^8.
  const double kept = static_cast<double> (count) / candidates.size ();
  const auto least = static_cast<float> (0.65 * (1.0 - std::pow (kept, 1.5)));
  const auto weightAt = [least] (float distance) {
    const float near = 1.0f - std::max (distance, least);
    const float fourth = near * near * near * near;
    return fourth * fourth;
  };
  std::vector<float> weights (candidates.size (), 0.0f);
  parallelFor (0, static_cast<int> (candidates.size ()), threads, [&] (int n) {
    candidates.forNeighbours (static_cast<std::uint32_t> (n),
                              [&] (std::uint32_t, float distance) { weights[n] += weightAt (distance); });
  });

  // Weights only fall: what comes first has the largest weight if its entry is not older than the last change. It has
  // the number of drawing, so that of equal ones a random one is first.
  std::vector<std::pair<float, std::uint32_t>> heap;
  heap.reserve (candidates.size ());
  for (std::uint32_t n = 0; n < candidates.size (); ++n)
    heap.emplace_back (weights[candidates.drawnAs (n)], n);
  std::make_heap (heap.begin (), heap.end ());
  std::vector<bool> there (candidates.size (), true);
  while (heap.size () > count)
  {
    std::pop_heap (heap.begin (), heap.end ());
    const auto [weight, drawn] = heap.back ();
    const std::uint32_t n = candidates.drawnAs (drawn);
    if (weight > weights[n])
    {
      heap.back ().first = weights[n];
      std::push_heap (heap.begin (), heap.end ());
      continue;
    }
    heap.pop_back ();
    there[drawn] = false;
    candidates.forNeighbours (n, [&] (std::uint32_t other, float distance) { weights[other] -= weightAt (distance); });
  }
  return there;
}

std::uint32_t
nearestCorner (const TriangleMesh& mesh, const MeshPlace& place)
{
  const TriangleMesh::Triangle& corners = mesh.triangles[place.triangle];
  const auto distanceTo = [&] (std::uint32_t v) {
    return (mesh.vertices[v].cast<double> () - place.position).squaredNorm ();
  };
  return *std::min_element (corners.begin (), corners.end (),
                            [&] (std::uint32_t a, std::uint32_t b) { return distanceTo (a) < distanceTo (b); });
}

/** \brief Append a place of a mesh to a set of points, with what the vertices have there. */
void
appendPlace (const TriangleMesh& mesh, const MeshPlace& place, TriangleMesh& points)
{
  points.vertices.push_back (place.position.cast<float> ());
  points.normals.push_back (normalAt (mesh, place));
  const auto appendMean = [&] (const std::vector<float>& from, std::vector<float>& to) {
    const auto valueOf = [&] (std::uint32_t v) { return static_cast<double> (from[v]); };
    if (!from.empty ())
      to.push_back (static_cast<float> (meanAt (mesh, place, valueOf)));
  };
  appendMean (mesh.intensity, points.intensity);
  appendMean (mesh.confidence, points.confidence);
  appendMean (mesh.sigma_m, points.sigma_m);
  if (!mesh.colours.empty ())
  {
    TriangleMesh::Colour& colour = points.colours.emplace_back ();
    for (std::size_t channel = 0; channel < colour.size (); ++channel)
    {
      const auto valueOf = [&] (std::uint32_t v) { return static_cast<double> (mesh.colours[v][channel]); };
      colour[channel] = static_cast<std::uint8_t> (std::lround (meanAt (mesh, place, valueOf)));
    }
  }
  if (!mesh.provenance.empty ())
    points.provenance.push_back (mesh.provenance[nearestCorner (mesh, place)]);
}

} // namespace

double
hexagonalSpacing (double area_m2, std::size_t count)
{
  return std::sqrt (2.0 * area_m2 / (std::sqrt (3.0) * static_cast<double> (count)));
}

TriangleMesh
sampleEvenly (const TriangleMesh& mesh, std::size_t count, int threads)
{
  if (count < 1 || count > most_even_samples)
    throw InvalidArgument ("sampleEvenly: the number of points must be from 1 to " +
                           std::to_string (most_even_samples));
  AreaSampler sampler (mesh, seed, "sampleEvenly");
  const std::size_t drawn = std::max (candidates_per_sample * count, least_candidates);
  const CandidateSet candidates (mesh, sampler, drawn, hexagonalSpacing (sampler.area (), count));
  const std::vector<bool> there = eliminate (candidates, count, threads);
  // Drawn once more, which takes less memory than to keep all that is known of candidates.
  TriangleMesh points;
  for (std::size_t n = 0; n < drawn; ++n)
    if (const MeshPlace place = sampler.next (); there[n])
      appendPlace (mesh, place, points);
  return points;
}

} // namespace pcl::cosection
