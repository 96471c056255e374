// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/physics/scene_builder.h"

#include "pcl_cosection/common/convex_hull.h"
#include "pcl_cosection/mesh/moved_mesh.h"
#include "pcl_cosection/physics/background_parts.h"
#include "pcl_cosection/physics/body_parts.h"
#include "pcl_cosection/physics/object_solid.h"
#include "pcl_cosection/physics/resting.h"
#include "pcl_cosection/physics/scene_frame.h"
#include "pcl_cosection/physics/visual_mesh.h"

#include <pcl/cosection/common/error.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

namespace pcl::cosection {

namespace {

constexpr double flat_tolerance_m = 1e-5;    // of what lies on a plane, for rounding
constexpr double noticeable_shift_m = 0.001; // of a centre of mass
constexpr double lower_half = 0.5;
constexpr double highest_gap = 0.5; // below a body that is taken for one that stands, of its height
constexpr std::size_t longest_label = 100;
constexpr double least_inertia = 1e-15; // kg m^2, and kg of a mass: what MuJoCo takes for zero
constexpr double most_mass_kg = 1e30;   // formats have single precision
constexpr double flat_share = 0.25;     // of a body's height, which is made flat at most

/** \brief Letters, digits and underscores, and unlike all others. Files have it, whose names are short. */
std::string
uniqueName (const std::string& text, std::set<std::string>& used)
{
  std::string plain = text;
  for (char& c : plain)
    if (std::isalnum (static_cast<unsigned char> (c)) == 0)
      c = '_';
  if (std::isdigit (static_cast<unsigned char> (plain[0])) != 0)
    plain = "object_" + plain;
  const std::string part = "_part_"; // and a number: how files call the parts of bodies
  if (const std::size_t end = plain.find_last_not_of ("0123456789") + 1;
      end >= part.size () && end < plain.size () && plain.compare (end - part.size (), part.size (), part) == 0)
    plain += "_object";
  std::string name = plain;
  for (int n = 2; !used.insert (name).second; ++n)
    name = plain + "_" + std::to_string (n);
  return name;
}

std::string
planeName (std::size_t number)
{
  return "support_" + std::to_string (number + 1);
}

/** \brief A plane as a body, as large as what is near it; one on which things stand is as large as all of them. */
PhysicalPlane
planeBody (const Eigen::Vector4d& plane, const CompletedScene& scene, const PhysicalScene& result, std::size_t number)
{
  PhysicalPlane body;
  body.name = planeName (number);
  const Eigen::Vector3d normal = plane.head<3> ();
  body.T_scene_plane.linear () = Eigen::Quaterniond::FromTwoVectors (Eigen::Vector3d::UnitZ (), normal)
                                     .toRotationMatrix ();
  body.T_scene_plane.translation () = -plane[3] * normal;
  const Eigen::Isometry3d T_plane_scene = body.T_scene_plane.inverse ();
  const Eigen::Isometry3d T_plane_world = T_plane_scene * result.T_result_scene.inverse ();
  Eigen::AlignedBox2d extent;
  const double voxel = largestVoxelSizeOf (scene);
  double deepest = 0.0;
  for (std::size_t n = 0; n < scene.objects.size (); ++n)
  {
    const PhysicalBody& object = result.bodies[n];
    Eigen::AlignedBox3d box; // along the plane
    for (const Eigen::Vector3f& vertex : object.visual.vertices)
      box.extend (T_plane_scene * (object.T_scene_body * vertex.cast<double> ()));
    deepest = std::min (deepest, box.min ().z ());
    if (isLevel (plane, -result.gravity.normalized ()) || std::abs (box.min ().z ()) < touching_voxels * voxel)
      extent.extend (Eigen::AlignedBox2d (box.min ().head<2> (), box.max ().head<2> ()));
  }
  const Eigen::AlignedBox2d objects = extent;
  for (const Eigen::Vector3f& vertex : scene.background.vertices)
    if (const Eigen::Vector3d p = T_plane_world * vertex.cast<double> (); std::abs (p.z ()) < touching_voxels * voxel)
      extent.extend (Eigen::Vector2d (p.head<2> ()));
  if (scene.background.vertices.empty () && !objects.isEmpty ())
    extent = {objects.min () - objects.sizes (), objects.max () + objects.sizes ()};
  if (extent.isEmpty ()) // neither an object nor background is near it
    extent = Eigen::AlignedBox2d (Eigen::Vector2d::Constant (-voxel), Eigen::Vector2d::Constant (voxel));
  body.endless = deepest > -touching_voxels * voxel;
  body.half_size_m = 0.5 * extent.sizes ();
  body.T_scene_plane.translation () += body.T_scene_plane.linear () *
                                       Eigen::Vector3d (extent.center ().x (), extent.center ().y (), 0.0);
  return body;
}

/** \brief The plane that an object stands on: the one nearest to its lowest point, if that is near. */
int
planeBelow (const TriangleMesh& mesh, const std::vector<Eigen::Vector4d>& planes, const Eigen::Vector3d& up,
            double reach_m)
{
  int nearest = -1;
  for (std::size_t n = 0; n < planes.size (); ++n)
    if (const double gap = std::abs (lowestOver (planes[n], mesh)); isLevel (planes[n], up) && gap < reach_m)
    {
      nearest = static_cast<int> (n);
      reach_m = gap;
    }
  return nearest;
}

std::vector<Eigen::Vector3d>
cornersOf (const std::vector<ConvexHull>& hulls)
{
  std::vector<Eigen::Vector3d> corners;
  for (const ConvexHull& hull : hulls)
    corners.insert (corners.end (), hull.corners.begin (), hull.corners.end ());
  return corners;
}

/** \brief Move the centre of mass of what stands alone over what it stands on. */
void
makeStand (PhysicalBody& body, const BodyParts& parts, const Eigen::Vector4d& plane, bool may_lean,
           std::vector<std::string>& warnings)
{
  const Stance stance = stanceOf (cornersOf (parts.hulls), plane, body.T_scene_body * body.centre_m, flat_tolerance_m);
  for (const Eigen::Vector3d& foot : stance.feet)
    body.feet.push_back (body.T_scene_body.inverse () * foot);
  if (!stance.stands && !may_lean)
    warnings.push_back (body.name + ": will fall over: its centre of mass is not over what it stands on");
  if (!stance.stands || may_lean || stance.shift_m == 0.0)
    return;
  body.centre_m = body.T_scene_body.inverse () * stance.centre;
  body.centre_shift_m = stance.shift_m;
  if (stance.shift_m < noticeable_shift_m)
    return;
  std::ostringstream text;
  text.precision (2);
  text << body.name << ": its centre of mass was moved by " << 1000.0 * stance.shift_m << " mm, over what it stands on";
  warnings.push_back (text.str ());
}

PhysicalBody
bodyOf (const CompletedObject& object, const PhysicsOptions& options, const Eigen::Isometry3d& T_scene_world,
        std::set<std::string>& names)
{
  PhysicalBody body;
  body.id = object.id;
  const std::string label = object.label.empty () ? "object" : object.label.substr (0, longest_label);
  body.name = uniqueName (label + "_" + std::to_string (object.id), names);
  const MassProperties mass = solidOf (object, object.mesh);
  const Eigen::Isometry3d T_scene_object = T_scene_world * object.T_world_object;
  body.T_scene_body.translation () = T_scene_object * mass.centroid_m;
  body.visual = movedMesh (object.mesh, body.T_scene_body.inverse () * T_scene_object);
  body.colour = meanColour (object.mesh, body.colour);
  const auto given = options.masses_kg.find (object.id);
  body.volume_m3 = mass.volume_m3;
  body.mass_kg = given == options.masses_kg.end () ? options.density_kg_m3 * mass.volume_m3 : given->second;
  const Eigen::Matrix3d& R = T_scene_object.linear ();
  body.inertia = body.mass_kg / mass.volume_m3 * (R * mass.inertia * R.transpose ());
  return body;
}

/** \brief What an object's parts are made of. \throws InvalidArgument if there is no outer bound where one is needed */
CollisionSource
sourceOf (const CompletedObject& object, const PhysicsOptions& options, const Eigen::Isometry3d& T_scene_world)
{
  const bool outer = options.collision == CollisionShape::Outer;
  if (outer && object.outer.empty ())
    throw InvalidArgument ("object " + std::to_string (object.id) +
                           ": has no outer bound; let pcl_cosection write it (--save-bounds)");
  if (outer)
    solidOf (object, object.outer);
  CollisionSource source;
  source.mesh.vertices = outer ? object.outer.vertices : object.mesh.vertices;
  source.mesh.triangles = outer ? object.outer.triangles : object.mesh.triangles;
  source.mesh = movedMesh (std::move (source.mesh), T_scene_world * object.T_world_object);
  source.estimate = outer ? movedMesh (object.mesh, T_scene_world * object.T_world_object) : source.mesh;
  source.name = "object " + std::to_string (object.id);
  source.voxel_size_m = voxelSizeOf (object);
  return source;
}

/** \brief Whether something of another body is below the middle of one, within its outline as seen from above. */
bool
isOverOther (const std::vector<CollisionSource>& sources, std::size_t self, const Eigen::Vector3d& up)
{
  const Eigen::Quaterniond vertical = Eigen::Quaterniond::FromTwoVectors (up, Eigen::Vector3d::UnitZ ());
  std::vector<Eigen::Vector2d> points;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : sources[self].mesh.vertices)
  {
    const Eigen::Vector3d p = vertical * vertex.cast<double> ();
    box.extend (p);
    points.emplace_back (p.head<2> ());
  }
  const std::vector<Eigen::Vector2d> outline = convexHull (points);
  for (std::size_t other = 0; other < sources.size (); ++other)
    if (other != self)
      for (const Eigen::Vector3f& vertex : sources[other].mesh.vertices)
        if (const Eigen::Vector3d p = vertical * vertex.cast<double> ();
            p.z () < box.center ().z () && isInside (outline, Eigen::Vector2d (p.head<2> ())))
          return true;
  return false;
}

double
heightAlong (const Eigen::Vector3d& up, const TriangleMesh& mesh)
{
  const Eigen::Vector4d ground (up.x (), up.y (), up.z (), 0.0);
  return -lowestOver (-ground, mesh) - lowestOver (ground, mesh);
}

/** \brief Find what each body stands on, and make its bottom flat there. It ends at walls that it touches. What
 * touches nothing, and is no higher over a plane than half its height, was seen at rest, and its bottom was not seen:
 * the outline of its lower half reaches down to the plane. */
void
standOnPlanes (const std::vector<Eigen::Vector4d>& planes, const Eigen::Vector3d& up,
               std::vector<CollisionSource>& sources, PhysicalScene& result)
{
  for (std::size_t n = 0; n < sources.size (); ++n)
  {
    CollisionSource& source = sources[n];
    PhysicalBody& body = result.bodies[n];
    const double reach_m = touching_voxels * source.voxel_size_m;
    for (const Eigen::Vector4d& plane : planes)
      if (!isLevel (plane, up) && lowestOver (plane, source.mesh) > -reach_m &&
          -lowestOver (-plane, source.mesh) > reach_m)
        source.mesh = flattenedOn (plane, std::move (source.mesh), 0.0);
    body.stands_on = planeBelow (source.mesh, planes, up, reach_m);
    if (body.stands_on < 0 && !isOverOther (sources, n, up))
      body.stands_on = planeBelow (source.mesh, planes, up, highest_gap * heightAlong (up, source.mesh));
    if (body.stands_on < 0)
      continue;
    const Eigen::Vector4d& plane = planes[body.stands_on];
    const double gap = std::max (0.0, lowestOver (plane, source.mesh));
    const double height = heightAlong (plane.head<3> (), source.mesh);
    if (!(-lowestOver (-plane, source.mesh) > gap)) // it is below the plane
    {
      body.stands_on = -1;
      continue;
    }
    source.extended = gap >= touching_voxels * source.voxel_size_m;
    const double band = source.extended ? lower_half * height : std::min (source.voxel_size_m, flat_share * height);
    source.mesh = flattenedOn (plane, std::move (source.mesh), gap + band);
    if (!source.extended)
      continue;
    std::ostringstream text;
    text.precision (2);
    text << body.name << ": ends " << 1000.0 * gap << " mm above what it must stand on; its parts reach down to that";
    result.warnings.push_back (text.str ());
  }
}

/** \brief What a simulation of a body would show, and its line in a report does not say. */
void
warnOf (const PhysicalBody& body, const BodyParts& parts, bool touches, bool has_planes,
        std::vector<std::string>& warnings)
{
  constexpr double least_share = 0.75, smallest_m = 0.001, largest_m = 50.0;
  if (has_planes && body.stands_on < 0 && !touches)
    warnings.push_back (body.name +
                        ": will not stay: it stands on no support plane, and beside no other object or background");
  if (const double share = body.parts_volume_m3 / body.volume_m3; share < least_share)
    warnings.push_back (body.name + ": its parts have only " + std::to_string (std::lround (100.0 * share)) +
                        " % of its volume, as other objects are in its place, or planes");
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : body.visual.vertices)
    box.extend (vertex);
  if (parts.overlap_m > 0.0)
  {
    std::ostringstream text;
    text.precision (2);
    text << body.name << ": is within a part of another object, or holds one in a part, by " << 1000.0 * parts.overlap_m
         << " mm, which simulators push apart; more parts (--max-parts) may keep clear of it";
    warnings.push_back (text.str ());
  }
  const double size_m = box.sizes ().cast<double> ().norm ();
  std::ostringstream size;
  size.precision (2);
  size << size_m << " m";
  if (size_m < smallest_m || size_m > largest_m)
    warnings.push_back (body.name + ": is " + size.str () +
                        " large, which simulators may refuse; lengths must be in metres");
  const Eigen::Vector3d moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> (body.inertia).eigenvalues ();
  if (body.mass_kg < least_inertia || moments.minCoeff () < least_inertia || body.mass_kg > most_mass_kg)
  {
    std::ostringstream mass;
    mass.precision (2);
    mass << body.mass_kg << " kg";
    warnings.push_back (body.name + ": has a mass of " + mass.str () + ", which simulators refuse; is it right?");
  }
}

} // namespace

