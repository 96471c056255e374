// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "co_section_state.h"
#include "pcl_cosection/priors/hidden_walls.h"
#include "pcl_cosection/view/outliers/view_agreement.h"

#include "pcl_cosection/energy/constraints/intersection_constraint.h"
#include "pcl_cosection/priors/shape/symmetric_extent.h"
#include <pcl/cosection/surface/co_section.h>

#include <pcl/cosection/common/error.h>

#include <array>
#include <chrono>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl::cosection
{

/** \brief The plane in the frame of the target. */
inline Eigen::Vector4d
transformPlane (const Eigen::Vector4d& plane, const Eigen::Isometry3d& T_plane_target)
{
  Eigen::Vector4d out;
  out.head<3> () = T_plane_target.linear ().transpose () * plane.head<3> ();
  out[3] = plane[3] + plane.head<3> ().dot (T_plane_target.translation ());
  return out;
}

/** \brief One execution of CoSection::reconstruct () or CoSection::update (). */
class CoSectionRun
{
public:
  enum class Mode
  {
    Once,   ///< evidence is given up once it has been used
    Follow, ///< \a memory is for the next time
  };

  CoSectionRun (const CoSection::Impl& scene, CoSectionMemory& memory, const ProgressCallback& progress,
                Mode mode = Mode::Once);

  SceneResult run (UpdateOutput output = UpdateOutput::Meshes);

private:
  struct Object
  {
    const ObjectInput* input = nullptr;
    ObjectResult* result = nullptr;
    std::vector<OrientedPoint> kept;                      // its points, if some are outlier; else empty
    Eigen::AlignedBox3d observed;                         // of its points
    double spacing_m = 0.0;                               // supportedVoxelSize () of its points
    double voxel_size_m = 0.0;                            // its grid's, but for vessels, whose may be finer
    Eigen::Vector3d extents_m = Eigen::Vector3d::Zero (); // observedExtents () of its points
    std::optional<DepthView> assumed;                     // of its points, if the scene has no views; object frame
    std::optional<ViewAgreement> agreement;               // of all views with its points
    IncrementalState* body = nullptr;
    std::vector<Eigen::Vector4d> planes;                  // world
    bool plane_is_guessed = false;                        // a guess, which bounds the estimate but not what may be
    SignedDistanceField field;                            // its shape, as far as known
    SignedDistanceField told;                             // what its neighbours are told of it
    std::unique_ptr<IntersectionConstraint> surroundings; // background, planes and bodies, which stay as they are
    std::map<std::size_t, double> beta;                   // growth of the weights of single neighbours
    double beta_surroundings = 1.0;                       // growth of the weight of background, planes and bodies

    const std::vector<OrientedPoint>& points () const { return kept.empty () ? input->points : kept; }

    bool alive () const { return result->error.empty (); }

    ShapeVolume& volume () const { return *body->volume; }
  };

  /** \brief Relative poses of two bodies over the views, thinned to motions of more than half a voxel. */
  std::vector<Eigen::Isometry3d> relativePoses (const Object& of, const Object* to) const;
  /** \brief T_world_object at a view; not finite if it is not known. */
  Eigen::Isometry3d pose (const Object& object, std::size_t view) const;
  /** \brief The first that is known. */
  Eigen::Isometry3d firstPose (const Object& object) const;
  /** \brief That of the first pose that is known. */
  std::size_t firstView (const Object& object) const;
  /** \brief Which points of the background are on the object's surface where it was, or began to be known. */
  void findPointsOf (const Object& object, std::vector<bool>& found) const;
  /** \brief The views that saw where the object is, or may be, and T_object_sensor; not those for free space only. */
  std::vector<std::pair<const DepthView*, Eigen::Isometry3d>> viewsOf (const Object& object) const;

  bool nothingIsKnownAround () const;
  /** \brief Of what is alone, the plane on which it seems to have stood, if any. */
  void guessPlane (Object& object) const;
  /** \brief A plane that was guessed is no body: what it bounds is inferred. */
  void markGuesses (const Object& object, TriangleMesh& mesh) const;
  /** \brief The planes on which the object comes to rest in some view, object frame. */
  std::vector<Eigen::Vector4d> restingPlanes (const Object& object) const;
  /** \brief Whether some of its points are lower over a plane, object frame, than \a reach of its middle extent. */
  bool hasFootNear (const Object& object, const Eigen::Vector4d& plane, double reach) const;
  /** \brief Whether its lowest points are so near to a plane, object frame, that it rests there unless something is
   * seen between. */
  bool mayRestOn (const Object& object, const Eigen::Vector4d& plane) const;
  /** \brief Whether between the foot of its axis on a plane and what was seen of it nothing is known to be, neither
   * free space nor another body. */
  /** \brief Box of what was observed and, if something else hides that, of what is straight below it on the planes. */
  Eigen::AlignedBox3d downToPlanesBehindOthers (const Object& object, const std::vector<Eigen::Vector4d>& planes) const;
  bool footIsHidden (const Object& object, const Eigen::Vector4d& plane) const;
  UnseenPlaces placesOf (const Object& object) const;
  /** \brief How far apart points of walls are: no nearer than those that were seen. */
  double wallStep (const Object& object) const;
  /** \brief With the vertical walls of what is bounded by such, or with those walls that others hide. \param[in] plane
   * on which it stands, object frame */
  SymmetricExtent withHiddenWalls (const Object& object, const SymmetricExtent& extent,
                                   const Eigen::Vector4d& plane) const;
  void observeObjects ();
  void measure (Object& object) const;
  /** \brief A few points far from all others would become bodies of their own. */
  void leaveOutOutliers (Object& object);
  /** \brief What its views hide of the object; for the extent prior. */
  void findHidden (Object& object) const;
  /** \brief The body with the voxels that it had; null if it had none. \param[in] id 0: the background, -1: a piece of
   * it */
  const IncrementalState* earlierBody (const IncrementalState& body, int id) const;
  /** \brief Of its points; a tube, if the background is seen where a vessel would have its floor. \param[in] plane it
   * stands on, object frame */
  SymmetricExtent extentOf (const Object& object, const std::optional<Eigen::Vector4d>& plane) const;
  /** \brief Of the wall of a vessel; 0: it is none. */
  double wallThickness (const Object& object) const;
  /** \brief As the points support it; finer for the walls of vessels. That of a body that is followed stays, unless it
   * is very wrong. */
  double gridVoxelSize (Object& object) const;
  /** \brief From the one that is best to one that takes little memory. */
  std::array<double, 3> possibleVoxelSizes (Object& object) const;
  /** \brief That which it has, if it is near enough to the one wanted. */
  double followedSize (const Object& object, double voxel_size_m) const;
  void createVolumes ();
  Eigen::AlignedBox3d volumeBox (const Object& object) const;
  /** \brief Of points, views and volumes, about. */
  std::size_t bytesInUse () const;
  /** \brief The plane with its normal to the side of most of the object's points. */
  Eigen::Vector4d towards (const Object& object, const Eigen::Vector4d& plane) const;
  /** \brief Warn if what the user gave leaves no room for some of the object's points. \param[in] isCut of a point,
   * object frame */
  template <typename IsCut> void warnIfCut (const Object& object, IsCut&& isCut, const std::string& where);
  void warnIfCutByPlanes (const Object& object);
  void warnIfCutByBodies ();
  void findPlanes ();
  /** \brief Turn bodies given as meshes into signed distances where the objects may be. */
  void sampleMeshes ();
  void sampleMesh (const MeshObstacle& obstacle, double voxel_size_m, double band_m);
  /** \brief Boxes of the background that are to be solved. */
  std::vector<Eigen::AlignedBox3d> backgroundBoxes () const;
  double backgroundVoxelSize (const std::vector<Eigen::AlignedBox3d>& boxes) const;
  std::vector<PlaneContinuation> continuedPlanes () const;
  void createBackground ();
  std::vector<IncrementalState*> backgroundBodies ();
  void solveBackground (UpdateOutput output);
  void solveBackground (IncrementalState& body, const std::vector<PlaneContinuation>& planes, UpdateOutput output);
  /** \brief Give a body a volume that covers \a box, keeping the one it has where that does.
   * \param[in] blur widens points' Gaussians, where voxels are finer than the points support */
  void place (IncrementalState& body, int id, const Eigen::AlignedBox3d& box, double voxel_size_m, bool carve,
              double blur = 1.0);
  /** \brief Let all bodies read what is new in the scene. */
  void gatherEvidence ();
  void warnIfFarApart (const Object& object);
  /** \brief Warn if its points support no voxels that tell much of it. */
  void warnIfCoarse (const Object& object);
  /** \brief Of a view, in warnings. */
  std::string nameOf (std::size_t view) const;
  /** \brief Tell how well views agree with the object's points, and warn if they do not. */
  void judgeAgreement (Object& object);
  /** \brief Points of the background without those that views look through. */
  std::vector<OrientedPoint> backgroundAtRest () const;
  void readPoints (Object& object);
  void prepareObject (Object& object);
  /** \brief The constraint of all that is no object. */
  IntersectionConstraint surroundings (const Object& object) const;
  std::vector<LowerBound> bounds (Object& object) const;
  void solveObjects ();
  /** \brief Passes over all objects until none is deeper in another than allowed. */
  void solveObjects (Resolution resolution, int min_passes);
  void solvePass (Resolution resolution, int pass);
  /** \brief Solve one object; of the whole progress it is \a share, from \a begin on. */
  void solve (Object& object, Resolution resolution, double begin, double share);
  bool growWeightsWherePenetrating (Resolution resolution);
  /** \brief Deepest of the places where the object's surface crosses an edge of its grid; depthAt (place), 0 if
   * outside. */
  template <typename DepthAt> double deepest (const Object& object, DepthAt&& depthAt) const;
  double penetrationOfGivenPlanes (const Object& object) const;
  double penetration (const Object& object, const SignedDistanceField& body,
                      const std::vector<Eigen::Isometry3d>& poses) const;
  double penetrationOfSurroundings (const Object& object) const;
  double penetration (const Object& object) const;
  /** \brief What is expected of its hidden sides. */
  void addPriors (Object& object);
  void finishObject (Object& object, UpdateOutput output);
  /** \brief The planes that bound an object, world frame. */
  std::vector<Eigen::Vector4d> planesOf (const Object& object) const;
  /** \brief Planes of the world as the object sees them at some poses, without those to whose other side it has been
   * taken: from a table to the floor. */
  std::vector<Eigen::Vector4d> planesAt (const Object& object, const std::vector<Eigen::Vector4d>& planes,
                                         const std::vector<Eigen::Isometry3d>& T_world_object) const;
  /** \brief A grid for an object's hull and mesh, on the lattice of its volume; that of its volume where more memory is
   * not allowed.
   * \param[in] unseen box of the hull */
  VoxelGrid hullGrid (const Object& object, const Eigen::AlignedBox3d& unseen, std::size_t used_bytes) const;
  /** \brief Hulls and outer bounds of all objects that have a mesh. */
  void findHulls ();

  template <typename Function> void timed (const char* stage, Function&& f);
  template <typename Function> void guarded (Object& object, Function&& f);
  template <typename Function> void guardedBackground (Function&& f);
  void report (const std::string& stage, double fraction) const;

  const CoSection::Impl& scene_;
  CoSectionMemory& memory_;
  const ProgressCallback& progress_;
  const Mode mode_;
  SceneResult result_;
  std::vector<Object> objects_;
  std::vector<std::unique_ptr<IncrementalState>> pieces_; // of the background, if only parts of it are solved
  std::vector<SignedDistanceField::ConstPtr> background_;
  std::vector<Obstacle> bodies_; // that the user gave, as fields
};

template <typename Function>
void
CoSectionRun::timed (const char* stage, Function&& f)
{
  const auto start = std::chrono::steady_clock::now ();
  f ();
  result_.timings_s[stage] += std::chrono::duration<double> (std::chrono::steady_clock::now () - start).count ();
}

/** \brief Do something for one object; if it fails, only that object is lost. */
template <typename Function>
void
CoSectionRun::guarded (Object& object, Function&& f)
{
  const auto fail = [&] (const std::string& what) {
    const int id = object.result->id;
    *object.result = ObjectResult ();
    object.result->id = id;
    object.result->error = what;
    *object.body = IncrementalState ();
    object.field = object.told = SignedDistanceField ();
  };
  try
  {
    f ();
  }
  catch (const Cancelled&)
  {
    throw;
  }
  catch (const Error& e)
  {
    fail (e.what ());
  }
  catch (const std::bad_alloc&)
  {
    fail ("not enough memory");
  }
}

} // namespace pcl::cosection
