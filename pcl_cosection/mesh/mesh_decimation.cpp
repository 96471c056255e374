// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Written by hand, because vtkQuadricDecimation, which pcl::MeshQuadricDecimationVTK wraps, does not promise that a
// closed manifold stays one.

#include "collapsible_mesh.h"
#include "mesh_attributes.h"
#include "mesh_checks.h"
#include "pcl_cosection/common/require.h"
#include "quadric.h"
#include "triangle_shape.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/mesh_decimation.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

namespace pcl::cosection {
namespace {

using Vertex = CollapsibleMesh::Vertex;

// Costs are squared distances times the weight of a quadric. The first three are fractions of the squared length of the
// edge, so they matter only between collapses that do about the same harm.

/** \brief Penalty for positions away from the middle of the edge: above the rounding of single precision, below any
 * error that could be seen. */
constexpr double shift_penalty = 1e-9;

/** \brief Penalty for long edges: flat parts get even triangles. */
constexpr double length_penalty = 1e-7;

/** \brief Penalty for making a thin triangle: as bad as an error of half a percent of the edge's length. More would
 * rather flatten plates than have the thin triangles that their rims need. */
constexpr double thin_penalty = 3e-5;

/** \brief Farther than this many lengths of the edge from its middle, the minimum says nothing about the edge. */
constexpr double max_shift = 2.0;

/** \brief A thinner triangle's normal is no reference: its corners' rounding turns it. */
constexpr double thin_quality = 0.01;

/** \brief Thinner triangles are never made: when their corners are rounded to single precision they might flip. */
constexpr double least_quality = 1e-3;

/** \brief The least share of a closed surface's volume that is kept: with less, thin walls lie on each other, or turn
 * inside out. */
constexpr double least_volume_share = 0.1;

/** \brief Fraction of the way from \a a to \a b at which \a x lies. */
double
fractionAlong (const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& x)
{
  const double squared_length = (b - a).squaredNorm ();
  return squared_length > 0.0 ? std::clamp ((x - a).dot (b - a) / squared_length, 0.0, 1.0) : 0.5;
}

/** \brief Where vertices u and v become one, and what that costs. */
struct Merge
{
  Eigen::Vector3d position;
  double cost;
};

/** \brief What a collapse would do to the triangles around its edge. */
struct ShapeChange
{
  bool flips = false;          ///< does a triangle turn too far?
  double quality_before = 1.0; ///< of the worst triangle
  double quality_after = 1.0;
};

/** \brief An entry of the heap; outdated when one of its vertices has changed since. */
struct Candidate
{
  double cost;
  Vertex u, v;
  std::uint32_t revision; ///< of u plus of v: both only grow
  bool thin;              ///< the cost contains the penalty for thin triangles

  /** \brief Order of a heap whose top is the cheapest; never equal for different edges, so that the order of insertion
   * does not matter. */
  bool operator<(const Candidate& other) const
  {
    return std::tie (other.cost, other.u, other.v) < std::tie (cost, u, v);
  }
};

class Decimator
{
public:
  Decimator (const TriangleMesh& mesh, const DecimationOptions& options)
      : options_ (options)
      , min_turn_cosine_ (std::cos (options.max_normal_turn_deg * M_PI / 180.0))
      , mesh_ (mesh)
      , surface_ (mesh.triangles, mesh.vertices.size ())
      , quadrics_ (mesh.vertices.size ())
      , revisions_ (mesh.vertices.size (), 0)
  {
    centre ();
    for (const auto& triangle : mesh.triangles)
      addPlanes (triangle);
  }

  TriangleMesh run ()
  {
    while (!reached () && collapseEdges ()) // again: what was blocked may have become free
    {}
    return result ();
  }

private:
  bool reached () const { return surface_.triangleCount () <= options_.max_triangles; }

  /** \brief Positions about the middle of the mesh, in double precision: the quadrics' terms cancel less. */
  void centre ()
  {
    Eigen::AlignedBox3d box;
    for (const auto& triangle : mesh_.triangles)
      for (const auto v : triangle)
        box.extend (mesh_.vertices[v].cast<double> ());
    centre_ = box.center ();
    positions_.reserve (mesh_.vertices.size ());
    for (const auto& vertex : mesh_.vertices)
      positions_.push_back (vertex.cast<double> () - centre_);
  }

  void addPlanes (const TriangleMesh::Triangle& triangle)
  {
    const Eigen::Vector3d area = areaVector (positions_[triangle[0]], positions_[triangle[1]], positions_[triangle[2]]);
    if (!(area.norm () > 0.0))
      return;
    const Eigen::Vector3d normal = area.normalized ();
    for (const auto v : triangle)
      quadrics_[v].addPlane (normal, positions_[triangle[0]], 0.5 * area.norm ());
    for (int n = 0; n < 3; ++n)
      if (surface_.isBoundary (triangle[n], triangle[(n + 1) % 3]))
        addBoundaryPlane (normal, triangle[n], triangle[(n + 1) % 3]);
  }