void
PhysicsOptions::validate () const
{
  if (!(density_kg_m3 > 0.0) || !std::isfinite (density_kg_m3))
    throw InvalidArgument ("the density must be a number of kg/m^3 greater than 0");
  for (const auto& [id, mass] : masses_kg)
    if (!(mass > 0.0) || !std::isfinite (mass))
      throw InvalidArgument ("the mass of object " + std::to_string (id) + " must be a number of kg greater than 0");
  if (max_parts < 1)
    throw InvalidArgument ("there must be at least one part for each object");
  if (!(contact_tolerance_m >= 0.0))
    throw InvalidArgument ("the contact tolerance must not be less than 0");
}

PhysicalScene
buildPhysicalScene (const CompletedScene& scene, const PhysicsOptions& options)
{
  options.validate ();
  if (scene.objects.empty ())
    throw InvalidArgument ("there are no objects");
  PhysicalScene result;
  result.contact_tolerance_m = options.contact_tolerance_m;
  const FrameOfScene frame = frameOfScene (scene, options.frame);
  result.T_result_scene = frame.T_world_scene;
  result.gravity = -standard_gravity * frame.up;
  const Eigen::Isometry3d T_scene_world = frame.T_world_scene.inverse ();
  std::set<std::string> names;
  for (std::size_t n = 0; n < scene.planes.size (); ++n)
    names.insert (planeName (n));
  names.insert (background_name);
  for (const CompletedObject& object : scene.objects)
    result.bodies.push_back (bodyOf (object, options, T_scene_world, names));
  std::vector<Eigen::Vector4d> planes;
  for (const Eigen::Vector4d& plane : scene.planes)
  {
    const Eigen::Vector3d n = T_scene_world.linear () * plane.head<3> ();
    planes.emplace_back (n.x (), n.y (), n.z (), plane[3] - n.dot (T_scene_world.translation ()));
  }
  for (std::size_t n = 0; n < planes.size (); ++n)
    result.planes.push_back (planeBody (planes[n], scene, result, n));
  if (planes.empty ())
    result.warnings.emplace_back ("there is no support plane: objects will fall; give one to pcl_cosection (--plane)");

  std::vector<CollisionSource> sources;
  for (const CompletedObject& object : scene.objects)
    sources.push_back (sourceOf (object, options, T_scene_world));
  standOnPlanes (planes, frame.up, sources, result);
  const std::vector<BodyParts> parts = divideBodies (sources, options);
  const std::vector<Eigen::Vector3d> background = backgroundBesidePlanes (scene, result, planes);
  for (std::size_t n = 0; n < sources.size (); ++n)
  {
    PhysicalBody& body = result.bodies[n];
    const bool touches = parts[n].touches_others || touchesSurroundings (sources[n], planes, frame.up, background);
    if (body.stands_on >= 0)
      makeStand (body, parts[n], planes[body.stands_on], touches && !sources[n].extended, result.warnings);
    setParts (parts[n], sources[n], options, body);
    warnOf (body, parts[n], touches, !planes.empty (), result.warnings);
  }
  addBackground (scene, planes, parts, result);
  return result;
}

} // namespace pcl::cosection
