// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/visualization/run_window.h>

#include "run_window_impl.h"

#include <pcl/cosection/common/error.h>

#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkImageData.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkProperty2D.h>
#include <vtkTextProperty.h>
#include <vtkWindowToImageFilter.h>

#include <X11/Xlib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr int timer_ms = 10;
constexpr std::chrono::milliseconds look_every (200);
constexpr std::chrono::seconds message_stays (4);
constexpr std::array<double, 3> paper = {246 / 255.0, 247 / 255.0, 249 / 255.0}; // as in drawScene ()

/** \brief The mouse turns, shifts and zooms; VTK's keys do nothing. */
class MouseStyle : public vtkInteractorStyleTrackballCamera
{
public:
  static MouseStyle* New ();
  vtkTypeMacro (MouseStyle, vtkInteractorStyleTrackballCamera);

  void OnChar () override {}
};
vtkStandardNewMacro (MouseStyle);

/** \brief Calls a function. */
class FunctionCommand : public vtkCommand
{
public:
  static FunctionCommand* New ();

  void Execute (vtkObject* /*caller*/, unsigned long /*event*/, void* /*data*/) override { function (); }

  std::function<void ()> function;
};
vtkStandardNewMacro (FunctionCommand);

} // namespace

RunWindow::Impl::Impl (RunScene scene, const RunWindowOptions& options)
    : options_ (options)
    , scene_ (std::make_unique<RunScene> (std::move (scene)))
    , stamps_ (scene_->stamps ())
    , frame_ (std::min (options.first_frame, stamps_.size () - 1))
    , window_ (vtkSmartPointer<vtkRenderWindow>::New ())
    , renderer_ (vtkSmartPointer<vtkRenderer>::New ())
    , interactor_ (vtkSmartPointer<vtkRenderWindowInteractor>::New ())
{
  renderer_->SetBackground (paper[0], paper[1], paper[2]);
  window_->SetMultiSamples (0); // slow without a graphics card
  window_->SetSize (options.view.width, options.view.height);
  window_->SetWindowName (options.title.c_str ());
  window_->AddRenderer (renderer_);
  interactor_->SetRenderWindow (window_);
  vtkNew<MouseStyle> style;
  interactor_->SetInteractorStyle (style);
  style->SetDefaultRenderer (renderer_);
  actors_ = std::make_unique<WindowScene> (*renderer_);
  actors_->setScene (*scene_);
  overlay_ = std::make_unique<WindowOverlay> (*renderer_, helpText ());
  interactor_->Initialize ();
  makeSlider ();
  observe ();
  nextObject ();
  if (options_.view.surface == SurfaceMode::Points)
    reader_ = std::make_unique<FramePointReader> (*scene_, options_.dataset);
  look (options_.view.viewpoint);
  say ("h: help", true);
  draw ();
}

RunWindow::Impl::~Impl ()
{
  slider_->Off ();
  window_->Finalize ();
}

void
RunWindow::Impl::makeSlider ()
{
  bar_->SetMinimumValue (1.0);
  bar_->SetMaximumValue (static_cast<double> (std::max<std::size_t> (2, stamps_.size ())));
  bar_->SetValue (static_cast<double> (frame_ + 1));
  bar_->GetPoint1Coordinate ()->SetCoordinateSystemToNormalizedDisplay ();
  bar_->GetPoint1Coordinate ()->SetValue (0.03, 0.045);
  bar_->GetPoint2Coordinate ()->SetCoordinateSystemToNormalizedDisplay ();
  bar_->GetPoint2Coordinate ()->SetValue (0.97, 0.045);
  bar_->SetSliderLength (0.012);
  bar_->SetSliderWidth (0.03);
  bar_->SetTubeWidth (0.006);
  bar_->SetEndCapLength (0.0);
  bar_->ShowSliderLabelOff ();
  bar_->GetSliderProperty ()->SetColor (0.12, 0.35, 0.78);
  bar_->GetSelectedProperty ()->SetColor (0.08, 0.22, 0.5);
  bar_->GetTubeProperty ()->SetColor (0.7, 0.72, 0.76);
  slider_ = vtkSmartPointer<vtkSliderWidget>::New ();
  slider_->SetInteractor (interactor_);
  slider_->SetRepresentation (bar_);
  slider_->SetAnimationModeToJump ();
  slider_->On ();
}

