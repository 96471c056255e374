// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/oriented_point.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/surface/options.h>
#include <pcl/cosection/surface/solver.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief The measurements of one object. */
struct PCL_COSECTION_EXPORT ObjectInput
{
  int id = 0;                        ///< unique, positive
  std::vector<OrientedPoint> points; ///< object frame
  /** \brief One pose per view of the scene, not finite where it is not known: that view and the bodies in it then say
   * nothing of this object. Empty: the object frame is the world frame. */
  std::vector<Eigen::Isometry3d> T_world_object;
  /** \brief Meshes of any size and pose, one of which may be its shape: from a generator, or a model. The one that fits
   * the measurements best is moved, turned and scaled onto them; if it explains them, it is expected where nothing was
   * measured. */
  std::vector<TriangleMesh> proposals = {};
};

/** \brief How a proposed mesh fits the measurements of an object. */
struct PCL_COSECTION_EXPORT ProposalFit
{
  std::size_t proposal = 0; ///< its place in ObjectInput::proposals
  bool used = false;        ///< whether it explains the measurements well enough to be expected
  bool withdrawn = false;   ///< it does, but the shape without it explains them better
  Eigen::Affine3d T_object_proposal = Eigen::Affine3d::Identity (); ///< a rotation, one scale, a translation
  double scale = 1.0;                                               ///< of T_object_proposal
  double distance_m = 0.0;                                          ///< median distance of the points from it
  double explained = 0.0;                                           ///< in [0, 1]: how well the points lie on it
  double confirmed = 0.0;    ///< in [0, 1]: how well points cover what of it the views should see
  double contradicted = 0.0; ///< share of its surface that is in seen free space, or below a support plane
};

/** \brief A completed object. */
struct PCL_COSECTION_EXPORT ObjectResult
{
  int id = 0;        ///< as it was given
  std::string error; ///< empty, or why there is no mesh
  TriangleMesh mesh; ///< closed, object frame
  /** \brief If asked for: closed, object frame. The hull is all that may be the object: what no view saw free, above
   * support planes, as far as it is connected with the object's points and lies no farther from them than the longest
   * side of their box (in the object's volume if there are no views or no background, a padding is given, or memory
   * allows no more). It shrinks as views are added, also with their points, but for noise. The inner bound is where
   * measured surfaces imply matter, three voxels deep; the outer bound is the hull with the mesh moved by two sigma_m.
   * Up to a quarter of a voxel, inner_bound lies inside mesh, and mesh inside outer_bound; both are right to about a
   * voxel and a half at sharp edges. */
  TriangleMesh hull;
  TriangleMesh inner_bound;                 ///< as \a hull says
  TriangleMesh outer_bound;                 ///< as \a hull says
  SignedDistanceField::Ptr signed_distance; ///< object frame
  std::size_t outlier_points = 0;           ///< left out: a few far from the others, or repeated ones
  /** \brief Share in [0, 1] of the points that a view looks through, among those that it sees or looks through, for the
   * view with the largest share (of many views, one in twenty may be worse). Wrong poses and motion make it large.
   * CoSection::reconstruct () sets it where seen free space is used. */
  double contradicted_share = 0.0;
  /** \brief The plane on which an object seems to have stood around which nothing is known, world frame, n.x + d = 0,
   * unit n towards it: inferred from where it ends, or how it is open. It bounds the mesh. */
  std::optional<Eigen::Vector4d> guessed_plane;
  std::optional<ProposalFit> proposal; ///< the best of ObjectInput::proposals; nothing: none could be aligned
  /** \brief What CoSectionOptions::completion_network expects; nothing: it was not asked, or expects nothing. */
  std::optional<ProposalFit> learned;
  SolverSummary solver;       ///< of the last pass; its iterations are those of all passes at full resolution
  double penetration_m = 0.0; ///< deepest place of its surface in supported parts of another body
};

/** \brief A piece of the background, as it was solved. */
struct PCL_COSECTION_EXPORT BackgroundResult
{
  SignedDistanceField::Ptr signed_distance; ///< world frame
  SolverSummary solver;                     ///< what the solver did
  /** \brief Share of its voxels that were solved: less than 1 where an update left the others as they were. */
  double solved_share = 1.0;
};

/** \brief Everything CoSection::reconstruct () computes. */
struct PCL_COSECTION_EXPORT SceneResult
{
  std::vector<ObjectResult> objects;               ///< in the order of addObject ()
  TriangleMesh background;                         ///< open, trimmed to supported regions; world frame
  std::vector<BackgroundResult> background_pieces; ///< around the objects, or the whole: in one, or in blocks that meet
  std::vector<Eigen::Vector4d>
      planes; ///< support planes used: unit normal n towards the objects, n.x + d = 0, world frame
  std::map<std::string, double> timings_s; ///< data_term, constraints, solve, mesh
  std::vector<std::string> warnings;       ///< one line each
};

/** \brief What a view is used for. */
enum class ViewUse
{
  Full,      ///< free space, and where hidden parts of objects may be
  FreeSpace, ///< free space only, in whole voxels: for a view between two similar ones, or one without labels
};

/** \brief What CoSection::update () computes. */
enum class UpdateOutput
{
  Fields, ///< signed distances only
  Meshes, ///< meshes as well
};

