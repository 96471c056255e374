// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/physics/body_parts.h"

#include "pcl_cosection/mesh/moved_mesh.h"
#include "pcl_cosection/physics/convex_decomposition.h"
#include "pcl_cosection/physics/object_solid.h"
#include "pcl_cosection/physics/part_contacts.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/volume/mesh_distance.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pcl::cosection {

namespace {

constexpr std::size_t most_avoided = 3000;     // points of the other bodies, for one
constexpr int passes = 3;                      // cutting one pair does not part another
constexpr int grid_along = 64;                 // voxels on which the excess is measured
constexpr std::size_t most_depths = 200000000; // of vertices below faces, for one body
constexpr int points_along = 6;                // of a face on which it is measured, at most

/** \brief The signed distance of a body around it. */
SignedDistanceField
distanceAround (const TriangleMesh& mesh, int threads)
{
  const Eigen::AlignedBox3d box = vertexBox (mesh);
  VoxelGrid grid;
  grid.voxel_size_m = box.sizes ().maxCoeff () / grid_along;
  grid.dims = (box.sizes () / grid.voxel_size_m).array ().ceil ().cast<int> () + 3;
  grid.origin_m = box.center () - 0.5 * grid.voxel_size_m * (grid.dims.cast<double> ().array () - 1.0).matrix ();
  return sampleSignedDistance (mesh, grid, box.diagonal ().norm (), threads);
}

/** \brief Vertices of other bodies in the box of one, but not in the body itself, whose parts cannot avoid these. */
std::vector<Eigen::Vector3d>
pointsOfOthers (const std::vector<CollisionSource>& sources, const std::vector<Eigen::AlignedBox3d>& boxes,
                std::size_t self, int threads)
{
  const Eigen::AlignedBox3d& box = boxes[self];
  std::vector<Eigen::Vector3d> points;
  for (std::size_t other = 0; other < sources.size (); ++other)
    if (other != self && boxes[other].intersects (box))
      for (const Eigen::Vector3f& vertex : sources[other].mesh.vertices)
        if (const Eigen::Vector3d p = vertex.cast<double> (); box.contains (p))
          points.push_back (p);
  if (points.empty ())
    return points;
  const std::size_t step = 1 + points.size () / most_avoided;
  const SignedDistanceField distance = distanceAround (sources[self].mesh, threads);
  std::vector<Eigen::Vector3d> chosen;
  for (std::size_t n = 0; n < points.size (); n += step)
    if (distance.sample (points[n]).value_or (0.0f) > 0.0f)
      chosen.push_back (points[n]);
  return chosen;
}

/** \brief Find out which bodies touch others, and cut what overlaps, each by half, if \a cuts. */
void
cutApart (const std::vector<CollisionSource>& sources, const std::vector<Eigen::AlignedBox3d>& boxes,
          double tolerance_m, bool cuts, std::vector<BodyParts>& bodies)
{
  for (int pass = 0; pass < passes; ++pass)
  {
    bool any = false;
    for (std::size_t a = 0; a < bodies.size (); ++a)
      for (std::size_t b = a + 1; b < bodies.size (); ++b)
      {
        const double reach_m = touching_voxels * std::max (sources[a].voxel_size_m, sources[b].voxel_size_m);
        if (boxes[a].exteriorDistance (boxes[b]) > reach_m)
          continue;
        for (ConvexHull& first : bodies[a].hulls)
          for (ConvexHull& second : bodies[b].hulls)
          {
            const Separation found = separationOf (first, second);
            if (-found.depth_m < reach_m)
              bodies[a].touches_others = bodies[b].touches_others = true;
            if (!cuts || found.depth_m <= tolerance_m)
              continue;
            Eigen::Vector4d plane;
            plane << found.normal, -found.offset;
            ConvexHull rest_of_first = cutBehind (first, plane), rest_of_second = cutBehind (second, -plane);
            if (rest_of_first.empty () || rest_of_second.empty ())
            {
              for (const std::size_t body : {a, b})
                bodies[body].overlap_m = std::max (bodies[body].overlap_m, found.depth_m);
              continue;
            }
            first = std::move (rest_of_first);
            second = std::move (rest_of_second);
            any = true;
          }
      }
    if (!any)
      break;
  }
}

/** \brief The largest distance of the parts' faces from the estimate. */
double
excessOf (const std::vector<ConvexHull>& hulls, const TriangleMesh& estimate, int threads)
{
  const SignedDistanceField field = distanceAround (estimate, threads);
  double excess = 0.0;
  for (const ConvexHull& hull : hulls)
    for (const TriangleMesh::Triangle& t : hull.triangles)
    {
      const Eigen::Vector3d &a = hull.corners[t[0]], &b = hull.corners[t[1]], &c = hull.corners[t[2]];
      const double longest = std::max ({(b - a).norm (), (c - b).norm (), (a - c).norm ()});
      const int steps = std::min (points_along, 1 + static_cast<int> (longest / field.grid.voxel_size_m));
      for (int i = 0; i <= steps; ++i)
        for (int j = 0; j + i <= steps; ++j)
          if (const auto distance = field.sample (a + (i * (b - a) + j * (c - a)) / static_cast<double> (steps)))
            excess = std::max (excess, static_cast<double> (*distance));
    }
  return excess;
}

/** \brief The largest distance of a vertex from the part that it lies in, or is nearest to; of some of the vertices, if
 * there are very many. */
double
missingOf (const std::vector<ConvexHull>& hulls, const TriangleMesh& mesh)
{
  constexpr double rounding_m = 1e-6;
  std::size_t planes = 1;
  for (const ConvexHull& hull : hulls)
    planes += hull.planes.size ();
  const std::size_t step = 1 + mesh.vertices.size () / (1 + most_depths / planes);
  double missing = 0.0;
  for (std::size_t v = 0; v < mesh.vertices.size (); v += step)
  {
    double depth = -std::numeric_limits<double>::infinity ();
    for (const ConvexHull& hull : hulls)
      depth = std::max (depth, hull.depthOf (mesh.vertices[v].cast<double> ()));
    missing = std::max (missing, -depth);
  }
  return missing > rounding_m ? missing : 0.0;
}

} // namespace

