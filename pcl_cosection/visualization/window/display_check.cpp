// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include <pcl/cosection/visualization/run_window.h>

#include <pcl/cosection/common/error.h>

#include <X11/Xlib.h>

#include <cstdlib>

namespace pcl
{
namespace cosection
{

// VTK ends the process where there is no display.
void
requireDisplay ()
{
  const char* const name = std::getenv ("DISPLAY");
  if (name == nullptr || *name == '\0')
    throw IoError ("no window can be opened: there is no display, DISPLAY is not set");
  Display* const display = XOpenDisplay (nullptr);
  if (display == nullptr)
    throw IoError ("no window can be opened: the display " + std::string (name) + " that DISPLAY names does not answer");
  int opcode = 0, event = 0, error = 0;
  const bool has_opengl = XQueryExtension (display, "GLX", &opcode, &event, &error) != 0;
  XCloseDisplay (display);
  if (!has_opengl)
    throw IoError ("no window can be opened: the display " + std::string (name) + " has no OpenGL (GLX)");
}

} // namespace cosection
} // namespace pcl
