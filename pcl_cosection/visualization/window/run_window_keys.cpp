// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// What the keys of the window do.

#include "run_window_impl.h"

#include "pcl_cosection/rendering/picture.h"
#include "pcl_cosection/visualization/scene_caption.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace pcl::cosection {
namespace {

constexpr std::size_t far_frames = 10;
constexpr double slice_step = 0.02; ///< of the box
constexpr int surfaces = 3, colours = 5;

const char*
onOff (bool is_on)
{
  return is_on ? "on" : "off";
}

} // namespace

void
RunWindow::Impl::press (const std::string& key)
{
  if (key.size () == 1 && std::isdigit (static_cast<unsigned char> (key[0])))
    return goTo (static_cast<std::size_t> (key[0] - '0') * (stamps_.size () - 1) / 10);
  if (const std::optional<WindowAction> action = actionOf (key))
    perform (*action);
}

void
RunWindow::Impl::perform (WindowAction action)
{
  switch (action)
  {
  case WindowAction::Play:
    playing_ = !playing_;
    if (playing_ && frame_ + 1 == stamps_.size ())
      goTo (0);
    last_step_ = std::chrono::steady_clock::now ();
    return say (playing_ ? "play" : "play paused", false);
  case WindowAction::Forward:
    return goTo (frame_ + 1);
  case WindowAction::Back:
    return goTo (frame_ - std::min<std::size_t> (frame_, 1));
  case WindowAction::FarForward:
    return goTo (frame_ + far_frames);
  case WindowAction::FarBack:
    return goTo (frame_ - std::min (frame_, far_frames));
  case WindowAction::First:
    return goTo (0);
  case WindowAction::Last:
    return goTo (stamps_.size () - 1);
  case WindowAction::NextSurface:
    return nextSurface ();
  case WindowAction::NextColour:
    return nextColour ();
  case WindowAction::SavePicture:
    return savePicture ();
  case WindowAction::Help:
    help_ = !help_;
    overlay_->showHelp (help_);
    say (std::string ("help ") + onOff (help_), false);
    return draw ();
  case WindowAction::Quit:
    return interactor_->TerminateApp ();
  case WindowAction::NextObject:
  case WindowAction::Slices:
  case WindowAction::SliceX:
  case WindowAction::SliceY:
  case WindowAction::SliceZ:
  case WindowAction::SliceForward:
  case WindowAction::SliceBack:
    return performSlices (action);
  default:
    return performView (action);
  }
}

void
RunWindow::Impl::performView (WindowAction action)
{
  SceneView& view = options_.view;
  switch (action)
  {
  case WindowAction::Follow:
    look (view.viewpoint ? std::nullopt : std::optional<Viewpoint> (viewpoint ()));
    say (view.viewpoint ? "view is free" : "view follows the camera", true);
    break;
  case WindowAction::Overview:
  case WindowAction::Behind:
    look (overview (*scene_, action == WindowAction::Behind ? M_PI : 0.0));
    say (action == WindowAction::Behind ? "view from behind" : "view from above", true);
    break;
  case WindowAction::SaveViewpoint:
    saveViewpoint ();
    break;
  case WindowAction::LoadViewpoint:
    loadViewpoint ();
    break;
  case WindowAction::Background:
    view.background = !view.background;
    say (std::string ("background ") + onOff (view.background), false);
    break;
  case WindowAction::Boxes:
    view.boxes = !view.boxes;
    say (std::string ("boxes ") + onOff (view.boxes), false);
    break;
  case WindowAction::Lines:
    view.path = view.frustum = !(view.path || view.frustum);
    say (std::string ("path ") + onOff (view.path), false);
    break;
  default:
    break;
  }
  draw ();
}