std::vector<BodyParts>
divideBodies (const std::vector<CollisionSource>& sources, const PhysicsOptions& options)
{
  std::vector<BodyParts> bodies (sources.size ());
  std::vector<Eigen::AlignedBox3d> boxes; // of the bodies, and so of all their parts
  for (const CollisionSource& source : sources)
    boxes.push_back (vertexBox (source.mesh));
  for (std::size_t n = 0; n < sources.size (); ++n)
  {
    ConvexDecompositionOptions division;
    const bool one = options.collision == CollisionShape::Hull || options.collision == CollisionShape::Mesh;
    division.max_parts = one ? 1 : options.max_parts;
    division.threads = options.threads;
    division.tolerance_m = options.contact_tolerance_m;
    try
    {
      division.avoid = pointsOfOthers (sources, boxes, n, options.threads);
      bodies[n].hulls = decomposeConvex (sources[n].mesh, division);
    }
    catch (const InvalidArgument& error) // it is as good as flat
    {
      throw InvalidArgument (sources[n].name + ": " + error.what ());
    }
  }
  const bool cuts = options.collision == CollisionShape::Parts || options.collision == CollisionShape::Hull;
  cutApart (sources, boxes, options.contact_tolerance_m, cuts, bodies);
  return bodies;
}

void
setParts (const BodyParts& parts, const CollisionSource& source, const PhysicsOptions& options, PhysicalBody& body)
{
  const Eigen::Isometry3d T_body_scene = body.T_scene_body.inverse ();
  body.convex = options.collision != CollisionShape::Mesh;
  if (!body.convex)
  {
    TriangleMesh mesh;
    mesh.vertices = source.mesh.vertices;
    mesh.triangles = source.mesh.triangles;
    body.parts_volume_m3 = computeMassProperties (mesh).volume_m3;
    body.parts = {movedMesh (std::move (mesh), T_body_scene)};
    return;
  }
  for (const ConvexHull& hull : parts.hulls)
  {
    TriangleMesh part = movedMesh (hull.mesh (), T_body_scene);
    if (!isSolid (part))
      continue;
    body.parts_volume_m3 += hull.volume_m3;
    body.parts.push_back (std::move (part));
  }
  body.excess_m = excessOf (parts.hulls, source.estimate, options.threads);
  body.missing_m = missingOf (parts.hulls, source.estimate);
}

} // namespace pcl::cosection