void
RunWindow::Impl::observe ()
{
  const auto on = [this] (vtkObject& object, unsigned long event, std::function<void ()> function) {
    vtkSmartPointer<FunctionCommand> command = vtkSmartPointer<FunctionCommand>::New ();
    command->function = std::move (function);
    commands_.push_back (command);
    object.AddObserver (event, command);
  };
  on (*interactor_, vtkCommand::KeyPressEvent, [this] {
    if (const char* key = interactor_->GetKeySym ())
      press (key);
  });
  on (*interactor_, vtkCommand::TimerEvent, [this] { onTimer (); });
  on (*interactor_, vtkCommand::ExitEvent, [this] { interactor_->TerminateApp (); });
  on (*interactor_->GetInteractorStyle (), vtkCommand::StartInteractionEvent, [this] {
    if (options_.view.viewpoint)
      return;
    follow ();
    draw ();
  });
  on (*slider_, vtkCommand::InteractionEvent,
      [this] { goTo (static_cast<std::size_t> (std::lround (std::max (1.0, bar_->GetValue ()))) - 1); });
}

void
RunWindow::Impl::run ()
{
  interactor_->CreateRepeatingTimer (timer_ms);
  interactor_->Start ();
}

void
RunWindow::Impl::goTo (std::size_t frame)
{
  frame = std::min (frame, stamps_.size () - 1);
  const bool is_other = frame != frame_;
  frame_ = frame;
  draw ();
  if (is_other)
    say ("frame " + std::to_string (frame_ + 1) + " of " + std::to_string (stamps_.size ()), false);
}

void
RunWindow::Impl::onTimer ()
{
  const auto now = std::chrono::steady_clock::now ();
  if (playing_ && std::chrono::duration<double> (now - last_step_).count () >= 1.0 / options_.frames_per_second)
  {
    last_step_ = now;
    if (frame_ + 1 < stamps_.size ())
      goTo (frame_ + 1);
    else if (!options_.newScene)
      play ();
  }
  if (now - last_look_ < look_every)
    return;
  last_look_ = now;
  if (options_.stop && options_.stop ())
    return interactor_->TerminateApp ();
  if (options_.newScene)
    if (std::optional<SceneUpdate> update = options_.newScene ())
      takeScene (std::move (*update));
  if (message_time_ != std::chrono::steady_clock::time_point () && now - message_time_ > message_stays)
  {
    message_time_ = {};
    overlay_->setMessage ("");
    window_->Render ();
  }
}

void
RunWindow::Impl::takeScene (SceneUpdate update)
{
  if (update.scene.run.camera.empty ())
    return;
  const bool was_last = frame_ + 1 == stamps_.size ();
  const double shown = stamp ();
  *scene_ = std::move (update.scene);
  stamps_ = scene_->stamps ();
  frame_ = stamps_.size () - 1;
  if (!was_last)
    frame_ = std::min (frame_, static_cast<std::size_t> (std::lower_bound (stamps_.begin (), stamps_.end (), shown) -
                                                         stamps_.begin ()));
  actors_->setScene (*scene_);
  points_.reset ();
  options_.view.surface = update.surface.value_or (options_.view.surface);
  bar_->SetMaximumValue (static_cast<double> (std::max<std::size_t> (2, stamps_.size ())));
  if (slices_.object == 0)
    nextObject ();
  draw ();
  say ("frame " + std::to_string (frame_ + 1) + " of " + std::to_string (stamps_.size ()), false);
}

void
RunWindow::Impl::followCamera ()
{
  const std::optional<Eigen::Isometry3d> pose = scene_->cameraAt (stamp ());
  if (!pose)
    return;
  const int* size = window_->GetSize ();
  const PinholeCamera fitted = fittedCamera (scene_->camera (), std::max (1, size[0]), std::max (1, size[1]));
  vtkCamera* camera = renderer_->GetActiveCamera ();
  const Eigen::Vector3d eye = pose->translation (), target = *pose * Eigen::Vector3d::UnitZ (),
                        up = -pose->linear ().col (1);
  camera->SetPosition (eye.data ());
  camera->SetFocalPoint (target.data ());
  camera->SetViewUp (up.data ());
  camera->SetViewAngle (2.0 * std::atan (0.5 * fitted.height / fitted.fy) * 180.0 / M_PI);
  camera->SetWindowCenter (-2.0 * (fitted.cx - 0.5 * (fitted.width - 1)) / fitted.width,
                           2.0 * (fitted.cy - 0.5 * (fitted.height - 1)) / fitted.height);
}

void
RunWindow::Impl::look (const std::optional<Viewpoint>& viewpoint)
{
  options_.view.viewpoint = viewpoint;
  if (!viewpoint)
    return;
  vtkCamera* camera = renderer_->GetActiveCamera ();
  camera->SetWindowCenter (0.0, 0.0);
  camera->SetPosition (viewpoint->eye.data ());
  camera->SetFocalPoint (viewpoint->target.data ());
  camera->SetViewUp (viewpoint->up.data ());
  camera->SetViewAngle (viewpoint->angle_rad * 180.0 / M_PI);
}

