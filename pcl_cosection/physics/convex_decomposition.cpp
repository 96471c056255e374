// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/physics/convex_decomposition.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/common/plane_height.h"
#include "pcl_cosection/physics/clipped_mesh.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/mesh_decimation.h>
#include <pcl/cosection/volume/mesh_distance.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

namespace pcl::cosection {

namespace {

constexpr std::size_t search_triangles = 1500; // of the mesh on which planes are searched
constexpr double samples_inside = 20000.0;     // voxels by which volumes are measured
constexpr double most_voxels = 2e6;            // of the grid around a thin body
constexpr double largest_grid = 2.0;           // times as many, where voxels are larger than a body is thick
constexpr double growth = 0.1;                 // of voxels, while there are too many
constexpr int offsets = 7;                     // planes tried along an axis
constexpr int refinements = 2;                 // halvings of their distance around the best one
constexpr double more_parts = 1.5;             // times as many as asked for, before pairs are united
constexpr double balance_weight = 1e-3;        // of halves of equal size, where volumes do not decide
constexpr double contact_weight = 100.0;       // a point to avoid counts as so many of the body's samples

/** \brief What lies between some planes. */
struct Cell
{
  std::vector<Eigen::Vector4d> planes; ///< n.x + d <= 0
  MeshPiece piece;                     ///< of the coarse mesh
  std::vector<Eigen::Vector3d> samples, avoid;
  ConvexHull hull; ///< of what the full mesh has there
  double excess_m3 = 0.0;
};

struct Body
{
  const TriangleMesh& mesh;
  WindingNumber winding;
  double volume_m3 = 0.0;
  double sample_m3 = 0.0; ///< what a sample stands for
  double tolerance_m = 0.0;
};

struct Cut
{
  Eigen::Vector4d plane = Eigen::Vector4d::Zero ();
  double cost = std::numeric_limits<double>::infinity ();
};

/** \brief Volume that points to avoid, deep inside, stand for. */
double
contactCost (const ConvexHull& hull, const std::vector<Eigen::Vector3d>& avoid, const Body& body)
{
  const auto inside = std::count_if (avoid.begin (), avoid.end (),
                                     [&] (const Eigen::Vector3d& p) { return (hull.depthOf (p) > body.tolerance_m); });
  return contact_weight * body.sample_m3 * static_cast<double> (inside);
}

double
excessOf (const Cell& cell, const Body& body)
{
  const double volume = body.sample_m3 * static_cast<double> (cell.samples.size ());
  return std::max (0.0, cell.hull.volume_m3 - volume) + contactCost (cell.hull, cell.avoid, body);
}

double
costOf (const Cell& cell, const Eigen::Vector4d& plane, const Body& body)
{
  double cost = 0.0;
  std::array<std::size_t, 2> samples{};
  for (int side = 0; side < 2; ++side)
  {
    const Eigen::Vector4d towards = side == 0 ? plane : Eigen::Vector4d (-plane);
    const ConvexHull hull = convexHullOf (pointsBehind (cell.piece, towards));
    if (hull.empty ())
      return std::numeric_limits<double>::infinity ();
    cost += hull.volume_m3 + contactCost (hull, cell.avoid, body);
    samples[side] = std::count_if (cell.samples.begin (), cell.samples.end (),
                                   [&] (const Eigen::Vector3d& p) { return (heightOver (towards, p) <= 0.0); });
    if (samples[side] == 0)
      return std::numeric_limits<double>::infinity ();
  }
  const double difference = std::abs (static_cast<double> (samples[0]) - static_cast<double> (samples[1]));
  return cost + balance_weight * body.sample_m3 * difference;
}

/** \brief The axes of the frame, and the principal ones of the samples. */
std::vector<Eigen::Vector3d>
axesOf (const std::vector<Eigen::Vector3d>& samples)
{
  std::vector<Eigen::Vector3d> axes = {Eigen::Vector3d::UnitX (), Eigen::Vector3d::UnitY (), Eigen::Vector3d::UnitZ ()};
  Eigen::Vector3d mean = Eigen::Vector3d::Zero ();
  for (const Eigen::Vector3d& p : samples)
    mean += p / static_cast<double> (samples.size ());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero ();
  for (const Eigen::Vector3d& p : samples)
    covariance += (p - mean) * (p - mean).transpose ();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver (covariance);
  for (int n = 0; n < 3; ++n)
    axes.emplace_back (solver.eigenvectors ().col (n));
  return axes;
}

/** \brief The plane that leaves the smallest hulls. */
Cut
bestCut (const Cell& cell, const Body& body, int threads)
{
  struct Range
  {
    Eigen::Vector3d axis;
    double low, high;
  };
  std::vector<Range> ranges;
  for (const Eigen::Vector3d& axis : axesOf (cell.samples))
  {
    Range range{axis, std::numeric_limits<double>::infinity (), -std::numeric_limits<double>::infinity ()};
    for (const Eigen::Vector3d& corner : cell.hull.corners)
    {
      range.low = std::min (range.low, axis.dot (corner));
      range.high = std::max (range.high, axis.dot (corner));
    }
    ranges.push_back (range);
  }
  const auto best = [&] (std::vector<Cut> cuts) {
    parallelFor (0, static_cast<int> (cuts.size ()), threads,
                 [&] (int n) { cuts[n].cost = costOf (cell, cuts[n].plane, body); });
    return std::min_element (cuts.begin (), cuts.end (), [] (const Cut& a, const Cut& b) { return a.cost < b.cost; }) -
           cuts.begin ();
  };
  const auto planeAt = [&] (const Range& range, double share) {
    Eigen::Vector4d plane;
    plane << range.axis, -(range.low + share * (range.high - range.low));
    return plane;
  };
  std::vector<std::pair<std::size_t, double>> places;
  for (std::size_t n = 0; n < ranges.size (); ++n)
    for (int k = 1; k <= offsets; ++k)
      places.emplace_back (n, static_cast<double> (k) / (offsets + 1));
  Cut result;
  double step = 1.0 / (offsets + 1);
  for (int round = 0; round <= refinements; ++round, step *= 0.5)
  {
    std::vector<Cut> cuts;
    for (const auto& [n, share] : places)
      cuts.push_back ({planeAt (ranges[n], share), 0.0});
    const std::size_t chosen = best (cuts);
    const Cut found{cuts[chosen].plane, costOf (cell, cuts[chosen].plane, body)};
    if (found.cost < result.cost || round == 0)
      result = found;
    const auto [axis, share] = places[chosen];
    places = {{axis, share - 0.5 * step}, {axis, share}, {axis, share + 0.5 * step}};
  }
  return result;
}

Cell
halfOf (const Cell& cell, const Eigen::Vector4d& plane, const Body& body)
{
  Cell half;
  half.planes = cell.planes;
  half.planes.push_back (plane);
  half.piece = pieceBehind (cell.piece, plane);
  const auto isBehind = [&] (const Eigen::Vector3d& p) { return heightOver (plane, p) <= 0.0; };
  std::copy_if (cell.samples.begin (), cell.samples.end (), std::back_inserter (half.samples), isBehind);
  half.hull = convexHullOf (pointsBetween (body.mesh, half.planes, body.winding));
  std::copy_if (cell.avoid.begin (), cell.avoid.end (), std::back_inserter (half.avoid),
                [&] (const Eigen::Vector3d& p) { return half.hull.depthOf (p) > body.tolerance_m; });
  half.excess_m3 = excessOf (half, body);
  return half;
}

/** \brief Points inside a closed mesh: centres of voxels, of which each stands for the same volume. */
std::vector<Eigen::Vector3d>
interiorSamples (const TriangleMesh& mesh, double volume_m3, int threads)
{
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    box.extend (vertex.cast<double> ());
  VoxelGrid grid;
  grid.voxel_size_m = std::cbrt (std::max (volume_m3 / samples_inside, box.volume () / most_voxels));
  const auto voxelsAlong = [&] { return (box.sizes () / grid.voxel_size_m).array ().ceil ().max (1.0).eval (); };
  while (!(voxelsAlong ().prod () <= largest_grid * most_voxels)) // it is flat
    grid.voxel_size_m *= 1.0 + growth;
  grid.dims = voxelsAlong ().cast<int> ();
  grid.origin_m = box.center () - 0.5 * grid.voxel_size_m * (grid.dims.cast<double> ().array () - 1.0).matrix ();
  const SignedDistanceField field = sampleSignedDistance (mesh, grid, grid.voxel_size_m, threads);
  std::vector<Eigen::Vector3d> samples;
  for (int k = 0; k < grid.dims.z (); ++k)
    for (int j = 0; j < grid.dims.y (); ++j)
      for (int i = 0; i < grid.dims.x (); ++i)
        if (field.values[grid.index (i, j, k)] < 0.0f)
          samples.push_back (grid.center (i, j, k));
  return samples;
}

std::vector<Cell>
divide (Body& body, const ConvexDecompositionOptions& options)
{
  const TriangleMesh& mesh = body.mesh;
  Cell whole;
  whole.piece = pieceOf (mesh.triangles.size () > search_triangles ? decimate (mesh, search_triangles) : mesh);
  whole.samples = interiorSamples (mesh, body.volume_m3, options.threads);
  whole.hull = convexHullOf (pieceOf (mesh).vertices);
  whole.avoid = options.avoid;
  if (whole.samples.empty () || whole.hull.empty ())
    return {whole};
  body.sample_m3 = body.volume_m3 / static_cast<double> (whole.samples.size ());
  whole.excess_m3 = excessOf (whole, body);
  std::vector<Cell> cells = {std::move (whole)};
  const auto wanted = static_cast<std::size_t> (options.max_parts == 1 ? 1 : more_parts * options.max_parts);
  while (cells.size () < wanted)
  {
    double excess = 0.0;
    for (const Cell& cell : cells)
      excess += cell.excess_m3;
    const auto worst = std::max_element (cells.begin (), cells.end (),
                                         [] (const Cell& a, const Cell& b) { return a.excess_m3 < b.excess_m3; });
    if (excess <= options.max_excess * body.volume_m3 || worst->excess_m3 <= 0.0)
      break;
    const Cut cut = bestCut (*worst, body, options.threads);
    if (cut.cost == std::numeric_limits<double>::infinity ())
    {
      worst->excess_m3 = 0.0; // too small to be cut
      continue;
    }
    Cell front = halfOf (*worst, -cut.plane, body);
    *worst = halfOf (*worst, cut.plane, body);
    cells.push_back (std::move (front));
  }
  return cells;
}

/** \brief Unite the pair of hulls that costs least, while there are too many or it costs hardly anything. */
void
unite (std::vector<ConvexHull>& hulls, const ConvexDecompositionOptions& options, const Body& body)
{
  const auto unionOf = [] (const ConvexHull& a, const ConvexHull& b) {
    std::vector<Eigen::Vector3d> points = a.corners;
    points.insert (points.end (), b.corners.begin (), b.corners.end ());
    return convexHullOf (points);
  };
  const auto costOfUnion = [&] (const ConvexHull& a, const ConvexHull& b) {
    const ConvexHull both = unionOf (a, b);
    return both.volume_m3 - a.volume_m3 - b.volume_m3 + contactCost (both, options.avoid, body) -
           contactCost (a, options.avoid, body) - contactCost (b, options.avoid, body);
  };
  double total = 0.0;
  for (const ConvexHull& hull : hulls)
    total += hull.volume_m3;
  std::vector<std::vector<double>> costs (hulls.size ()); // costs[a][b], b < a
  parallelFor (0, static_cast<int> (hulls.size ()), options.threads, [&] (int a) {
    for (int b = 0; b < a; ++b)
      costs[a].push_back (costOfUnion (hulls[a], hulls[b]));
  });
  while (hulls.size () > 1)
  {
    double least = std::numeric_limits<double>::infinity ();
    std::size_t first = 0, second = 0;
    for (std::size_t a = 1; a < hulls.size (); ++a)
      for (std::size_t b = 0; b < a; ++b)
        if (costs[a][b] < least)
        {
          least = costs[a][b];
          first = b;
          second = a;
        }
    const bool too_many = hulls.size () > static_cast<std::size_t> (options.max_parts);
    if (!too_many && total + least > (1.0 + options.max_excess) * body.volume_m3 && least > 0.0)
      break;
    total += least;
    hulls[first] = unionOf (hulls[first], hulls[second]);
    hulls.erase (hulls.begin () + static_cast<std::ptrdiff_t> (second));
    costs.erase (costs.begin () + static_cast<std::ptrdiff_t> (second));
    for (std::size_t a = second; a < hulls.size (); ++a)
      costs[a].erase (costs[a].begin () + static_cast<std::ptrdiff_t> (second));
    for (std::size_t other = 0; other < hulls.size (); ++other)
      if (other != first)
        costs[std::max (first, other)][std::min (first, other)] = costOfUnion (hulls[first], hulls[other]);
  }
}

std::vector<ConvexHull>
partsOf (Body& body, const ConvexDecompositionOptions& options)
{
  std::vector<ConvexHull> hulls;
  for (Cell& cell : divide (body, options))
    if (!cell.hull.empty ())
      hulls.push_back (std::move (cell.hull));
  unite (hulls, options, body);
  return hulls;
}

double
contactCost (const std::vector<ConvexHull>& hulls, const std::vector<Eigen::Vector3d>& avoid, const Body& body)
{
  return std::accumulate (hulls.begin (), hulls.end (), 0.0,
                          [&] (double sum, const ConvexHull& hull) { return sum + contactCost (hull, avoid, body); });
}

} // namespace

std::vector<ConvexHull>
decomposeConvex (const TriangleMesh& mesh, const ConvexDecompositionOptions& options)
{
  if (options.max_parts < 1 || !(options.max_excess >= 0.0) || !(options.tolerance_m >= 0.0))
    throw InvalidArgument ("convex decomposition: needs at least one part, and excess and tolerance not below zero");
  if (!computeTopology (mesh).closed_manifold)
    throw InvalidArgument ("convex decomposition: the mesh is not closed");
  Body body{mesh, WindingNumber (mesh), computeMassProperties (mesh).volume_m3, 0.0, options.tolerance_m};
  if (!(body.volume_m3 > 0.0))
    throw InvalidArgument ("convex decomposition: the mesh has no volume, or is turned inside out");
  ConvexDecompositionOptions anywhere = options;
  anywhere.avoid.clear ();
  std::vector<ConvexHull> plain = partsOf (body, anywhere);
  if (contactCost (plain, options.avoid, body) == 0.0)
    return plain;
  std::vector<ConvexHull> avoiding = partsOf (body, options); // mostly better, but cuts are found one by one
  const auto costOfAll = [&] (const std::vector<ConvexHull>& hulls) {
    return std::accumulate (hulls.begin (), hulls.end (), contactCost (hulls, options.avoid, body),
                            [] (double sum, const ConvexHull& hull) { return sum + hull.volume_m3; });
  };
  return costOfAll (avoiding) < costOfAll (plain) ? avoiding : plain;
}

} // namespace pcl::cosection
