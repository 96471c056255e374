// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Bodies that stand stay where they are, in simulators that read what is written of a scene.

#include "physical_scenes.h"

#include "common/temporary_folder.h"
#include "pcl_cosection/physics/formats/scene_writers.h"

#include <pcl/cosection/io/mesh_io.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <Eigen/Eigenvalues>

#ifdef PCL_COSECTION_HAS_TOOLS
#include "scene_stability.h" // of the programs
#endif

#if defined(PCL_COSECTION_HAS_URDFDOM) && defined(PCL_COSECTION_HAS_BULLET)
#include <btBulletDynamicsCommon.h>

#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>
#endif

#include <functional>
#include <map>
#include <memory>
#include <ostream>
#include <sstream>

namespace pcl::cosection::test {
namespace {

constexpr double simulated_s = 5.0;

struct StandingScene
{
  const char* name;
  std::function<CompletedScene ()> make;
  SceneFrame frame;
};

std::ostream&
operator<< (std::ostream& out, const StandingScene& scene)
{
  return out << scene.name;
}

Eigen::Isometry3d
tilted ()
{
  return Eigen::Translation3d (0.3, -0.2, 0.6) * Eigen::AngleAxisd (0.3, Eigen::Vector3d (1.0, 0.4, 0.0).normalized ());
}

/** \brief It only stands as its centre of mass is moved. */
CompletedScene
overhangingThing ()
{
  return sceneOf ({objectOf (1, "lamp", overhangingMesh ())});
}

/** \brief As interlockingThings (), with a die, which does not roll, in the cup. */
CompletedScene
thingsInThings ()
{
  CompletedScene scene = interlockingThings ();
  scene.objects[3].label = "die";
  scene.objects[3].mesh = boxMesh ({-0.02f, -0.02f, -0.02f}, {0.02f, 0.02f, 0.02f});
  return scene;
}

const StandingScene standing_scenes[] = {
    {"apart", fourThings, SceneFrame::Auto},
    {"oblique", [] { return movedScene (fourThings (), tilted ()); }, SceneFrame::Result},
    {"tilted", [] { return movedScene (fourThings (), tilted ()); }, SceneFrame::Table},
    {"interlocking", thingsInThings, SceneFrame::Auto},
    {"overhanging", overhangingThing, SceneFrame::Auto}};

class SceneSimulators : public ::testing::TestWithParam<StandingScene>
{
protected:
  SceneSimulators ()
  {
    PhysicsOptions options;
    options.frame = GetParam ().frame;
    scene_ = buildPhysicalScene (GetParam ().make (), options);
  }

  /** \brief Into the test's report (--gtest_output=xml). */
  static void measured (const std::string& simulator, const std::string& body, double drift_m, double turn_rad)
  {
    std::ostringstream text;
    text << 1000.0 * drift_m << " mm, " << turn_rad * 180.0 / M_PI << " degrees";
    RecordProperty (simulator + "_" + body, text.str ());
  }