/** \brief Co-Section: joint completion of several objects and the background they stand on, from
 * oriented points and the free space seen by depth views, under the constraint that bodies do not
 * intersect (M. Strecke, J. Stueckler, "Where Does It End? Reasoning About Hidden Surfaces by Object
 * Intersection Constraints", CVPR 2020).
 *
 * \code
 * CoSection scene;
 * scene.addView (view);                  // free space
 * scene.setBackground (table_points);    // what the objects stand on
 * scene.addObject ({1, cup_points, {}});
 * const SceneResult result = scene.reconstruct ();
 * \endcode */
class PCL_COSECTION_EXPORT CoSection
{
public:
  /** \brief An empty scene. \throws InvalidArgument as CoSectionOptions::validate () */
  explicit CoSection (const CoSectionOptions& options = {});
  ~CoSection ();
  /** \brief Takes over what the other one has, which is an empty scene then. */
  CoSection (CoSection&& other) noexcept;
  /** \brief Exchanges what both have. */
  CoSection& operator= (CoSection&& other) noexcept;

  /** \brief Add a depth view of the whole scene; what lies in front of its readings is free.
   * \return its index, to which ObjectInput::T_world_object refers
   * \throws InvalidArgument if the camera is not valid or the depth has another size */
  int addView (DepthView view);

  /** \brief Add a depth view with the poses of objects that move: of those that were added, and of those that will be.
   * Objects that are not named are where they have been if they have no poses, and unknown at this view if they have.
   * \param[in] view a depth image of the whole scene
   * \param[in] T_world_object by id, metres
   * \param[in] use what the view is used for
   * \return its index, as the other addView ()
   * \throws InvalidArgument if the view is not valid, or a pose not finite */
  int addView (DepthView view, const std::map<int, Eigen::Isometry3d>& T_world_object, ViewUse use = ViewUse::Full);

  /** \brief Remove views, and the points that were added since each of them and before the next. Those that remain are
   * numbered anew, in their order.
   * \param[in] remove one per view
   * \throws InvalidArgument if there is not one per view */
  void removeViews (const std::vector<bool>& remove);

  /** \brief Remove an object with its points and poses, as if it had never been added. An unknown id changes nothing.
   */
  void removeObject (int id);

  /** \brief Set the points of everything that is not an object, world frame, metres; replaces earlier ones.
   * \throws InvalidArgument if a weight is not in [0, 1] */
  void setBackground (std::vector<OrientedPoint> points);

  /** \brief Add points of what is not an object to the earlier ones, world frame, metres.
   * \throws InvalidArgument if a weight is not in [0, 1] */
  void addBackground (const std::vector<OrientedPoint>& points);

  /** \brief Add an object. \throws InvalidArgument if the id is not positive or already there, a weight is not in
   * [0, 1], or a proposal is not consistent or not finite
   * \throws DegenerateInput if a proposal has no triangles, or none of any area */
  void addObject (ObjectInput object);

  /** \brief Add points of an object, object frame, metres. An object that is not there yet is added; if views named its
   * pose, it has those, else the object frame is the world frame.
   * \throws InvalidArgument if the id is not positive, or a weight is not in [0, 1] */
  void addPoints (int id, const std::vector<OrientedPoint>& points);

  /** \brief Add a plane a x + b y + c z + d = 0 that no object crosses, world frame. The coefficients (a, b, c, d) have
   * any scale and either sign: each object is on the side of most of its points. An object at rest that is more than
   * four times its own length away from the plane is as if there were no such plane.
   * \throws InvalidArgument if the normal is zero or a coefficient is not finite */
  void addSupportPlane (const Eigen::Vector4d& plane);

  /** \brief Add a body that objects cannot enter, at one or many poses relative to the world.
   * \param[in] body signed distance in the frame of the body, one value per voxel
   * \param[in] T_body_world takes points of the world to the frame of the body: the inverse of the body's pose
   * \throws InvalidArgument if the field does not have one value per voxel, its grid is not valid, or there is no pose
   * or one that is not a rigid motion */
  void addObstacle (SignedDistanceField::ConstPtr body,
                    const std::vector<Eigen::Isometry3d>& T_body_world = {Eigen::Isometry3d::Identity ()});

  /** \brief Add an obstacle that is given as a mesh: closed, or open as the boundary of what lies behind it:
   * see sampleSignedDistance ().
   * \throws InvalidArgument if the mesh bounds nothing */
  void addObstacle (TriangleMesh body,
                    const std::vector<Eigen::Isometry3d>& T_body_world = {Eigen::Isometry3d::Identity ()});

  /** \brief Complete everything from the start, whatever update () has left. An object that fails (degenerate, too
   * large for the memory allowed ...) does not lose the others: see ObjectResult::error. A background that fails is a
   * warning.
   * \return meshes and signed distances of all objects, and of the background
   * \throws Cancelled if \a progress asks for it */
  SceneResult reconstruct (const ProgressCallback& progress = {}) const;

  /** \brief Complete what changed since the last update: measurements are gathered once, and every shape starts from
   * the last one. The minimum is that of reconstruct () within the solver's tolerance; for a whole background, near
   * data; where that is in blocks, only blocks with new points, free space or planes are solved, and those beside them
   * that then disagree. Volumes grow (or shrink) with what is observed; their voxels keep their places unless points
   * ask for a size that differs by over a fifth.
   * \throws Cancelled; the next call then goes on from what was gathered */
  SceneResult update (UpdateOutput output = UpdateOutput::Meshes, const ProgressCallback& progress = {});

  /** \brief Forget the results of updates, and free their memory. What was added stays. */
  void forgetUpdates ();

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace pcl::cosection
