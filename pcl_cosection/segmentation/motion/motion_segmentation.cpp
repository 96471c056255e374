// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/segmentation/motion_segmentation.h>

#include "motion_search.h"
#include "pcl_cosection/common/console_errors.h"
#include "pcl_cosection/common/require.h"

#include <pcl/impl/pcl_base.hpp>
#include <pcl/point_types.h>

#include <algorithm>
#include <deque>
#include <optional>
#include <string>

namespace pcl::cosection {
namespace {

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
  require (isPositive (significance), "motion segmentation: significance must be positive and finite");
  require (isPositive (max_object_size_m), "motion segmentation: max_object_size_m must be positive and finite");
  require (concave_angle_rad > 0.0 && concave_angle_rad < 1.58,
           "motion segmentation: concave_angle_rad must be between 0 and pi / 2");
}

void
MotionFrame::validate () const
{
  camera.validate ();
  const std::size_t pixels = static_cast<std::size_t> (camera.width) * camera.height;
  requireImage ("motion segmentation", points.size (), camera.width, camera.height);
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
  std::vector<MotionView*> earlierViews ()
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

  MotionSegmentationOptions options;
  std::deque<MotionView> views;
  MotionFrame last;       // in full
  std::uint32_t next = 1; // number of a body that is found
};

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
  now.found = earlier.empty () ? now.bodies : findMovingBodies (now, earlier, impl.options, impl.next);
  result.labels = enlarged (now.found, now, impl.last);
  return result;
}

bool
MotionSegmentationBase::setOptions (const MotionSegmentationOptions& options)
{
  return reportErrors ("cosection::MotionSegmentation::setOptions", [&] {
    finder_ = MovingBodyFinder (options);
    options_ = options;
  });
}

bool
MotionSegmentationBase::setNumberOfThreads (unsigned int threads)
{
  MotionSegmentationOptions options = options_;
  options.threads = static_cast<int> (threads);
  return setOptions (options);
}

void
MotionSegmentationBase::reportMissingInput () const
{
  PCL_ERROR ("[pcl::cosection::MotionSegmentation::add] There is no input cloud.\n");
}

bool
MotionSegmentationBase::addPoints (std::vector<Eigen::Vector3f> points, unsigned int width, unsigned int height,
                                   const Eigen::Isometry3d& T_world_sensor)
{
  return reportErrors ("cosection::MotionSegmentation::add", [&] {
    if (height <= 1)
      throw InvalidArgument ("the input cloud is not organised: its height is " + std::to_string (height));
    MotionFrame frame;
    const std::optional<PinholeCamera> camera = camera_ ? camera_
                                                        : fitPinholeCamera (points, static_cast<int> (width),
                                                                            static_cast<int> (height));
    if (!camera)
      throw InvalidArgument ("the input cloud has hardly any readings, or is not the image of a pinhole camera");
    frame.points = std::move (points);
    frame.camera = *camera;
    frame.T_world_sensor = T_world_sensor_ ? *T_world_sensor_ : T_world_sensor;
    frame.bodies = bodies_;
    frame.T_world_body = T_world_body_;
    frame.expected_depth = expected_depth_;
    finder_.add (frame);
  });
}

void
MotionSegmentationBase::segmentLast (const pcl::PCLHeader& header, unsigned int width, unsigned int height,
                                     pcl::PointCloud<pcl::Label>& labels, std::vector<pcl::PointIndices>& label_indices)
{
  const MotionSegments found = finder_.segment ();
  labels.header = header;
  labels.resize (found.labels.size ());
  labels.width = width;
  labels.height = height;
  for (std::size_t i = 0; i < found.labels.size (); ++i)
  {
    const std::uint32_t label = labels[i].label = found.labels[i];
    if (label == 0 || label == MotionSegments::unexplained)
      continue;
    if (label > label_indices.size ())
      label_indices.resize (label);
    label_indices[label - 1].indices.push_back (static_cast<pcl::index_t> (i));
  }
  for (pcl::PointIndices& indices : label_indices)
    indices.header = header;
}

} // namespace pcl::cosection

BOOST_PP_SEQ_FOR_EACH (PCL_COSECTION_TEMPLATE, pcl::cosection::MotionSegmentation, PCL_COSECTION_XYZ_POINT_TYPES)