  PhysicalScene scene_;
  const TemporaryFolder folder_;
};

INSTANTIATE_TEST_SUITE_P (Scenes, SceneSimulators, ::testing::ValuesIn (standing_scenes),
                          [] (const auto& scene) { return scene.param.name; });

TEST_P (SceneSimulators, BodiesStayInMujoco)
{
#ifdef PCL_COSECTION_HAS_TOOLS
  if (!canSimulate ())
    GTEST_SKIP () << "this build has no MuJoCo";
  writeMjcf (scene_, folder_.file (""));
  const SceneStability result = simulateScene (folder_.file ("scene.xml"), simulated_s);
  ASSERT_EQ (result.bodies.size (), scene_.bodies.size ());
  EXPECT_TRUE (result.warnings.empty ()) << result.warnings.front ();
  for (const BodyDrift& body : result.bodies)
  {
    EXPECT_LE (body.largest_drift_m, 0.003) << body.name;
    EXPECT_LE (body.largest_turn_rad, 2.0 * M_PI / 180.0) << body.name;
    measured ("MuJoCo", body.name, body.largest_drift_m, body.largest_turn_rad);
  }
  if (result.deepest_contact)
  {
    measured ("MuJoCo", "contact", result.deepest_contact->depth_m, 0.0);
    EXPECT_LE (result.deepest_contact->depth_m, 0.001)
        << result.deepest_contact->first << " and " << result.deepest_contact->second;
  }
#else
  GTEST_SKIP () << "the programs, which simulate scenes, are not built";
#endif
}

#if defined(PCL_COSECTION_HAS_URDFDOM) && defined(PCL_COSECTION_HAS_BULLET)

constexpr double collision_margin_m = 0.0005; // Bullet's is 40 mm
constexpr double bullet_step_s = 1.0 / 240.0; // as PyBullet's

btVector3
toBullet (const Eigen::Vector3d& v)
{
  return {btScalar (v.x ()), btScalar (v.y ()), btScalar (v.z ())};
}

btTransform
toBullet (const Eigen::Isometry3d& T)
{
  const Eigen::Quaterniond q (T.linear ());
  return btTransform (btQuaternion (btScalar (q.x ()), btScalar (q.y ()), btScalar (q.z ()), btScalar (q.w ())),
                      toBullet (Eigen::Vector3d (T.translation ())));
}

Eigen::Isometry3d
fromBullet (const btTransform& T)
{
  const btQuaternion q = T.getRotation ();
  const btVector3& p = T.getOrigin ();
  return Eigen::Translation3d (p.x (), p.y (), p.z ()) * Eigen::Quaterniond (q.w (), q.x (), q.y (), q.z ());
}

Eigen::Isometry3d
poseOf (const nlohmann::json& json)
{
  const auto p = json["position"].get<std::vector<double>> ();
  const auto q = json["quaternion_xyzw"].get<std::vector<double>> ();
  return Eigen::Translation3d (p[0], p[1], p[2]) * Eigen::Quaterniond (q[3], q[0], q[1], q[2]);
}

/** \brief Bullet with what scene.json and the URDF files of a folder say. */
class BulletScene
{
public:
  explicit BulletScene (const TemporaryFolder& folder) : folder_ (folder)
  {
    const nlohmann::json scene = nlohmann::json::parse (readFile (folder.file ("scene.json")));
    const auto gravity = scene["gravity"].get<std::vector<double>> ();
    world_.setGravity (toBullet (Eigen::Vector3d (gravity.data ())));
    world_.getSolverInfo ().m_numIterations = 50;
    for (const nlohmann::json& plane : scene["planes"])
      addPlane (plane);
    for (const nlohmann::json& body : scene["bodies"])
      addBody (body);
  }

  ~BulletScene ()
  {
    for (const auto& body : bodies_)
      world_.removeRigidBody (body.get ());
  }

  void simulate (double duration_s)
  {
    const int steps = static_cast<int> (std::lround (duration_s / bullet_step_s));
    for (int n = 0; n < steps; ++n)
      world_.stepSimulation (btScalar (bullet_step_s), 0);
  }

  /** \brief Centres of mass, with principal axes. */
  std::map<std::string, Eigen::Isometry3d> poses () const
  {
    std::map<std::string, Eigen::Isometry3d> poses;
    for (const auto& [name, body] : moving_)
      poses[name] = fromBullet (body->getWorldTransform ());
    return poses;
  }

private:
  void add (double mass_kg, const Eigen::Isometry3d& pose, btCollisionShape* shape, const Eigen::Vector3d& moments)
  {
    btRigidBody::btRigidBodyConstructionInfo info (btScalar (mass_kg), nullptr, shape, toBullet (moments));
    info.m_startWorldTransform = toBullet (pose);
    bodies_.push_back (std::make_unique<btRigidBody> (info));
    bodies_.back ()->setActivationState (DISABLE_DEACTIVATION);
    world_.addRigidBody (bodies_.back ().get ());
  }

  template <typename Shape, typename... Arguments> Shape* makeShape (const Arguments&... arguments)
  {
    auto shape = std::make_unique<Shape> (arguments...);
    Shape* const pointer = shape.get ();
    pointer->setMargin (btScalar (collision_margin_m));
    shapes_.push_back (std::move (shape));
    return pointer;
  }

