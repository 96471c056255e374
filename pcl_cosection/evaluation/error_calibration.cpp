// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "error_calibration.h"

#include "pcl_cosection/volume/mesh_distance/mesh_bodies.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/evaluation/mesh_comparison.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace pcl::cosection {
namespace {

/** \brief The rank of each value, from 0; equal values share their mean rank. */
std::vector<double>
ranksOf (const std::vector<double>& values)
{
  std::vector<std::size_t> order (values.size ());
  std::iota (order.begin (), order.end (), std::size_t (0));
  std::sort (order.begin (), order.end (), [&] (std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks (values.size ());
  for (std::size_t begin = 0, end = 0; begin < order.size (); begin = end)
  {
    while (end < order.size () && values[order[end]] == values[order[begin]])
      ++end;
    for (std::size_t n = begin; n < end; ++n)
      ranks[order[n]] = 0.5 * static_cast<double> (begin + end - 1);
  }
  return ranks;
}

} // namespace

std::vector<VertexError>
vertexErrors (const SurfaceDistance& truth, const TriangleMesh& mesh, int threads)
{
  const std::size_t count = mesh.vertices.size ();
  if (mesh.sigma_m.size () != count || mesh.provenance.size () != count)
    return {};
  const std::vector<double> distances = vertexDistances (mesh, truth, threads);
  std::vector<VertexError> errors (count);
  for (std::size_t v = 0; v < count; ++v)
    errors[v] = {distances[v], mesh.sigma_m[v], mesh.provenance[v]};
  return errors;
}

ErrorCoverage
errorCoverage (const std::vector<VertexError>& errors)
{
  ErrorCoverage coverage;
  coverage.vertices = errors.size ();
  std::vector<double> distances;
  for (const VertexError& vertex : errors)
  {
    coverage.within_sigma += vertex.error_m <= vertex.sigma_m;
    coverage.within_two_sigma += vertex.error_m <= 2.0 * vertex.sigma_m;
    coverage.mean_sigma_m += vertex.sigma_m;
    distances.push_back (vertex.error_m);
  }
  for (double* const sum : {&coverage.within_sigma, &coverage.within_two_sigma, &coverage.mean_sigma_m})
    *sum /= static_cast<double> (std::max<std::size_t> (1, errors.size ()));
  const ErrorStatistics statistics = errorStatistics (std::move (distances));
  coverage.mean_error_m = statistics.mean;
  coverage.p95_error_m = statistics.p95;
  return coverage;
}

ErrorCoverage
errorCoverage (const std::vector<VertexError>& errors, Provenance provenance)
{
  std::vector<VertexError> some;
  std::copy_if (errors.begin (), errors.end (), std::back_inserter (some), [provenance] (const VertexError& vertex) {
    return vertex.provenance == static_cast<std::uint8_t> (provenance);
  });
  return errorCoverage (some);
}

std::vector<ErrorCoverage>
calibrationCurve (std::vector<VertexError> errors, std::size_t classes)
{
  std::sort (errors.begin (), errors.end (), [] (const VertexError& a, const VertexError& b) {
    return a.sigma_m != b.sigma_m ? a.sigma_m < b.sigma_m : a.error_m < b.error_m;
  });
  std::vector<ErrorCoverage> curve;
  for (std::size_t c = 0; c < classes; ++c)
  {
    const auto first = static_cast<std::ptrdiff_t> (errors.size () * c / classes);
    const auto last = static_cast<std::ptrdiff_t> (errors.size () * (c + 1) / classes);
    if (first < last)
      curve.push_back (errorCoverage (std::vector<VertexError> (errors.begin () + first, errors.begin () + last)));
  }
  return curve;
}

double
rankCorrelation (const std::vector<VertexError>& errors)
{
  std::vector<double> distances, sigmas;
  for (const VertexError& vertex : errors)
  {
    distances.push_back (vertex.error_m);
    sigmas.push_back (vertex.sigma_m);
  }
  const std::vector<double> a = ranksOf (distances), b = ranksOf (sigmas);
  const double mean = 0.5 * (static_cast<double> (errors.size ()) - 1.0);
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t n = 0; n < a.size (); ++n)
  {
    ab += (a[n] - mean) * (b[n] - mean);
    aa += (a[n] - mean) * (a[n] - mean);
    bb += (b[n] - mean) * (b[n] - mean);
  }
  return aa > 0.0 && bb > 0.0 ? ab / std::sqrt (aa * bb) : 0.0;
}

double
shareInside (const TriangleMesh& surface, const TriangleMesh& bound, double tolerance_m, std::size_t samples,
             std::uint64_t seed)
{
  if (!computeTopology (bound).closed_manifold)
    throw InvalidArgument ("shareInside: the bound is not closed");
  std::vector<std::uint32_t> all (bound.triangles.size ());
  std::iota (all.begin (), all.end (), 0u);
  const SearchableSurface searchable (bound, all);
  const std::vector<Eigen::Vector3d> points = sampleSurface (surface, samples, seed);
  const auto inside = std::count_if (points.begin (), points.end (), [&] (const Eigen::Vector3d& p) {
    const NearestPoint nearest = searchable.tree.nearest (p);
    const double side = searchable.side (nearest);
    return side < 0.0 || nearest.squared_m2 <= tolerance_m * tolerance_m || (side == 0.0 && searchable.isInMatter (p));
  });
  return static_cast<double> (inside) / static_cast<double> (points.size ());
}

} // namespace pcl::cosection
