// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The parsers that robots and simulators use read what is written of a scene.

#include "physical_scenes.h"

#include "common/temporary_folder.h"
#include "pcl_cosection/physics/formats/scene_writers.h"

#include <pcl/cosection/io/mesh_io.h>

#include <gtest/gtest.h>

#include <vtkGLTFReader.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>

#include <filesystem>

#ifdef PCL_COSECTION_HAS_URDFDOM
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>
#endif

#ifdef PCL_COSECTION_HAS_SDFORMAT
#include <sdf/Collision.hh>
#include <sdf/Geometry.hh>
#include <sdf/Link.hh>
#include <sdf/Mesh.hh>
#include <sdf/Model.hh>
#include <sdf/ParserConfig.hh>
#include <sdf/Plane.hh>
#include <sdf/Root.hh>
#include <sdf/Visual.hh>
#include <sdf/World.hh>
#endif

namespace pcl::cosection::test {
namespace {

/** \brief Things on a tilted plane, in the frame of the result or on the table. */
PhysicalScene
sceneToParse (SceneFrame frame)
{
  PhysicsOptions options;
  options.frame = frame;
  options.masses_kg[2] = 0.35;
  const Eigen::Isometry3d T = Eigen::Translation3d (0.3, -0.2, 0.6) *
                              Eigen::AngleAxisd (0.3, Eigen::Vector3d (1.0, 0.4, 0.0).normalized ());
  PhysicalScene scene = buildPhysicalScene (movedScene (fourThings (), T), options);
  scene.planes.push_back (scene.planes[0]);
  scene.planes[1].name = "shelf";
  scene.planes[1].T_scene_plane.translate (Eigen::Vector3d (1.0, 0.0, 0.5));
  scene.planes[1].endless = false;
  return scene;
}

class SceneParsers : public ::testing::TestWithParam<SceneFrame>
{
protected:
  SceneParsers () : scene_ (sceneToParse (GetParam ())) {}

