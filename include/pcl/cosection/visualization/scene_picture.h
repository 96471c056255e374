// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/visualization/frame_points.h>
#include <pcl/cosection/visualization/run_scene.h>
#include <pcl/cosection/visualization/scene_colours.h>
#include <pcl/cosection/visualization/viewpoint.h>

#include <optional>

namespace pcl::cosection
{

/** \brief How a scene is drawn. */
struct PCL_COSECTION_EXPORT SceneView
{
  int width = 1280;                   ///< pixels
  int height = 720;                   ///< pixels
  std::optional<Viewpoint> viewpoint; ///< nothing: with the camera of the run, where it was
  SurfaceMode surface = SurfaceMode::Completed;
  ColourMode colour = ColourMode::Real;
  bool objects = true;
  bool background = true;
  bool path = true;    ///< of the camera, so far
  bool frustum = true; ///< what the camera sees; not drawn from the camera itself
  bool boxes = false;  ///< bounding volumes of the objects
  bool legend = true;
  bool caption = true;
  int oversampling = 2; ///< for smooth edges; 1: none

  /** \brief \throws InvalidArgument naming the first parameter outside its domain. */
  void validate () const;
};

/** \brief Draw the scene of a run at a time, without a display: every object where it was, if that is known. Triangles
 * of the background that face away are left out: one looks through the walls of a room from outside.
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
