// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/segmentation/motion_segmentation.h>

#include "motion_search.h"
#include "motion_view.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace pcl::cosection {
namespace {

void
require (bool good, const std::string& message)
{
  if (!good)
    throw InvalidArgument (message);
}

bool
isRigid (const Eigen::Isometry3d& T)
{
  return T.matrix ().allFinite () &&
         (T.linear () * T.linear ().transpose () - Eigen::Matrix3d::Identity ()).norm () < 1e-3 &&
         T.linear ().determinant () > 0.0;
}

} // namespace

void
MotionSegmentationOptions::validate () const
{
  require (window >= 1, "motion segmentation: window must be at least 1");
  require (min_pixels >= 1, "motion segmentation: min_pixels must be at least 1");
  require (std::isfinite (significance) && significance > 0.0,
           "motion segmentation: significance must be positive and finite");
  require (std::isfinite (max_object_size_m) && max_object_size_m > 0.0,
           "motion segmentation: max_object_size_m must be positive and finite");
  require (concave_angle_rad > 0.0 && concave_angle_rad < 1.58,
           "motion segmentation: concave_angle_rad must be between 0 and pi / 2");
}

void
MotionFrame::validate () const
{
  camera.validate ();
  const std::size_t pixels = static_cast<std::size_t> (camera.width) * camera.height;
  require (points.size () == pixels, "motion segmentation: " + std::to_string (points.size ()) +
                                         " points do not fill an image of " + std::to_string (camera.width) + " x " +
                                         std::to_string (camera.height));
  require (bodies.empty () || bodies.size () == pixels,
           "motion segmentation: there must be a body for each pixel, or none");
  require (expected_depth.empty () || expected_depth.size () == pixels,
           "motion segmentation: there must be an expected depth for each pixel, or none");
  require (isRigid (T_world_sensor), "motion segmentation: the sensor's pose is not a finite rigid motion");
  for (const auto& [body, T] : T_world_body)
    require (isRigid (T),
             "motion segmentation: the pose of body " + std::to_string (body) + " is not a finite rigid motion");
  require (std::any_of (points.begin (), points.end (),
                        [] (const Eigen::Vector3f& p) { return p.allFinite () && p.z () > 0.0f; }),
           "motion segmentation: there are no readings");
}

struct MovingBodyFinder::Impl
{
  explicit Impl (const MotionSegmentationOptions& options) : options (options) { options.validate (); }

  /** \brief Earlier views that the last one is compared with, the youngest first: at ages of 1, 2, 4 ...
   * frames, the oldest, and the last one in which bodies were searched. */
  std::vector<MotionView*> earlierViews ();

  MotionSegmentationOptions options;
  std::deque<MotionView> views;
  MotionFrame last;       // in full
  std::uint32_t next = 1; // number of a body that is found
  std::size_t frames = 0;
};

std::vector<MotionView*>
MovingBodyFinder::Impl::earlierViews ()
{
  const int oldest = static_cast<int> (views.size ()) - 1;
  int searched = 0; // age of the last view in which bodies were searched: they keep their numbers
  for (int age = oldest; age > 0; --age)
    if (!views[oldest - age].found.empty ())
      searched = age;
  std::vector<MotionView*> earlier;
  for (int age = 1, doubled = 1; age <= oldest; ++age)
  {
    if (age == doubled || age == searched || age == oldest)
      earlier.push_back (&views[oldest - age]);
    doubled = age == doubled ? 2 * doubled : doubled;
  }
  return earlier;
}

MovingBodyFinder::MovingBodyFinder (const MotionSegmentationOptions& options) : impl_ (std::make_unique<Impl> (options))
{}

MovingBodyFinder::~MovingBodyFinder () = default;
MovingBodyFinder::MovingBodyFinder (MovingBodyFinder&& other) noexcept = default;
MovingBodyFinder& MovingBodyFinder::operator= (MovingBodyFinder&& other) noexcept = default;

void
MovingBodyFinder::reset ()
{
  impl_ = std::make_unique<Impl> (impl_->options);
}

void
MovingBodyFinder::add (const MotionFrame& frame)
{
  frame.validate ();
  if (!impl_->views.empty ())
  {
    const PinholeCamera& camera = impl_->last.camera;
    require (frame.camera.width == camera.width && frame.camera.height == camera.height,
             "motion segmentation: the frame is not of the size of those before");
  }
  impl_->last = frame;
  impl_->views.push_back (makeMotionView (frame));
  impl_->views.back ().index = impl_->frames++;
  while (static_cast<int> (impl_->views.size ()) > impl_->options.window + 1)
    impl_->views.pop_front ();
  for (const std::uint32_t body : impl_->views.back ().bodies)
    if (body != MotionSegments::unexplained)
      impl_->next = std::max (impl_->next, body + 1);
}

MotionSegments
MovingBodyFinder::segment ()
{
  Impl& impl = *impl_;
  MotionSegments result;
  if (impl.views.empty ())
    return result;
  MotionView& now = impl.views.back ();
  analyse (now, impl.options);
  std::vector<const MotionView*> earlier;
  for (MotionView* view : impl.earlierViews ())
  {
    analyse (*view, impl.options);
    earlier.push_back (view);
  }
  std::optional<MotionView> expected;
  if (!impl.last.expected_depth.empty ())
  {
    MotionFrame model = impl.last;
    for (std::size_t n = 0; n < model.points.size (); ++n)
      model.points[n] = model.camera
                            .unproject (static_cast<double> (n % model.camera.width),
                                        static_cast<double> (n / model.camera.width), model.expected_depth[n])
                            .cast<float> ();
    expected = makeMotionView (model);
    analyse (*expected, impl.options);
    earlier.push_back (&*expected);
  }
  now.found = earlier.empty () ? now.bodies : MotionSearch (now, earlier, impl.options).run (impl.next);
  result.labels = enlarged (now.found, now, impl.last);
  return result;
}

} // namespace pcl::cosection