void
RunWindow::Impl::performSlices (WindowAction action)
{
  switch (action)
  {
  case WindowAction::NextObject:
    nextObject ();
    break;
  case WindowAction::Slices:
    slices_.shown = !slices_.shown;
    say (std::string ("slices ") + onOff (slices_.shown) +
             (slices_.shown ? " of object " + std::to_string (slices_.object) : ""),
         true);
    break;
  case WindowAction::SliceX:
  case WindowAction::SliceY:
  case WindowAction::SliceZ:
  {
    const int axis = action == WindowAction::SliceX ? 0 : action == WindowAction::SliceY ? 1 : 2;
    bool& is_shown = slices_.axes[static_cast<std::size_t> (axis)];
    is_shown = !is_shown || chosen_axis_ != axis; // the first time, it is only chosen
    chosen_axis_ = axis;
    say ("slices across " + std::string (1, "xyz"[axis]) + " " + onOff (is_shown), true);
    break;
  }
  default:
  {
    double& share = slices_.shares[static_cast<std::size_t> (chosen_axis_)];
    share = std::clamp (share + (action == WindowAction::SliceForward ? slice_step : -slice_step), 0.0, 1.0);
    say ("slices across " + std::string (1, "xyz"[chosen_axis_]) + " at " +
             std::to_string (std::lround (100.0 * share)) + " %",
         true);
    break;
  }
  }
  draw ();
}

void
RunWindow::Impl::nextSurface ()
{
  SurfaceMode& surface = options_.view.surface;
  surface = static_cast<SurfaceMode> ((static_cast<int> (surface) + 1) % surfaces);
  std::string problem;
  if (surface == SurfaceMode::Points && !reader_)
  {
    try
    {
      reader_ = std::make_unique<FramePointReader> (*scene_, options_.dataset);
    }
    catch (const Error& error)
    {
      problem = error.what ();
      surface = SurfaceMode::Completed;
    }
  }
  draw ();
  say ("surfaces " + surfaceNames ()[static_cast<std::size_t> (surface)] + (problem.empty () ? "" : "; " + problem),
       !problem.empty ());
  if (!problem.empty ())
    window_->Render ();
}

void
RunWindow::Impl::nextColour ()
{
  ColourMode& colour = options_.view.colour;
  colour = static_cast<ColourMode> ((static_cast<int> (colour) + 1) % colours);
  if (colour == ColourMode::Error && scene_->errors.empty ())
    colour = ColourMode::Real;
  draw ();
  say ("colours " + colourNames ()[static_cast<std::size_t> (colour)], false);
}

void
RunWindow::Impl::nextObject ()
{
  std::vector<int> ids;
  for (const SceneRecord::Object& object : scene_->run.objects)
    if (!object.mesh.empty ())
      ids.push_back (object.id);
  if (ids.empty ())
    return;
  const auto next = std::upper_bound (ids.begin (), ids.end (), slices_.object);
  slices_.object = next == ids.end () ? ids.front () : *next;
  say ("object " + std::to_string (slices_.object), true);
}

void
RunWindow::Impl::saveViewpoint ()
{
  if (options_.viewpoint_file.empty ())
    return say ("the viewpoint is not saved: this folder is the run's, which stays as it is", true);
  try
  {
    cosection::saveViewpoint (viewpoint (), options_.viewpoint_file);
    say ("wrote " + options_.viewpoint_file, true);
  }
  catch (const Error& error)
  {
    say (error.what (), true);
  }
}

void
RunWindow::Impl::loadViewpoint ()
{
  try
  {
    look (cosection::loadViewpoint (options_.viewpoint_file));
    say ("view of " + options_.viewpoint_file, true);
  }
  catch (const Error& error)
  {
    say (error.what (), true);
  }
}

void
RunWindow::Impl::savePicture ()
{
  if (options_.picture_prefix.empty ())
    return say ("no picture is saved: this folder is the run's, which stays as it is", true);
  std::string path;
  std::error_code ignored;
  for (int number = 1; path.empty () || std::filesystem::exists (path, ignored); ++number)
  {
    std::array<char, 16> digits;
    std::snprintf (digits.data (), digits.size (), "%04d", number);
    path = options_.picture_prefix + digits.data () + ".png";
  }
  try
  {
    overlay_->setMessage ("");
    draw ();
    writePng (picture (), path);
    say ("wrote " + path, true);
  }
  catch (const Error& error)
  {
    say (error.what (), true);
  }
  draw ();
}

} // namespace pcl::cosection
