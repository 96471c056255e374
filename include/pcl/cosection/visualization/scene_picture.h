// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/visualization/run_scene.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief From where a scene is looked at. */
struct PCL_COSECTION_EXPORT Viewpoint
{
  Eigen::Vector3d eye = {0.0, 0.0, -2.0};   ///< metres, world frame
  Eigen::Vector3d target = {0.0, 0.0, 0.0}; ///< in the middle of the picture, metres
  Eigen::Vector3d up = {0.0, -1.0, 0.0};    ///< points up in the picture; not along the line of sight
  double angle_rad = 0.7;                   ///< between the upper and the lower edge of the picture

  /** \brief T_world_camera, z forward, y down. */
  Eigen::Isometry3d pose () const;

  /** \brief The camera of a picture of this size. */
  PinholeCamera camera (int width, int height) const;

  /** \brief Check all values. \throws InvalidArgument if something is not finite, there is no line of sight, \a up is
   * along it, or the angle is outside (0, pi) */
  void validate () const;
};

/** \brief What is above in a scene: RunScene::up; else where its floor or table faces, among what is above in the
 * pictures; those alone where there is none. Unit. */
PCL_COSECTION_EXPORT Eigen::Vector3d upDirection (const RunScene& scene);

/** \brief From above and behind the cameras, with all objects in the picture, wherever they were, if it is at least as
 * wide as high; of a scene without objects, with the background.
 * \param[in] scene the run
 * \param[in] turn_rad go around the middle of what is to be seen; with pi, one sees what the cameras did not
 * \param[in] with_cameras stay behind the cameras, so that they are in the picture; else no farther away than the
 * objects need */
PCL_COSECTION_EXPORT Viewpoint overview (const RunScene& scene, double turn_rad = 0.0, bool with_cameras = true);

/** \brief A camera of \a width x \a height pixels that sees all that \a camera sees, and more to the sides or above and
 * below where the pictures have other proportions. */
PCL_COSECTION_EXPORT PinholeCamera fittedCamera (const PinholeCamera& camera, int width, int height);

/** \brief Write a viewpoint as JSON: eye, target, up, angle_deg. \throws IoError */
PCL_COSECTION_EXPORT void saveViewpoint (const Viewpoint& viewpoint, const std::string& path);

/** \brief Read what saveViewpoint () wrote. \throws IoError naming the file and what is wrong */
PCL_COSECTION_EXPORT Viewpoint loadViewpoint (const std::string& path);

/** \brief Readings of a frame in the world. */
struct PCL_COSECTION_EXPORT FramePoints
{
  std::vector<Eigen::Vector3f> points;       ///< metres, world frame
  std::vector<TriangleMesh::Colour> colours; ///< one per point
};

/** \brief Reads the frames that a run has read. */
class PCL_COSECTION_EXPORT FramePointReader
{
public:
  /** \brief List the frames.
   * \param[in] scene the run
   * \param[in] dataset empty: the one that the run's summary names
   * \throws IoError if there is none, or it cannot be read */
  explicit FramePointReader (const RunScene& scene, const std::string& dataset = "");
  ~FramePointReader ();
  /** \brief Takes over what the other one has. */
  FramePointReader (FramePointReader&&) noexcept;
  /** \brief Takes over what the other one has. */
  FramePointReader& operator= (FramePointReader&&) noexcept;

  /** \brief The readings of the frame nearest to \a stamp, at the run's pose of the camera; none if there is no such
   * frame or no pose.
   * \param[in] scene the run
   * \param[in] stamp seconds, or the number of a frame
   * \param[in] every take every so many pixels along each axis
   * \throws IoError naming the image that cannot be read */
  FramePoints read (const RunScene& scene, double stamp, int every = 1) const;

private:
  std::unique_ptr<RgbdSequence> images_;
  std::vector<double> stamps_;
};

/** \brief What the colour of a surface means. */
enum class ColourMode
{
  Real,       ///< what the camera saw
  Instance,   ///< a colour for each object
  Provenance, ///< why the surface is where it is
  Confidence, ///< how near a reading is
  Error,      ///< the distance to the truth
};

/** \brief How a scene is drawn. */
struct PCL_COSECTION_EXPORT SceneView
{
  int width = 1280;                             ///< pixels
  int height = 720;                             ///< pixels
  std::optional<Viewpoint> viewpoint;           ///< nothing: with the camera of the run, where it was
  SurfaceMode surface = SurfaceMode::Completed; ///< of objects and background
  ColourMode colour = ColourMode::Real;         ///< of surfaces
  bool objects = true;                          ///< whether they are drawn
  bool background = true;                       ///< whether it is drawn
  bool path = true;                             ///< of the camera, so far
  bool frustum = true;                          ///< what the camera sees; not drawn from the camera itself
  bool boxes = false;                           ///< bounding volumes of the objects
  bool legend = true;                           ///< of the colours
  bool caption = true;                          ///< stamp and numbers, in a corner
  int oversampling = 2;                         ///< for smooth edges; 1: none

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief Draw the scene of a run at a time, without a display: every object where it was, if that is known. Triangles
 * of the background that face away are left out: one looks through the walls of a room from outside.
 * \param[in] scene the run
 * \param[in] stamp seconds, or the number of a frame
 * \param[in] view what to draw, and from where
 * \param[in] points of the frame, for SurfaceMode::Points; null: none
 * \throws InvalidArgument as SceneView::validate ()
 * \code
 * ReadingNotes notes;
 * const RunScene scene = loadRunScene ("out", notes);
 * SceneView view;
 * view.viewpoint = overview (scene);
 * writePng (drawScene (scene, scene.stamps ().back (), view), "scene.png");
 * \endcode */
PCL_COSECTION_EXPORT Picture drawScene (const RunScene& scene, double stamp, const SceneView& view = {},
                                        const FramePoints* points = nullptr);

} // namespace pcl::cosection
