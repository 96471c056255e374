// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_folder.h"
#include "scene_geometry.h"
#include "scene_json.h"
#include "scene_writers.h"

#include "pcl_cosection/common/number_text.h"

#include <Eigen/Eigenvalues>

namespace pcl::cosection {
namespace {

/** \brief Builds the text of a stage, laid out as USD itself does: some readers go by lines. */
class UsdText
{
public:
  /** \brief Begin a prim; \a schemas are the API schemas applied to it, as '"A", "B"'. */
  void open (const std::string& type, const std::string& name, const std::string& schemas = {})
  {
    const std::string head = "def " + type + " \"" + name + '"';
    if (schemas.empty ())
      addLine (head);
    else
      addWithMetadata (head, "prepend apiSchemas = [" + schemas + "]");
    addLine ("{");
    ++depth_;
  }
  void close ()
  {
    --depth_;
    addLine ("}");
  }
  /** \brief A property, as 'float radius', and its value. */
  void add (const std::string& property, const std::string& value) { addLine (property + " = " + value); }
  /** \brief An array that has a value for each vertex, or one for all. */
  void addArray (const std::string& property, const std::string& values, const std::string& interpolation)
  {
    addWithMetadata (property + " = " + values, "interpolation = \"" + interpolation + '"');
  }

  const std::string& text () const { return text_; }

private:
  void addLine (const std::string& line)
  {
    text_.append (4 * depth_, ' ');
    text_ += line;
    text_ += '\n';
  }
  void addWithMetadata (const std::string& line, const std::string& metadata)
  {
    addLine (line + " (");
    ++depth_;
    addLine (metadata);
    --depth_;
    addLine (")");
  }