  void addBoundaryPlane (const Eigen::Vector3d& surface_normal, Vertex u, Vertex v)
  {
    const Eigen::Vector3d edge = positions_[v] - positions_[u];
    const Eigen::Vector3d outward = edge.cross (surface_normal).normalized ();
    for (const auto end : {u, v})
      quadrics_[end].addPlane (outward, positions_[u], options_.boundary_weight * edge.squaredNorm ());
  }

  Merge bestMerge (Vertex u, Vertex v) const
  {
    Quadric sum = quadrics_[u];
    sum += quadrics_[v];
    const Eigen::Vector3d middle = 0.5 * (positions_[u] + positions_[v]);
    const double squared_length = (positions_[v] - positions_[u]).squaredNorm ();
    const double penalty = shift_penalty * sum.weight ();

    Merge best = {middle, std::numeric_limits<double>::infinity ()};
    const auto consider = [&] (const Eigen::Vector3d& x) {
      const double cost = std::max (sum (x), 0.0) + penalty * (x - middle).squaredNorm ();
      if (cost < best.cost)
        best = {x, cost};
    };
    const Eigen::Vector3d minimum = sum.minimumNear (middle);
    if ((minimum - middle).squaredNorm () <= max_shift * max_shift * squared_length)
      consider (minimum);
    consider (middle);
    consider (positions_[u]);
    consider (positions_[v]);
    best.cost += length_penalty * sum.weight () * squared_length;
    return best;
  }

  void push (Vertex a, Vertex b)
  {
    const Vertex u = std::min (a, b);
    const Vertex v = std::max (a, b);
    heap_.push_back ({bestMerge (u, v).cost, u, v, revisions_[u] + revisions_[v], false});
  }

  /** \brief Collapse edges, the cheapest first, until the target is reached or no edge is left that may collapse.
   * \return has there been any? */
  bool collapseEdges ()
  {
    heap_.clear ();
    for (Vertex u = 0; u < positions_.size (); ++u)
      surface_.forEachEdgeAt (u, [&] (Vertex v, bool) {
        if (u < v)
          push (u, v);
      });
    std::make_heap (heap_.begin (), heap_.end ());
    const std::size_t before = surface_.triangleCount ();
    while (!heap_.empty () && !reached ())
    {
      std::pop_heap (heap_.begin (), heap_.end ());
      const Candidate top = heap_.back ();
      heap_.pop_back ();
      if (top.revision != revisions_[top.u] + revisions_[top.v] || !surface_.mayCollapse (top.u, top.v))
        continue;
      const Eigen::Vector3d position = bestMerge (top.u, top.v).position;
      const ShapeChange change = shapeChange (top.u, top.v, position);
      if (change.flips || change.quality_after < std::min (least_quality, change.quality_before))
        continue;
      const bool thin = change.quality_after < std::min (options_.min_quality, change.quality_before);
      if (thin && !top.thin)
        postpone (top, change);
      else
        collapse (top.u, top.v, position);
    }
    return surface_.triangleCount () < before;
  }

  /** \brief Let a collapse that makes a thin triangle wait for those that do less harm. */
  void postpone (Candidate candidate, const ShapeChange& change)
  {
    const double squared_length = (positions_[candidate.v] - positions_[candidate.u]).squaredNorm ();
    const double weight = quadrics_[candidate.u].weight () + quadrics_[candidate.v].weight ();
    candidate.cost += thin_penalty * (1.0 - change.quality_after / options_.min_quality) * weight * squared_length;
    candidate.thin = true;
    heap_.push_back (candidate);
    std::push_heap (heap_.begin (), heap_.end ());
  }

  void collapse (Vertex u, Vertex v, const Eigen::Vector3d& position)
  {
    blendAttributes (mesh_, u, v, fractionAlong (positions_[u], positions_[v], position));
    positions_[u] = position;
    quadrics_[u] += quadrics_[v];
    surface_.collapse (u, v);
    ++revisions_[u];
    ++revisions_[v];
    surface_.forEachEdgeAt (u, [&] (Vertex w, bool) {
      push (u, w);
      std::push_heap (heap_.begin (), heap_.end ());
    });
  }

