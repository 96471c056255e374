// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mesh_files.h"
#include "scene_folder.h"
#include "scene_geometry.h"
#include "scene_json.h"
#include "scene_writers.h"
#include "xml_text.h"

#include "pcl_cosection/common/number_text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pcl::cosection {
namespace {

constexpr std::uint64_t contacts_of_scene = 100, contacts_of_body = 80, most_contacts = 2600, rows_of_contact = 3;
constexpr double foot_radius_m = 0.0005;
constexpr int touches_feet = 2; // bit of contype and conaffinity: feet reach beyond their body, and touch what they
                                // stand on alone

std::string
rgbaText (const TriangleMesh::Colour& colour)
{
  return numbersText (displayColour (colour)) + " 1";
}

/** \brief Whether MuJoCo takes a mesh: it refuses flat ones, which have no volume around their centre. */
bool
hasVolume (const TriangleMesh& mesh)
{
  constexpr double least_m3 = 1e-12; // MuJoCo: 1e-15, about a slightly different point
  Eigen::Vector3d centre = Eigen::Vector3d::Zero ();
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    centre += vertex.cast<double> () / static_cast<double> (mesh.vertices.size ());
  double volume = 0.0;
  for (const auto& triangle : mesh.triangles)
  {
    Eigen::Matrix3d corners;
    for (int n = 0; n < 3; ++n)
      corners.col (n) = mesh.vertices[triangle[n]].cast<double> () - centre;
    volume += std::abs (corners.determinant ()) / 6.0;
  }
  return volume > least_m3;
}

void
addSettings (XmlText& xml, const PhysicalScene& scene)
{
  xml.add ("compiler", {{"angle", "radian"}, {"meshdir", mesh_folder}, {"balanceinertia", "true"}});
  xml.open ("option", {{"timestep", "0.002"},
                       {"gravity", numbersText (scene.gravity)},
                       {"cone", "elliptic"},
                       {"impratio", "10"},
                       {"noslip_iterations", "5"}});
  xml.add ("flag", {{"multiccd", "enable"}});
  xml.close ();
  // MuJoCo reserves memory for 100 contacts and 500 constraints, and resets what needs more. It needs the square of
  // them.
  const std::size_t bodies = std::count_if (scene.bodies.begin (), scene.bodies.end (),
                                            [] (const PhysicalBody& body) { return !body.isStatic (); });
  const std::uint64_t contacts = std::min<std::uint64_t> (contacts_of_scene + contacts_of_body * bodies, most_contacts);
  xml.add ("size", {{"nconmax", numberText (contacts)}, {"njmax", numberText (rows_of_contact * contacts)}});
  xml.open ("default");
  xml.add ("geom", {{"solref", "0.005 1"}});
  xml.open ("default", {{"class", "visual"}});
  xml.add ("geom", {{"type", "mesh"}, {"contype", "0"}, {"conaffinity", "0"}, {"group", "2"}});
  xml.close ();
  xml.open ("default", {{"class", "collision"}});
  xml.add ("geom", {{"type", "mesh"}, {"group", "3"}});
  xml.close ();
  xml.open ("default", {{"class", "foot"}});
  xml.add ("geom", {{"type", "sphere"},
                    {"size", numberText (foot_radius_m)},
                    {"contype", "0"},
                    {"conaffinity", numberText (touches_feet)},
                    {"group", "3"}});
  xml.close ();
  xml.close ();
}

void
addAssets (XmlText& xml, const PhysicalScene& scene)
{
  const auto add_mesh = [&] (const std::string& name) { xml.add ("mesh", {{"name", name}, {"file", name + ".obj"}}); };
  xml.open ("asset");
  for (const PhysicalBody& body : scene.bodies)
  {
    if (hasVolume (body.visual))
      add_mesh (body.name);
    for (std::size_t k = 0; k < body.parts.size (); ++k)
      if (hasVolume (body.parts[k]))
        add_mesh (partName (body, k));
  }
  xml.close ();
}

void
addPlane (XmlText& xml, const PhysicalPlane& plane, bool carries)
{
  constexpr double grid_m = 0.1; // distance of the lines of a plane that is drawn
  const Eigen::Isometry3d& pose = plane.T_scene_plane;
  const Eigen::Vector3d half = 0.5 * boxSize (plane);
  const Eigen::Vector3d place = plane.endless ? Eigen::Vector3d (pose.translation ()) : pose * boxCentre (plane);
  xml.add ("geom", {{"name", plane.name},
                    {"type", plane.endless ? "plane" : "box"},
                    {"pos", numbersText (place)},
                    {"quat", numbersText (scalarFirst (rotationOf (pose)))},
                    {"size", numbersText (plane.endless ? Eigen::Vector3d (half.x (), half.y (), grid_m) : half)},
                    {"contype", numberText (carries ? 1 | touches_feet : 1)},
                    {"rgba", rgbaText (plane_colour)}});
}

void
addBody (XmlText& xml, const PhysicalScene& scene, const PhysicalBody& body)
{
  xml.open ("body", {{"name", body.name},
                     {"pos", numbersText (body.T_scene_body.translation ())},
                     {"quat", numbersText (scalarFirst (rotationOf (body.T_scene_body)))}});
  if (!body.isStatic ())
  {
    const Eigen::Matrix3d& m = body.inertia;
    Eigen::Matrix<double, 6, 1> inertia;
    inertia << m (0, 0), m (1, 1), m (2, 2), m (0, 1), m (0, 2), m (1, 2);
    xml.add ("freejoint", {{"name", body.name}});
    xml.add ("inertial", {{"pos", numbersText (body.centre_m)},
                          {"mass", numberText (body.mass_kg)},
                          {"fullinertia", numbersText (inertia)}});
  }
  if (hasVolume (body.visual))
    xml.add ("geom", {{"class", "visual"}, {"mesh", body.name}, {"rgba", rgbaText (body.colour)}});
  if (!body.convex)
    xml.addComment ("MuJoCo takes the convex hull of each part, which is larger than the part");
  for (std::size_t k = 0; k < body.parts.size (); ++k)
    if (hasVolume (body.parts[k]))
      xml.add ("geom", {{"class", "collision"},
                        {"name", partName (body, k)},
                        {"mesh", partName (body, k)},
                        {"rgba", rgbaText (body.colour)}});
  // Between a plane and a convex mesh MuJoCo finds a few contacts side by side, on which a body rocks and turns.
  for (const Eigen::Vector3d& foot : body.feet)
  {
    const Eigen::Vector3d up = scene.planes[body.stands_on].T_scene_plane.linear ().col (2);
    const Eigen::Vector3d centre = foot + foot_radius_m * (body.T_scene_body.linear ().transpose () * up);
    xml.add ("geom", {{"class", "foot"}, {"pos", numbersText (centre)}, {"rgba", rgbaText (body.colour)}});
  }
  xml.close ();
}

std::string
modelText (const PhysicalScene& scene)
{
  XmlText xml;
  xml.open ("mujoco", {{"model", scene.name}});
  addSettings (xml, scene);
  addAssets (xml, scene);
  xml.open ("worldbody");
  xml.add ("light", {{"directional", "true"}, {"pos", "0 0 3"}, {"dir", "-0.5 0.1 -0.9"}});
  for (std::size_t n = 0; n < scene.planes.size (); ++n)
    addPlane (xml, scene.planes[n],
              std::any_of (scene.bodies.begin (), scene.bodies.end (),
                           [&] (const PhysicalBody& body) { return body.stands_on == static_cast<int> (n); }));
  for (const PhysicalBody& body : scene.bodies)
    addBody (xml, scene, body);
  xml.close ();
  xml.close ();
  return xml.text ();
}

} // namespace

std::vector<std::string>
writeMjcf (const PhysicalScene& scene, const std::string& folder)
{
  SceneFolder files (folder);
  writeMeshFiles (scene, files);
  addSceneJson (scene, files);
  files.write ("scene.xml", modelText (scene));
  return files.finish ();
}

} // namespace pcl::cosection
