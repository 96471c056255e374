// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/visualization/run_window.h>

#include <pcl/cosection/common/error.h>

#include <X11/Xlib.h>

#include <cstdlib>

namespace pcl::cosection {

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

} // namespace pcl::cosection