  ShapeChange shapeChange (Vertex u, Vertex v, const Eigen::Vector3d& x)
  {
    moved_.clear ();
    ShapeChange change;
    Eigen::Vector3d total_area = Eigen::Vector3d::Zero ();
    const auto gather = [&] (Vertex end, Vertex other) {
      surface_.forEachTriangleAt (end, [&] (Vertex p, Vertex q) {
        const bool vanishes = p == other || q == other;
        if (vanishes && end == v)
          return; // seen from u
        const Eigen::Vector3d area = areaVector (positions_[end], positions_[p], positions_[q]);
        const double before = triangleQuality (area, positions_[end], positions_[p], positions_[q]);
        change.quality_before = std::min (change.quality_before, before);
        total_area += area;
        if (!vanishes)
          moved_.push_back ({p, q, area, before});
      });
    };
    gather (u, v);
    gather (v, u);
    for (const MovedTriangle& triangle : moved_)
    {
      const Eigen::Vector3d& p = positions_[triangle.p];
      const Eigen::Vector3d& q = positions_[triangle.q];
      const Eigen::Vector3d area = areaVector (x, p, q);
      const Eigen::Vector3d& before = (triangle.quality < thin_quality ? total_area : triangle.area);
      const double after = triangleQuality (area, x, p, q);
      const bool degenerate = triangle.quality == 0.0 && after == 0.0; // a line or a point: there is nothing to flip
      if (!degenerate && !(area.dot (before) > min_turn_cosine_ * area.norm () * before.norm ()))
        change.flips = true;
      change.quality_after = std::min (change.quality_after, after);
    }
    return change;
  }

  TriangleMesh result ()
  {
    mesh_.triangles = surface_.triangles ();
    for (std::size_t v = 0; v < positions_.size (); ++v)
      mesh_.vertices[v] = (positions_[v] + centre_).cast<float> ();
    TriangleMesh result = extractTriangles (mesh_, std::vector<bool> (mesh_.triangles.size (), true));
    if (!result.normals.empty ())
      result.normals = vertexNormals (result);
    return result;
  }

  struct MovedTriangle
  {
    Vertex p, q; ///< the corners that stay
    Eigen::Vector3d area;
    double quality;
  };

  const DecimationOptions options_;
  const double min_turn_cosine_;
  TriangleMesh mesh_; ///< its triangles and vertices are up to date only at the end
  CollapsibleMesh surface_;
  Eigen::Vector3d centre_;
  std::vector<Eigen::Vector3d> positions_; ///< relative to the centre
  std::vector<Quadric> quadrics_;
  std::vector<std::uint32_t> revisions_;
  std::vector<Candidate> heap_;
  std::vector<MovedTriangle> moved_; ///< scratch of shapeChange ()
};

} // namespace

void
DecimationOptions::validate () const
{
  require (max_triangles >= 1, "decimate: largest number of triangles", static_cast<double> (max_triangles),
           "at least 1");
  require (max_normal_turn_deg > 0.0 && max_normal_turn_deg <= 90.0, "decimate: largest turn of a normal",
           max_normal_turn_deg, "positive and at most 90 degrees");
  require (min_quality >= 0.0 && min_quality <= 1.0, "decimate: least quality of a triangle", min_quality,
           "between 0 and 1");
  require (boundary_weight >= 0.0 && boundary_weight <= 1e6, "decimate: weight of the boundary", boundary_weight,
           "between 0 and 1e6");
}

TriangleMesh
decimate (const TriangleMesh& mesh, const DecimationOptions& options)
{
  options.validate ();
  checkMesh (mesh);
  if (mesh.triangles.size () <= options.max_triangles)
    return mesh;
  if (mesh.triangles.size () > CollapsibleMesh::max_triangles)
    throw InvalidArgument ("decimate: the mesh has more triangles than 32 bits can count the corners of");
  for (const auto& triangle : mesh.triangles)
    for (const auto v : triangle)
      if (!mesh.vertices[v].allFinite ())
        throw InvalidArgument ("decimate: vertex " + std::to_string (v) + " is not finite");
  const MeshTopology topology = computeTopology (mesh);
  if (topology.non_manifold_edges > 0 || topology.non_manifold_vertices > 0)
    throw InvalidArgument ("decimate: the mesh has " + std::to_string (topology.non_manifold_edges) +
                           " non-manifold edges and " + std::to_string (topology.non_manifold_vertices) +
                           " non-manifold vertices; it must be a manifold, with or without boundary");
  DecimationOptions wanted = options;
  TriangleMesh fewer = Decimator (mesh, wanted).run ();
  if (!topology.closed_manifold)
    return fewer;
  const double volume_m3 = computeMassProperties (mesh).volume_m3;
  while (computeMassProperties (fewer).volume_m3 / volume_m3 < least_volume_share &&
         fewer.triangles.size () < mesh.triangles.size ())
  {
    wanted.max_triangles = 2 * std::max (wanted.max_triangles, fewer.triangles.size ());
    fewer = wanted.max_triangles < mesh.triangles.size () ? Decimator (mesh, wanted).run () : mesh;
  }
  return fewer;
}

TriangleMesh
decimate (const TriangleMesh& mesh, std::size_t max_triangles)
{
  DecimationOptions options;
  options.max_triangles = max_triangles;
  return decimate (mesh, options);
}

} // namespace pcl::cosection
