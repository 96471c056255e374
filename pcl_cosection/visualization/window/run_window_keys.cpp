// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
// What the keys of the window do.
#include "run_window_impl.h"

#include "pcl_cosection/rendering/picture.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr std::size_t far_frames = 10;
constexpr double slice_step = 0.02; ///< of the box
constexpr int surfaces = 3, colours = 5;

std::string
onOff (bool is_on)
{
  return is_on ? " on" : " off";
}

} // namespace

std::string
RunWindow::Impl::helpText ()
{
  static const std::vector<std::pair<std::string, std::string>> help = {
      {"space", "play, pause"},
      {"left, right", "one frame back, on"},
      {"page up, down", "ten frames back, on"},
      {"Home, End, 0-9", "first, last frame, tenths of the run"},
      {"m", "surfaces: completed, as seen, points of the frame"},
      {"c", "colours: real, instance, provenance, confidence, error"},
      {"mouse", "left: turn, middle: shift, right or wheel: zoom"},
      {"f", "follow the camera, or let go of it"},
      {"o, b", "overview, the same from behind"},
      {"v, l", "save the viewpoint, load it"},
      {"g", "background"},
      {"k", "bounding volumes"},
      {"t", "path of the camera and what it sees"},
      {"s", "slices of the signed distance of an object"},
      {"Tab", "the next object"},
      {"x, y, z", "one of the slices: hide it, or choose it again"},
      {"up, down", "move the chosen slice"},
      {"p", "save a picture of the window"},
      {"h", "this help"},
      {"q, Escape", "close the window"}};
  std::size_t width = 0;
  for (const auto& [keys, meaning] : help)
    width = std::max (width, keys.size ());
  std::string text;
  for (const auto& [keys, meaning] : help)
    text += (text.empty () ? " " : "\n ") + keys + std::string (width + 2 - keys.size (), ' ') + meaning + " ";
  return text;
}

void
RunWindow::Impl::press (const std::string& key)
{
  if (key.size () == 1 && std::isdigit (static_cast<unsigned char> (key[0])))
    return goTo (static_cast<std::size_t> (key[0] - '0') * (stamps_.size () - 1) / 10);
  using Actions = std::map<std::string, std::function<void (Impl&)>>; // by the name that X gives a key
  static const Actions actions = {
      {"space", &Impl::play},
      {"Right", [] (Impl& w) { w.goTo (w.frame_ + 1); }},
      {"Left", [] (Impl& w) { w.goTo (w.frame_ - std::min<std::size_t> (w.frame_, 1)); }},
      {"Next", [] (Impl& w) { w.goTo (w.frame_ + far_frames); }},                       // page down
      {"Prior", [] (Impl& w) { w.goTo (w.frame_ - std::min (w.frame_, far_frames)); }}, // page up
      {"Home", [] (Impl& w) { w.goTo (0); }},
      {"End", [] (Impl& w) { w.goTo (w.stamps_.size () - 1); }},
      {"m", &Impl::nextSurface},
      {"c", &Impl::nextColour},
      {"p", &Impl::savePicture},
      {"q", [] (Impl& w) { w.interactor_->TerminateApp (); }},
      {"Escape", [] (Impl& w) { w.interactor_->TerminateApp (); }}};
  // After these, everything is drawn anew.
  static const Actions settings = {{"f", &Impl::follow},
                                   {"o", [] (Impl& w) { w.lookOver (0.0, "view from above"); }},
                                   {"b", [] (Impl& w) { w.lookOver (M_PI, "view from behind"); }},
                                   {"v", &Impl::saveViewpoint},
                                   {"l", &Impl::loadViewpoint},
                                   {"g", [] (Impl& w) { w.toggle (w.options_.view.background, "background"); }},
                                   {"k", [] (Impl& w) { w.toggle (w.options_.view.boxes, "boxes"); }},
                                   {"t", &Impl::toggleLines},
                                   {"h", &Impl::toggleHelp},
                                   {"Tab", &Impl::nextObject},
                                   {"s", &Impl::toggleSlices},
                                   {"x", [] (Impl& w) { w.chooseSlice (0); }},
                                   {"y", [] (Impl& w) { w.chooseSlice (1); }},
                                   {"z", [] (Impl& w) { w.chooseSlice (2); }},
                                   {"Up", [] (Impl& w) { w.moveSlice (slice_step); }},
                                   {"Down", [] (Impl& w) { w.moveSlice (-slice_step); }}};
  if (const auto action = actions.find (key); action != actions.end ())
    action->second (*this);
  if (const auto setting = settings.find (key); setting != settings.end ())
  {
    setting->second (*this);
    draw ();
  }
}

void
RunWindow::Impl::play ()
{
  playing_ = !playing_;
  if (playing_ && frame_ + 1 == stamps_.size ())
    goTo (0);
  last_step_ = std::chrono::steady_clock::now ();
  say (playing_ ? "play" : "play paused", false);
}

void
RunWindow::Impl::follow ()
{
  look (options_.view.viewpoint ? std::nullopt : std::optional<Viewpoint> (viewpoint ()));
  say (options_.view.viewpoint ? "view is free" : "view follows the camera", true);
}

void
RunWindow::Impl::lookOver (double turn_rad, const char* line)
{
  look (overview (*scene_, turn_rad));
  say (line, true);
}

void
RunWindow::Impl::toggle (bool& is_on, const std::string& what)
{
  is_on = !is_on;
  say (what + onOff (is_on), false);
}

void
RunWindow::Impl::toggleLines ()
{
  SceneView& view = options_.view;
  view.path = view.path || view.frustum;
  toggle (view.path, "path");
  view.frustum = view.path;
}

void
RunWindow::Impl::toggleHelp ()
{
  toggle (help_, "help");
  overlay_->showHelp (help_);
}

void
RunWindow::Impl::toggleSlices ()
{
  slices_.shown = !slices_.shown;
  say ("slices" + onOff (slices_.shown) + (slices_.shown ? " of object " + std::to_string (slices_.object) : ""), true);
}

void
RunWindow::Impl::chooseSlice (int axis)
{
  bool& is_shown = slices_.axes[static_cast<std::size_t> (axis)];
  is_shown = !is_shown || chosen_axis_ != axis; // the first time, it is only chosen
  chosen_axis_ = axis;
  say ("slices across " + std::string (1, "xyz"[axis]) + onOff (is_shown), true);
}

void
RunWindow::Impl::moveSlice (double step)
{
  double& share = slices_.shares[static_cast<std::size_t> (chosen_axis_)];
  share = std::clamp (share + step, 0.0, 1.0);
  say ("slices across " + std::string (1, "xyz"[chosen_axis_]) + " at " + std::to_string (std::lround (100.0 * share)) +
           " %",
       true);
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