  urdf::LinkConstSharedPtr linkOf (const nlohmann::json& entry) const
  {
    model_ = urdf::parseURDF (readFile (folder_.file (entry["urdf"])));
    return model_->getLink (entry["name"]);
  }

  void addPlane (const nlohmann::json& entry)
  {
    const urdf::LinkConstSharedPtr link = linkOf (entry);
    const auto box = std::dynamic_pointer_cast<urdf::Box> (link->collision->geometry);
    const Eigen::Vector3d half (0.5 * box->dim.x, 0.5 * box->dim.y, 0.5 * box->dim.z);
    const Eigen::Isometry3d pose = poseOf (entry["T_scene_plane"]);
    if (entry["endless"])
      add (0.0, pose, makeShape<btStaticPlaneShape> (btVector3 (0, 0, 1), btScalar (0)), Eigen::Vector3d::Zero ());
    else
      add (0.0, pose * Eigen::Translation3d (0.0, 0.0, link->collision->origin.position.z),
           makeShape<btBoxShape> (toBullet (half)), Eigen::Vector3d::Zero ());
  }

  void addBody (const nlohmann::json& entry)
  {
    const urdf::LinkConstSharedPtr link = linkOf (entry);
    const urdf::Inertial& i = *link->inertial;
    Eigen::Matrix3d inertia;
    inertia << i.ixx, i.ixy, i.ixz, i.ixy, i.iyy, i.iyz, i.ixz, i.iyz, i.izz;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver (inertia);
    Eigen::Matrix3d axes = solver.eigenvectors ();
    if (axes.determinant () < 0.0)
      axes.col (2) = -axes.col (2);
    const urdf::Vector3& centre = i.origin.position;
    Eigen::Isometry3d T_body_centre (Eigen::Translation3d (centre.x, centre.y, centre.z));
    T_body_centre.linear () = axes;
    auto* const shape = makeShape<btCompoundShape> ();
    for (const urdf::CollisionSharedPtr& collision : link->collision_array)
    {
      const auto file = std::dynamic_pointer_cast<urdf::Mesh> (collision->geometry)->filename;
      auto* const hull = makeShape<btConvexHullShape> ();
      for (const Eigen::Vector3f& vertex : loadMesh (folder_.file (file)).vertices)
        hull->addPoint (toBullet (T_body_centre.inverse () * vertex.cast<double> ()), false);
      hull->recalcLocalAabb ();
      shape->addChildShape (btTransform::getIdentity (), hull);
    }
    add (i.mass, poseOf (entry["T_scene_body"]) * T_body_centre, shape, solver.eigenvalues ());
    moving_[entry["name"]] = bodies_.back ().get ();
  }

  const TemporaryFolder& folder_;
  mutable urdf::ModelInterfaceSharedPtr model_; // owns the links
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::map<std::string, btRigidBody*> moving_;
};

#endif

TEST_P (SceneSimulators, BodiesStayInBullet)
{
#if defined(PCL_COSECTION_HAS_URDFDOM) && defined(PCL_COSECTION_HAS_BULLET)
  writeUrdf (scene_, folder_.file (""));
  BulletScene bullet (folder_);
  const std::map<std::string, Eigen::Isometry3d> before = bullet.poses ();
  ASSERT_EQ (before.size (), scene_.bodies.size ());
  bullet.simulate (simulated_s);
  for (const auto& [name, pose] : bullet.poses ())
  {
    const Eigen::Isometry3d& was = before.at (name);
    const double drift = (pose.translation () - was.translation ()).norm ();
    const double turn = Eigen::Quaterniond (pose.linear ()).angularDistance (Eigen::Quaterniond (was.linear ()));
    EXPECT_LT (drift, 0.005) << name;
    EXPECT_LT (turn, 3.0 * M_PI / 180.0) << name;
    measured ("Bullet", name, drift, turn);
  }
#else
  GTEST_SKIP () << "Bullet, or urdfdom, is not installed";
#endif
}

} // namespace
} // namespace pcl::cosection::test