Viewpoint
RunWindow::Impl::viewpoint () const
{
  vtkCamera* camera = renderer_->GetActiveCamera ();
  Viewpoint viewpoint;
  camera->GetPosition (viewpoint.eye.data ());
  camera->GetFocalPoint (viewpoint.target.data ());
  camera->GetViewUp (viewpoint.up.data ());
  viewpoint.angle_rad = camera->GetViewAngle () * M_PI / 180.0;
  return viewpoint;
}

void
RunWindow::Impl::draw ()
{
  SceneView& view = options_.view;
  if (!view.viewpoint)
    followCamera ();
  if (view.surface == SurfaceMode::Points && reader_ && (!points_ || frame_of_points_ != frame_))
  {
    try
    {
      points_ = std::make_shared<FramePoints> (reader_->read (*scene_, stamp ()));
    }
    catch (const Error& error)
    {
      points_ = std::make_shared<FramePoints> ();
      say (error.what (), true);
    }
    frame_of_points_ = frame_;
  }
  actors_->update (stamp (), view, slices_, points_, options_.threads);
  bar_->SetValue (static_cast<double> (frame_ + 1));
  overlay_->setCaption (view.caption ? sceneCaption (*scene_, stamp (), view.surface, view.colour) : "");
  overlay_->setLegend (view.legend && view.surface != SurfaceMode::Points ? legendOf (*scene_, view.colour)
                                                                          : ColourLegend ());
  renderer_->ResetCameraClippingRange ();
  window_->Render ();
}

Picture
RunWindow::Impl::picture ()
{
  vtkNew<vtkWindowToImageFilter> filter;
  filter->SetInput (window_);
  filter->ReadFrontBufferOff ();
  filter->SetInputBufferTypeToRGB ();
  filter->Update ();
  vtkImageData* image = filter->GetOutput ();
  const int* size = image->GetDimensions ();
  Picture picture (size[0], size[1]);
  const auto* in = static_cast<const std::uint8_t*> (image->GetScalarPointer ());
  for (int v = size[1] - 1; v >= 0; --v) // VTK's first row is the lowest
    for (int u = 0; u < size[0]; ++u, in += 3)
      picture.at (u, v) = {in[0], in[1], in[2]};
  return picture;
}

void
RunWindow::Impl::say (const std::string& line, bool message)
{
  if (options_.said)
    options_.said (line);
  if (!message)
    return;
  overlay_->setMessage (line);
  message_time_ = std::chrono::steady_clock::now ();
}

// VTK ends the process where there is no display.
std::shared_ptr<void>
requireDisplay ()
{
  const char* const name = std::getenv ("DISPLAY");
  if (name == nullptr || *name == '\0')
    throw IoError ("no window can be opened: there is no display, DISPLAY is not set");
  const std::shared_ptr<Display> display (XOpenDisplay (nullptr), [] (Display* d) {
    if (d != nullptr)
      XCloseDisplay (d);
  });
  if (!display)
    throw IoError ("no window can be opened: the display " + std::string (name) +
                   " that DISPLAY names does not answer");
  int opcode = 0, event = 0, error = 0;
  if (XQueryExtension (display.get (), "GLX", &opcode, &event, &error) == 0)
    throw IoError ("no window can be opened: the display " + std::string (name) + " has no OpenGL (GLX)");
  return display;
}

void
RunWindowOptions::validate () const
{
  constexpr double most_frames_per_second = 1000.0;
  view.validate ();
  if (!(frames_per_second > 0.0 && frames_per_second <= most_frames_per_second))
    throw InvalidArgument ("frames_per_second must be above 0, up to 1000");
  if (threads < 0)
    throw InvalidArgument ("threads must not be negative");
}

RunWindow::RunWindow (RunScene scene, const RunWindowOptions& options)
{
  options.validate ();
  if (scene.run.camera.empty ())
    throw InvalidArgument ("a scene without frames cannot be shown");
  const std::shared_ptr<void> display = requireDisplay ();
  impl_ = std::make_unique<Impl> (std::move (scene), options);
}

RunWindow::~RunWindow () = default;

void
RunWindow::run ()
{
  impl_->run ();
}

void
RunWindow::show (std::size_t frame)
{
  impl_->goTo (frame);
}

void
RunWindow::press (const std::string& key)
{
  impl_->press (key);
}

Picture
RunWindow::picture ()
{
  return impl_->picture ();
}

} // namespace pcl::cosection
