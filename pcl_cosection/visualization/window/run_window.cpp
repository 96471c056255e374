// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/visualization/run_window.h>

#include "run_window_impl.h"

#include <pcl/cosection/common/error.h>

#include <utility>

namespace pcl::cosection {

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
