// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "window_overlay.h"
#include "window_scene.h"

#include <pcl/cosection/visualization/run_window.h>

#include <vtkCommand.h>
#include <vtkInteractorStyle.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkSliderRepresentation2D.h>
#include <vtkSliderWidget.h>
#include <vtkSmartPointer.h>

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief The window, and what keys, mouse, slider and time do with it. */
struct RunWindow::Impl
{
public:
  Impl (RunScene scene, const RunWindowOptions& options);
  ~Impl ();

  void run ();
  void goTo (std::size_t frame);
  void press (const std::string& key);
  Picture picture ();

private:
  void makeSlider ();
  void observe ();
  void onTimer ();
  void takeScene (SceneUpdate update);
  /** \brief All keys, as people call them, and what they do, in two columns. */
  static std::string helpText ();
  void play ();
  void follow ();
  void lookOver (double turn_rad, const char* line);
  void toggle (bool& is_on, const std::string& what);
  void toggleLines ();
  void toggleHelp ();
  void toggleSlices ();
  void chooseSlice (int axis);
  void moveSlice (double step);
  void nextSurface ();
  void nextColour ();
  void nextObject ();
  void saveViewpoint ();
  void loadViewpoint ();
  void savePicture ();
  /** \brief Look from there; nothing: follow the camera. */
  void look (const std::optional<Viewpoint>& viewpoint);
  /** \brief From where it is looked at now. */
  Viewpoint viewpoint () const;
  /** \brief Stand where the camera of the run is. */
  void followCamera ();
  /** \brief Show the frame as everything is set now. */
  void draw ();
  double stamp () const { return stamps_[frame_]; }
  /** \brief Call RunWindowOptions::said with a line, and show it in the window if \a message. */
  void say (const std::string& line, bool message);

  RunWindowOptions options_;
  std::unique_ptr<RunScene> scene_;
  std::vector<double> stamps_;
  std::size_t frame_ = 0;
  bool playing_ = false, help_ = false;
  SliceChoice slices_;
  int chosen_axis_ = 0;
  std::unique_ptr<FramePointReader> reader_;
  std::shared_ptr<const FramePoints> points_;
  std::size_t frame_of_points_ = 0;

  vtkSmartPointer<vtkRenderWindow> window_;
  vtkSmartPointer<vtkRenderer> renderer_;
  vtkSmartPointer<vtkRenderWindowInteractor> interactor_;
  vtkSmartPointer<vtkSliderWidget> slider_;
  vtkNew<vtkSliderRepresentation2D> bar_;
  std::unique_ptr<WindowScene> actors_;
  std::unique_ptr<WindowOverlay> overlay_;
  std::vector<vtkSmartPointer<vtkCommand>> commands_;
  std::chrono::steady_clock::time_point last_step_, last_look_, message_time_;
};

} // namespace pcl::cosection
