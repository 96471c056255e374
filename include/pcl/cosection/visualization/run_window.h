// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/visualization/run_scene.h>
#include <pcl/cosection/visualization/scene_picture.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace pcl::cosection {

/** \brief Connect to the display.
 * \return the connection, to be kept until there is a window: a server may begin anew when its last client goes, and
 * refuse the next meanwhile
 * \throws IoError that says why no window can be opened: there is no display, or it has no OpenGL */
PCL_COSECTION_EXPORT std::shared_ptr<void> requireDisplay ();

/** \brief A scene in the place of the one that a window shows. */
struct PCL_COSECTION_EXPORT SceneUpdate
{
  RunScene scene;                     ///< what is shown from now on
  std::optional<SurfaceMode> surface; ///< to show from now on; nothing: as before
};

/** \brief What a window shows first, and where it may write. */
struct PCL_COSECTION_EXPORT RunWindowOptions
{
  std::string title = "pcl_cosection";           ///< of the window
  SceneView view;                                ///< size, modes and parts; nothing as viewpoint: it follows the camera
  std::size_t first_frame = 0;                   ///< that is shown, from 0
  std::string dataset;                           ///< of the input points; empty: the one that the run names
  std::string viewpoint_file = "viewpoint.json"; ///< that the key v writes; empty: it refuses to
  /** \brief Begin of the names of pictures that the key p writes, before a number and .png; empty: no pictures. */
  std::string picture_prefix = "window_";
  double frames_per_second = 30.0; ///< when playing
  /** \brief Called some five times a second: a scene that is new, or nothing. */
  std::function<std::optional<SceneUpdate> ()> newScene;
  std::function<bool ()> stop; ///< called likewise: whether to close the window
  std::function<void (const std::string& line)>
      said;        ///< called with what changed, in a line: "frame 3 of 12", "wrote view.json"
  int threads = 0; ///< for signed distances; 0: all

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief A window in which a run is played: its background and objects along the trajectories. The key h shows what
 * the others do.
 *
 * What SceneView describes is shown as drawScene () draws it; beyond that, cuts through the signed distance of a chosen
 * object. For one thread, the one that made it.
 * \code
 * ReadingNotes notes;
 * RunWindow window (loadRunScene ("out", notes));
 * window.run ();
 * \endcode */
class PCL_COSECTION_EXPORT RunWindow
{
public:
  /** \brief Open the window. \throws IoError as requireDisplay (), InvalidArgument for options outside their domain or
   * a scene without frames
   */
  explicit RunWindow (RunScene scene, const RunWindowOptions& options = {});
  ~RunWindow ();
  RunWindow (const RunWindow&) = delete;
  RunWindow& operator= (const RunWindow&) = delete;

  /** \brief Show the window until it is closed. */
  void run ();

  /** \brief Go to a frame, the last if there are fewer, and draw it. */
  void show (std::size_t frame);

  /** \brief What a key does, by its name in X: "space", "Right", "m". Unknown ones do nothing. */
  void press (const std::string& key);

  /** \brief What the window shows. */
  Picture picture ();

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace pcl::cosection