  const PhysicalScene scene_;
  const TemporaryFolder folder_;
};

INSTANTIATE_TEST_SUITE_P (Frames, SceneParsers, ::testing::Values (SceneFrame::Result, SceneFrame::Table),
                          [] (const auto& frame) { return frame.param == SceneFrame::Result ? "result" : "table"; });

#ifdef PCL_COSECTION_HAS_URDFDOM

Eigen::Vector3d
toEigen (const urdf::Vector3& v)
{
  return {v.x, v.y, v.z};
}

/** \brief The file of a mesh that a URDF file names exists and is a mesh. */
TriangleMesh
meshOf (const urdf::GeometrySharedPtr& geometry, const TemporaryFolder& folder)
{
  const auto mesh = std::dynamic_pointer_cast<urdf::Mesh> (geometry);
  EXPECT_NE (mesh, nullptr);
  if (!mesh)
    return {};
  EXPECT_TRUE (std::filesystem::exists (folder.file (mesh->filename))) << mesh->filename;
  EXPECT_EQ (toEigen (mesh->scale), Eigen::Vector3d::Ones ());
  return loadMesh (folder.file (mesh->filename));
}

urdf::ModelInterfaceSharedPtr
parseUrdfFile (const std::string& path)
{
  return urdf::parseURDF (readFile (path));
}

TEST_P (SceneParsers, UrdfdomReadsEveryBody)
{
  writeUrdf (scene_, folder_.file (""));
  for (const PhysicalBody& body : scene_.bodies)
  {
    const urdf::ModelInterfaceSharedPtr model = parseUrdfFile (folder_.file (body.name + ".urdf"));
    ASSERT_NE (model, nullptr) << body.name;
    EXPECT_EQ (model->getName (), body.name);
    ASSERT_EQ (model->links_.size (), 1u);
    EXPECT_TRUE (model->joints_.empty ());
    const urdf::LinkConstSharedPtr link = model->getRoot ();
    ASSERT_NE (link->inertial, nullptr);
    const urdf::Inertial& inertial = *link->inertial;
    EXPECT_DOUBLE_EQ (inertial.mass, body.mass_kg);
    EXPECT_TRUE (toEigen (inertial.origin.position).isApprox (body.centre_m, 1e-12));
    Eigen::Matrix3d inertia;
    inertia << inertial.ixx, inertial.ixy, inertial.ixz, inertial.ixy, inertial.iyy, inertial.iyz, inertial.ixz,
        inertial.iyz, inertial.izz;
    EXPECT_TRUE (inertia.isApprox (body.inertia, 1e-12));
    ASSERT_EQ (link->visual_array.size (), 1u);
    EXPECT_EQ (meshOf (link->visual->geometry, folder_).vertices, body.visual.vertices);
    ASSERT_EQ (link->collision_array.size (), body.parts.size ());
    for (std::size_t k = 0; k < body.parts.size (); ++k)
    {
      EXPECT_EQ (meshOf (link->collision_array[k]->geometry, folder_).vertices, body.parts[k].vertices);
      EXPECT_EQ (toEigen (link->collision_array[k]->origin.position), Eigen::Vector3d::Zero ());
    }
  }
  const double volume = 0.1 * 0.08 * 0.06;
  EXPECT_NEAR (parseUrdfFile (folder_.file ("box_1.urdf"))->getRoot ()->inertial->mass, 500.0 * volume, 1e-6);
  EXPECT_NEAR (parseUrdfFile (folder_.file ("can_2.urdf"))->getRoot ()->inertial->mass, 0.35, 1e-12);
}

TEST_P (SceneParsers, UrdfdomReadsEveryPlane)
{
  writeUrdf (scene_, folder_.file (""));
  for (const PhysicalPlane& plane : scene_.planes)
  {
    const urdf::ModelInterfaceSharedPtr model = parseUrdfFile (folder_.file (plane.name + ".urdf"));
    ASSERT_NE (model, nullptr) << plane.name;
    EXPECT_EQ (model->getRoot ()->name, "world");
    const urdf::LinkConstSharedPtr link = model->getLink (plane.name);
    ASSERT_NE (link, nullptr);
    EXPECT_EQ (link->parent_joint->type, urdf::Joint::FIXED);
    const auto box = std::dynamic_pointer_cast<urdf::Box> (link->collision->geometry);
    ASSERT_NE (box, nullptr);
    EXPECT_NEAR (box->dim.x, 2.0 * plane.half_size_m.x (), 1e-12);
    EXPECT_NEAR (link->collision->origin.position.z + 0.5 * box->dim.z, 0.0, 1e-12); // its upper face
  }
}

#endif

#ifdef PCL_COSECTION_HAS_SDFORMAT

Eigen::Isometry3d
toEigen (const ignition::math::Pose3d& pose)
{
  return Eigen::Translation3d (pose.X (), pose.Y (), pose.Z ()) *
         Eigen::Quaterniond (pose.Rot ().W (), pose.Rot ().X (), pose.Rot ().Y (), pose.Rot ().Z ());
}

void
expectInertial (const ignition::math::Inertiald& inertial, const PhysicalBody& body)
{
  EXPECT_DOUBLE_EQ (inertial.MassMatrix ().Mass (), body.mass_kg);
  EXPECT_TRUE (toEigen (inertial.Pose ()).translation ().isApprox (body.centre_m, 1e-12));
  const ignition::math::Matrix3d moi = inertial.MassMatrix ().Moi ();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      EXPECT_NEAR (moi (row, column), body.inertia (row, column), 1e-12);
}

TEST_P (SceneParsers, SdformatReadsTheWorld)
{
  writeSdf (scene_, folder_.file (""));
  sdf::ParserConfig strict;
  strict.SetWarningsPolicy (sdf::EnforcementPolicy::ERR);
  strict.SetUnrecognizedElementsPolicy (sdf::EnforcementPolicy::ERR);
  strict.SetDeprecatedElementsPolicy (sdf::EnforcementPolicy::ERR);
  sdf::Root root;
  for (const sdf::Error& error : root.Load (folder_.file ("scene.sdf"), strict))
    ADD_FAILURE () << error.Message ();
  ASSERT_EQ (root.WorldCount (), 1u);
  const sdf::World& world = *root.WorldByIndex (0);
  EXPECT_EQ (world.Name (), scene_.name);
  EXPECT_LT (
      (Eigen::Vector3d (world.Gravity ().X (), world.Gravity ().Y (), world.Gravity ().Z ()) - scene_.gravity).norm (),
      1e-12);
  ASSERT_EQ (world.ModelCount (), scene_.planes.size () + scene_.bodies.size ());
  for (const PhysicalBody& body : scene_.bodies)
  {
    const sdf::Model* model = world.ModelByName (body.name);
    ASSERT_NE (model, nullptr) << body.name;
    EXPECT_FALSE (model->Static ());
    EXPECT_TRUE (toEigen (model->RawPose ()).isApprox (body.T_scene_body, 1e-12));
    ASSERT_EQ (model->LinkCount (), 1u);
    const sdf::Link& link = *model->LinkByIndex (0);
    expectInertial (link.Inertial (), body);
    ASSERT_EQ (link.CollisionCount (), body.parts.size ());
    for (std::size_t k = 0; k < body.parts.size (); ++k)
    {
      const sdf::Mesh* mesh = link.CollisionByIndex (k)->Geom ()->MeshShape ();
      ASSERT_NE (mesh, nullptr);
      EXPECT_EQ (loadMesh (folder_.file (mesh->Uri ())).vertices, body.parts[k].vertices);
    }
    ASSERT_EQ (link.VisualCount (), 1u);
    EXPECT_EQ (loadMesh (folder_.file (link.VisualByIndex (0)->Geom ()->MeshShape ()->Uri ())).vertices,
               body.visual.vertices);
  }
  for (const PhysicalPlane& plane : scene_.planes)
  {
    const sdf::Model* model = world.ModelByName (plane.name);
    ASSERT_NE (model, nullptr) << plane.name;
    EXPECT_TRUE (model->Static ());
    EXPECT_TRUE (toEigen (model->RawPose ()).isApprox (plane.T_scene_plane, 1e-12));
    const sdf::Collision& collision = *model->LinkByIndex (0)->CollisionByIndex (0);
    EXPECT_EQ (collision.Geom ()->Type (), plane.endless ? sdf::GeometryType::PLANE : sdf::GeometryType::BOX);
  }
}

#endif

/** \brief What a viewer shows: y is up. */
TEST_P (SceneParsers, VtkReadsTheGlb)
{
  writeGltf (scene_, folder_.file (""));
  vtkNew<vtkGLTFReader> reader;
  reader->SetFileName (folder_.file ("scene.glb").c_str ());
  reader->Update ();
  double bounds[6] = {};
  ASSERT_NE (reader->GetOutput (), nullptr);
  reader->GetOutput ()->GetBounds (bounds);
  const auto shown = [] (const Eigen::Vector3d& p) { return Eigen::Vector3d (p.x (), p.z (), -p.y ()); };
  Eigen::AlignedBox3d expected;
  for (const PhysicalBody& body : scene_.bodies)
    for (const Eigen::Vector3f& vertex : body.visual.vertices)
      expected.extend (shown (body.T_scene_body * vertex.cast<double> ()));
  for (const PhysicalPlane& plane : scene_.planes)
    for (const double x : {-plane.half_size_m.x (), plane.half_size_m.x ()})
      for (const double y : {-plane.half_size_m.y (), plane.half_size_m.y ()})
        for (const double z : {-plane.thickness_m, 0.0})
          expected.extend (shown (plane.T_scene_plane * Eigen::Vector3d (x, y, z)));
  for (int axis = 0; axis < 3; ++axis)
  {
    EXPECT_NEAR (bounds[2 * axis], expected.min ()[axis], 1e-5) << axis;
    EXPECT_NEAR (bounds[2 * axis + 1], expected.max ()[axis], 1e-5) << axis;
  }
}

} // namespace
} // namespace pcl::cosection::test