  std::string text_ = "#usda 1.0\n(\n    defaultPrim = \"World\"\n    kilogramsPerUnit = 1\n    metersPerUnit = 1\n"
                      "    upAxis = \"Z\"\n)\n\n";
  std::size_t depth_ = 0;
};

template <typename Vector>
std::string
tupleText (const Vector& values)
{
  return "(" + numbersText (values, ", ") + ")";
}

/** \brief [a, b, ...], each element as \a append (text, element) writes it. */
template <typename Element, typename Append>
std::string
arrayText (const std::vector<Element>& elements, Append&& append)
{
  std::string text = "[";
  for (const Element& element : elements)
  {
    append (text, element);
    text += ", ";
  }
  if (!elements.empty ())
    text.resize (text.size () - 2);
  return text + "]";
}

void
appendTuple (std::string& text, const Eigen::Vector3f& values)
{
  text += '(';
  appendNumbers (text, values, ", ");
  text += ')';
}

/** \brief Names of prims do not begin with a digit. */
std::string
primName (const std::string& name)
{
  return name.empty () || (name[0] >= '0' && name[0] <= '9') ? "_" + name : name;
}

void
addPose (UsdText& usd, const Eigen::Isometry3d& pose)
{
  usd.add ("double3 xformOp:translate", tupleText (Eigen::Vector3d (pose.translation ())));
  usd.add ("quatd xformOp:orient", tupleText (scalarFirst (rotationOf (pose))));
}

void
addMesh (UsdText& usd, const TriangleMesh& mesh, const TriangleMesh::Colour& colour)
{
  const Eigen::AlignedBox3f bounds = boundsOf (mesh);
  usd.add ("uniform token subdivisionScheme", "\"none\"");
  usd.add ("uniform bool doubleSided", "1"); // static surfaces may be open
  usd.add ("float3[] extent", "[" + tupleText (bounds.min ()) + ", " + tupleText (bounds.max ()) + "]");
  usd.add ("int[] faceVertexCounts",
           arrayText (mesh.triangles, [] (std::string& text, const TriangleMesh::Triangle&) { text += '3'; }));
  usd.add ("int[] faceVertexIndices",
           arrayText (mesh.triangles, [] (std::string& text, const TriangleMesh::Triangle& triangle) {
             appendNumbers (text, Eigen::Map<const Eigen::Matrix<std::uint32_t, 3, 1>> (triangle.data ()), ", ");
           }));
  usd.add ("point3f[] points", arrayText (mesh.vertices, appendTuple));
  if (!mesh.normals.empty ())
    usd.addArray ("normal3f[] normals", arrayText (mesh.normals, appendTuple), "vertex");
  const std::vector<TriangleMesh::Colour> colours = mesh.colours.empty () ? std::vector<TriangleMesh::Colour>{colour}
                                                                          : mesh.colours;
  const auto append_colour = [] (std::string& text, const TriangleMesh::Colour& c) {
    appendTuple (text, linearColour (c));
  };
  usd.addArray ("color3f[] primvars:displayColor", arrayText (colours, append_colour),
                mesh.colours.empty () ? "constant" : "vertex");
}

/** \brief Mass, centre, and the inertia as moments about its principal axes. */
void
addMass (UsdText& usd, const PhysicalBody& body)
{
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver (body.inertia);
  Eigen::Isometry3d axes = Eigen::Isometry3d::Identity ();
  axes.linear () = solver.eigenvectors ();
  if (axes.linear ().determinant () < 0.0)
    axes.linear ().col (0) *= -1.0; // a rotation, not a reflection
  usd.add ("float physics:mass", numberText (body.mass_kg));
  usd.add ("point3f physics:centerOfMass", tupleText (body.centre_m));
  usd.add ("float3 physics:diagonalInertia", tupleText (solver.eigenvalues ()));
  usd.add ("quatf physics:principalAxes", tupleText (scalarFirst (rotationOf (axes))));
}

/** \brief How a simulator approximates the parts: triangles that move collide with few others. */
std::string
approximation (const PhysicalBody& body)
{
  if (body.convex)
    return "\"convexHull\"";
  return body.isStatic () ? "\"none\"" : "\"convexDecomposition\"";
}

void
addBody (UsdText& usd, const PhysicalBody& body)
{
  usd.open ("Xform", primName (body.name), body.isStatic () ? "" : R"("PhysicsRigidBodyAPI", "PhysicsMassAPI")");
  addPose (usd, body.T_scene_body);
  usd.add ("uniform token[] xformOpOrder", R"(["xformOp:translate", "xformOp:orient"])");
  usd.add ("custom int userProperties:id", numberText (body.id));
  if (!body.isStatic ())
    addMass (usd, body);
  if (!body.visual.empty ())
  {
    usd.open ("Mesh", "visual");
    addMesh (usd, body.visual, body.colour);
    usd.close ();
  }
  for (std::size_t k = 0; k < body.parts.size (); ++k)
  {
    usd.open ("Mesh", "part_" + std::to_string (k), R"("PhysicsCollisionAPI", "PhysicsMeshCollisionAPI")");
    usd.add ("uniform token purpose", "\"guide\"");
    usd.add ("uniform token physics:approximation", approximation (body));
    addMesh (usd, body.parts[k], body.colour);
    usd.close ();
  }
  usd.close ();
}

void
addPlane (UsdText& usd, const PhysicalPlane& plane)
{
  usd.open ("Cube", primName (plane.name), "\"PhysicsCollisionAPI\"");
  usd.add ("double size", "1");
  usd.add ("float3[] extent", "[(-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)]");
  addPose (usd, plane.T_scene_plane * Eigen::Translation3d (boxCentre (plane)));
  usd.add ("float3 xformOp:scale", tupleText (boxSize (plane)));
  usd.add ("uniform token[] xformOpOrder", R"(["xformOp:translate", "xformOp:orient", "xformOp:scale"])");
  std::string colour;
  appendTuple (colour, linearColour (plane_colour));
  usd.add ("color3f[] primvars:displayColor", "[" + colour + "]");
  usd.close ();
}

std::string
stageText (const PhysicalScene& scene)
{
  const double magnitude = scene.gravity.norm ();
  Eigen::Vector3d direction = -Eigen::Vector3d::UnitZ ();
  if (magnitude > 0.0)
    direction = scene.gravity / magnitude;
  UsdText usd;
  usd.open ("Xform", "World");
  usd.open ("PhysicsScene", "physics");
  usd.add ("vector3f physics:gravityDirection", tupleText (direction));
  usd.add ("float physics:gravityMagnitude", numberText (magnitude));
  usd.close ();
  for (const PhysicalPlane& plane : scene.planes)
    addPlane (usd, plane);
  for (const PhysicalBody& body : scene.bodies)
    addBody (usd, body);
  usd.close ();
  return usd.text ();
}

} // namespace

std::vector<std::string>
writeUsd (const PhysicalScene& scene, const std::string& folder)
{
  SceneFolder files (folder);
  addSceneJson (scene, files);
  files.write ("scene.usda", stageText (scene));
  return files.finish ();
}

} // namespace pcl::cosection
