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

/** \brief Format 1.9 has poses of quaternions. */
void
addPose (XmlText& xml, const Eigen::Isometry3d& pose)
{
  xml.add ("pose", numbersText (pose.translation ()) + " " + numbersText (rotationOf (pose).coeffs ()),
           {{"rotation_format", "quat_xyzw"}});
}

void
addMaterial (XmlText& xml, const TriangleMesh::Colour& colour)
{
  const std::string rgba = numbersText (displayColour (colour)) + " 1";
  xml.open ("material");
  xml.add ("ambient", rgba);
  xml.add ("diffuse", rgba);
  xml.close ();
}

void
addMesh (XmlText& xml, const std::string& mesh_name)
{
  xml.open ("geometry");
  xml.open ("mesh");
  xml.add ("uri", meshFile (mesh_name));
  xml.close ();
  xml.close ();
}

void
addInertial (XmlText& xml, const PhysicalBody& body)
{
  xml.open ("inertial");
  addPose (xml, Eigen::Isometry3d (Eigen::Translation3d (body.centre_m)));
  xml.add ("mass", numberText (body.mass_kg));
  xml.open ("inertia");
  xml.add ("ixx", numberText (body.inertia (0, 0)));
  xml.add ("ixy", numberText (body.inertia (0, 1)));
  xml.add ("ixz", numberText (body.inertia (0, 2)));
  xml.add ("iyy", numberText (body.inertia (1, 1)));
  xml.add ("iyz", numberText (body.inertia (1, 2)));
  xml.add ("izz", numberText (body.inertia (2, 2)));
  xml.close ();
  xml.close ();
}

void
openModel (XmlText& xml, const std::string& name, const Eigen::Isometry3d& pose, bool is_static)
{
  xml.open ("model", {{"name", name}});
  addPose (xml, pose);
  xml.add ("static", std::string (is_static ? "true" : "false"));
  xml.open ("link", {{"name", "link"}});
}

void
closeModel (XmlText& xml)
{
  xml.close ();
  xml.close ();
}

void
addBody (XmlText& xml, const PhysicalBody& body)
{
  openModel (xml, body.name, body.T_scene_body, body.isStatic ());
  if (!body.isStatic ())
    addInertial (xml, body);
  if (!body.visual.empty ())
  {
    xml.open ("visual", {{"name", "visual"}});
    addMesh (xml, body.name);
    addMaterial (xml, body.colour);
    xml.close ();
  }
  for (std::size_t k = 0; k < body.parts.size (); ++k)
  {
    xml.open ("collision", {{"name", "part_" + std::to_string (k)}});
    addMesh (xml, partName (body, k));
    xml.close ();
  }
  closeModel (xml);
}

void
addPlaneShape (XmlText& xml, const PhysicalPlane& plane)
{
  if (!plane.endless)
    addPose (xml, Eigen::Isometry3d (Eigen::Translation3d (boxCentre (plane))));
  xml.open ("geometry");
  if (plane.endless)
  {
    xml.open ("plane");
    xml.add ("normal", std::string ("0 0 1"));
    xml.add ("size", numbersText (Eigen::Vector2d (2.0 * plane.half_size_m)));
  }
  else
  {
    xml.open ("box");
    xml.add ("size", numbersText (boxSize (plane)));
  }
  xml.close ();
  xml.close ();
}

void
addPlane (XmlText& xml, const PhysicalPlane& plane)
{
  openModel (xml, plane.name, plane.T_scene_plane, true);
  xml.open ("visual", {{"name", "visual"}});
  addPlaneShape (xml, plane);
  addMaterial (xml, plane_colour);
  xml.close ();
  xml.open ("collision", {{"name", "collision"}});
  addPlaneShape (xml, plane);
  xml.close ();
  closeModel (xml);
}

std::string
worldText (const PhysicalScene& scene)
{
  XmlText xml;
  xml.open ("sdf", {{"version", "1.9"}});
  xml.open ("world", {{"name", scene.name}});
  xml.open ("physics", {{"name", "one_millisecond"}, {"type", "ode"}}); // newer Gazebos choose another engine
  xml.add ("max_step_size", std::string ("0.001"));
  xml.add ("real_time_factor", std::string ("1"));
  xml.close ();
  xml.add ("gravity", numbersText (scene.gravity));
  xml.open ("light", {{"name", "sun"}, {"type", "directional"}});
  xml.add ("pose", std::string ("0 0 10 0 0 0"));
  xml.add ("cast_shadows", std::string ("true"));
  xml.add ("diffuse", std::string ("0.8 0.8 0.8 1"));
  xml.add ("direction", std::string ("-0.5 0.1 -0.9"));
  xml.close ();
  for (const PhysicalPlane& plane : scene.planes)
    addPlane (xml, plane);
  for (const PhysicalBody& body : scene.bodies)
    addBody (xml, body);
  xml.close ();
  xml.close ();
  return xml.text ();
}

} // namespace

std::vector<std::string>
writeSdf (const PhysicalScene& scene, const std::string& folder)
{
  SceneFolder files (folder);
  writeMeshFiles (scene, files);
  addSceneJson (scene, files);
  files.write ("scene.sdf", worldText (scene));
  return files.finish ();
}

} // namespace pcl::cosection
