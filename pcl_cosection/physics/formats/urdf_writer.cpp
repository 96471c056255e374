// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mesh_files.h"
#include "scene_folder.h"
#include "scene_geometry.h"
#include "scene_json.h"
#include "scene_writers.h"
#include "xml_text.h"

#include "pcl_cosection/common/number_text.h"

namespace pcl::cosection {
namespace {

void
addOrigin (XmlText& xml, const Eigen::Vector3d& position)
{
  xml.add ("origin", {{"xyz", numbersText (position)}, {"rpy", "0 0 0"}});
}

void
addInertial (XmlText& xml, double mass_kg, const Eigen::Vector3d& centre, const Eigen::Matrix3d& inertia)
{
  xml.open ("inertial");
  addOrigin (xml, centre);
  xml.add ("mass", {{"value", numberText (mass_kg)}});
  xml.add ("inertia", {{"ixx", numberText (inertia (0, 0))},
                       {"ixy", numberText (inertia (0, 1))},
                       {"ixz", numberText (inertia (0, 2))},
                       {"iyy", numberText (inertia (1, 1))},
                       {"iyz", numberText (inertia (1, 2))},
                       {"izz", numberText (inertia (2, 2))}});
  xml.close ();
}

/** \brief Gazebo and Bullet know that the link world does not move. */
void
fixToWorld (XmlText& xml, const std::string& link)
{
  xml.addComment ("does not move");
  xml.add ("link", {{"name", "world"}});
  xml.open ("joint", {{"name", link + "_fixed"}, {"type", "fixed"}});
  xml.add ("parent", {{"link", "world"}});
  xml.add ("child", {{"link", link}});
  xml.close ();
}

/** \brief Gazebo leaves out links without a mass, and Bullet warns of them: a kilogram that is never used. */
void
addUnusedInertial (XmlText& xml)
{
  addInertial (xml, 1.0, Eigen::Vector3d::Zero (), Eigen::Matrix3d::Identity ());
}

void
addMaterial (XmlText& xml, const std::string& name, const TriangleMesh::Colour& colour)
{
  xml.open ("material", {{"name", name + "_colour"}});
  xml.add ("color", {{"rgba", numbersText (displayColour (colour)) + " 1"}});
  xml.close ();
}

void
addMesh (XmlText& xml, const std::string& mesh_name)
{
  addOrigin (xml, Eigen::Vector3d::Zero ());
  xml.open ("geometry");
  xml.add ("mesh", {{"filename", meshFile (mesh_name)}});
  xml.close ();
}

std::string
bodyText (const PhysicalBody& body)
{
  XmlText xml;
  xml.open ("robot", {{"name", body.name}});
  if (body.isStatic ())
    fixToWorld (xml, body.name);
  xml.open ("link", {{"name", body.name}});
  if (body.isStatic ())
    addUnusedInertial (xml);
  else
    addInertial (xml, body.mass_kg, body.centre_m, body.inertia);
  if (!body.visual.empty ())
  {
    xml.open ("visual");
    addMesh (xml, body.name);
    addMaterial (xml, body.name, body.colour);
    xml.close ();
  }
  for (std::size_t k = 0; k < body.parts.size (); ++k)
  {
    // Bullet takes hulls of meshes, but of static ones that ask for their triangles.
    const bool triangles = body.isStatic () && !body.convex;
    xml.open ("collision", triangles ? XmlText::Attributes{{"concave", "yes"}} : XmlText::Attributes{});
    addMesh (xml, partName (body, k));
    xml.close ();
  }
  xml.close ();
  xml.close ();
  return xml.text ();
}

std::string
planeText (const PhysicalPlane& plane)
{
  XmlText xml;
  xml.open ("robot", {{"name", plane.name}});
  fixToWorld (xml, plane.name);
  xml.open ("link", {{"name", plane.name}});
  addUnusedInertial (xml);
  for (const bool visual : {true, false})
  {
    xml.open (visual ? "visual" : "collision");
    addOrigin (xml, boxCentre (plane));
    xml.open ("geometry");
    xml.add ("box", {{"size", numbersText (boxSize (plane))}});
    xml.close ();
    if (visual)
      addMaterial (xml, plane.name, plane_colour);
    xml.close ();
  }
  xml.close ();
  xml.close ();
  return xml.text ();
}

} // namespace

std::vector<std::string>
writeUrdf (const PhysicalScene& scene, const std::string& folder)
{
  SceneFolder files (folder);
  writeMeshFiles (scene, files);
  for (const PhysicalPlane& plane : scene.planes)
    files.write (plane.name + ".urdf", planeText (plane));
  for (const PhysicalBody& body : scene.bodies)
    files.write (body.name + ".urdf", bodyText (body));
  addSceneJson (scene, files);
  return files.finish ();
}

} // namespace pcl::cosection
