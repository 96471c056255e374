// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/fusion/co_section_backend.h>

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <limits>
#include <string>
#include <system_error>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr double turn_radius_m = 1.0; // a turn by 1 rad counts as a way of this length

std::vector<OrientedPoint>
transformed (const std::vector<OrientedPoint>& points, const Eigen::Isometry3d& T)
{
  std::vector<OrientedPoint> result (points);
  for (OrientedPoint& point : result)
  {
    point.position = (T * point.position.cast<double> ()).cast<float> ();
    point.normal = (T.linear () * point.normal.cast<double> ()).cast<float> ();
  }
  return result;
}

/** \brief T_body_sensor of the world (id 0) and of the objects. \throws InvalidArgument if a pose is not finite */
std::map<int, Eigen::Isometry3d>
relativeTo (const CoSectionBackend::Poses& T_world_object, const Eigen::Isometry3d& T_world_sensor)
{
  std::map<int, Eigen::Isometry3d> T_body_sensor{{0, T_world_sensor}};
  for (const auto& [id, T] : T_world_object)
  {
    if (!T.matrix ().allFinite ())
      throw InvalidArgument ("the pose of object " + std::to_string (id) + " is not finite");
    T_body_sensor[id] = T.inverse () * T_world_sensor;
  }
  return T_body_sensor;
}

} // namespace

void
BackendOptions::validate () const
{
  method.validate ();
  if (max_views < 4)
    throw InvalidArgument ("max_views must be at least 4");
  if (max_keyframes < 2)
    throw InvalidArgument ("max_keyframes must be at least 2");
}

CoSectionBackend::CoSectionBackend (const BackendOptions& options) : options_ (options), scene_ (options.method)
{
  options.validate ();
}

double
CoSectionBackend::gap (const KeptView& a, const KeptView& b)
{
  double largest = 0.0;
  for (const auto& [id, T_a] : a.T_body_sensor)
  {
    const auto other = b.T_body_sensor.find (id);
    if (other == b.T_body_sensor.end ())
      return std::numeric_limits<double>::infinity (); // only one of them observes this object
    const Eigen::Isometry3d motion = T_a.inverse () * other->second;
    largest = std::max (largest,
                        motion.translation ().norm () + turn_radius_m * Eigen::AngleAxisd (motion.linear ()).angle ());
  }
  return largest;
}

void
CoSectionBackend::thin (bool keyframes)
{
  const std::size_t views = kept_.size ();
  std::vector<std::vector<double>> gaps (views, std::vector<double> (views, std::numeric_limits<double>::infinity ()));
  std::size_t candidates = 0;
  for (std::size_t a = 0; a < views; ++a)
  {
    candidates += kept_[a].keyframe == keyframes;
    for (std::size_t b = 0; b < views; ++b)
      if (a != b)
        gaps[a][b] = gap (kept_[a], kept_[b]); // what a observes and b does not
  }
  // One by one, the view nearest to another is removed; the latest of equals.
  std::vector<bool> remove (views, false);
  for (std::size_t n = 0; n < (candidates + 1) / 2; ++n)
  {
    std::size_t worst = views;
    double worst_gap = std::numeric_limits<double>::infinity ();
    for (std::size_t a = 0; a < views; ++a)
    {
      if (remove[a] || kept_[a].keyframe != keyframes)
        continue;
      double nearest = std::numeric_limits<double>::infinity ();
      for (std::size_t b = 0; b < views; ++b)
        if (!remove[b] && (kept_[b].keyframe || !keyframes))
          nearest = std::min (nearest, gaps[a][b]);
      if (worst == views || nearest <= worst_gap)
      {
        worst = a;
        worst_gap = nearest;
      }
    }
    remove[worst] = true;
    if (std::isfinite (worst_gap))
      least_gap_m_ = std::max (least_gap_m_, worst_gap);
  }
  scene_.removeViews (remove);
  std::vector<KeptView> remaining;
  for (std::size_t v = 0; v < views; ++v)
    if (!remove[v])
      remaining.push_back (std::move (kept_[v]));
  kept_ = std::move (remaining);
}

bool
CoSectionBackend::reserve (KeptView view)
{
  if (least_gap_m_ >= 0.0)
    for (const KeptView& kept : kept_)
      if ((kept.keyframe || !view.keyframe) && gap (view, kept) <= least_gap_m_)
        return false;
  if (view.keyframe && keyframes () >= options_.max_keyframes)
    thin (true);
  if (kept_.size () >= options_.max_views)
    thin (kept_.size () == keyframes ());
  kept_.push_back (std::move (view));
  return true;
}

std::size_t
CoSectionBackend::keyframes () const
{
  return static_cast<std::size_t> (
      std::count_if (kept_.begin (), kept_.end (), [] (const KeptView& view) { return view.keyframe; }));
}

bool
CoSectionBackend::addFrame (DepthView view, const Poses& T_world_object)
{
  view.validate ();
  if (!reserve ({relativeTo (T_world_object, view.T_world_sensor), false}))
    return false;
  scene_.addView (std::move (view), T_world_object, ViewUse::FreeSpace);
  return true;
}

bool
CoSectionBackend::addKeyframe (const Keyframe& keyframe, const Poses& T_world_object)
{
  keyframe.view.validate ();
  const Eigen::Isometry3d& T_world_sensor = keyframe.view.T_world_sensor;
  KeptView place{relativeTo (T_world_object, T_world_sensor), true};
  if (!keyframe.points.empty () && keyframe.points.begin ()->first < 0)
    throw InvalidArgument ("the id of an object is " + std::to_string (keyframe.points.begin ()->first) +
                           "; it must be positive");
  if (!reserve (std::move (place)))
    return false;
  scene_.addView (keyframe.view, T_world_object, ViewUse::Full);
  for (const auto& [id, points] : keyframe.points)
  {
    const auto pose = T_world_object.find (id);
    if (id == 0)
      scene_.addBackground (transformed (points, T_world_sensor));
    else if (pose != T_world_object.end ())
      scene_.addPoints (id, transformed (points, pose->second.inverse () * T_world_sensor));
  }
  return true;
}

void
CoSectionBackend::removeObject (int id)
{
  scene_.removeObject (id);
  if (id != 0)
    for (KeptView& view : kept_)
      view.T_body_sensor.erase (id);
}

SceneResult
CoSectionBackend::update (UpdateOutput output, const ProgressCallback& progress)
{
  return scene_.update (output, progress);
}

SceneResult
CoSectionBackend::solve (const ProgressCallback& progress) const
{
  return scene_.reconstruct (progress);
}

BackendThread::BackendThread (CoSectionBackend& backend, UpdateOutput output) : backend_ (backend), output_ (output)
{
  try
  {
    thread_ = std::thread (&BackendThread::run, this);
  }
  catch (const std::system_error& error)
  {
    throw Error (std::string ("no thread can be started for the back end: ") + error.what ());
  }
}

BackendThread::~BackendThread ()
{
  {
    const std::lock_guard<std::mutex> lock (mutex_);
    stop_ = true;
  }
  changed_.notify_all ();
  thread_.join ();
}

void
BackendThread::addKeyframe (Keyframe keyframe, CoSectionBackend::Poses T_world_object)
{
  add ({std::move (keyframe), {}, std::move (T_world_object)});
}

void
BackendThread::addFrame (DepthView view, CoSectionBackend::Poses T_world_object)
{
  add ({std::nullopt, std::move (view), std::move (T_world_object)});
}

void
BackendThread::add (Item item)
{
  {
    const std::lock_guard<std::mutex> lock (mutex_);
    waiting_.push_back (std::move (item));
  }
  changed_.notify_all ();
}

std::vector<BackendUpdate>
BackendThread::takeUpdates ()
{
  const std::lock_guard<std::mutex> lock (mutex_);
  if (failure_)
    std::rethrow_exception (failure_);
  return std::exchange (updates_, {});
}

bool
BackendThread::wait (std::size_t views, std::chrono::milliseconds time)
{
  std::unique_lock<std::mutex> lock (mutex_);
  const bool done = changed_.wait_for (
      lock, time, [&] { return failure_ || (waiting_.size () <= views && (views > 0 || !busy_)); });
  if (failure_)
    std::rethrow_exception (failure_);
  return done;
}

void
BackendThread::run () noexcept
{
  try
  {
    work ();
  }
  catch (...)
  {
    const std::lock_guard<std::mutex> lock (mutex_);
    if (!stop_)
      failure_ = std::current_exception ();
  }
  changed_.notify_all ();
}

void
BackendThread::work ()
{
  std::unique_lock<std::mutex> lock (mutex_);
  for (;;)
  {
    changed_.wait (lock, [this] { return stop_ || !waiting_.empty (); });
    if (stop_)
      return;
    std::vector<Item> items = std::exchange (waiting_, {});
    busy_ = true;
    lock.unlock ();
    changed_.notify_all (); // there is room

    std::optional<BackendUpdate> result;
    if (const std::optional<double> stamp = use (std::move (items)))
      result = update (*stamp);

    lock.lock ();
    busy_ = false;
    if (result)
      updates_.push_back (std::move (*result));
    changed_.notify_all ();
  }
}

std::optional<double>
BackendThread::use (std::vector<Item> items)
{
  std::optional<double> stamp;
  for (Item& item : items)
  {
    if (!item.keyframe)
    {
      backend_.addFrame (std::move (item.view), item.T_world_object);
      continue;
    }
    backend_.addKeyframe (*item.keyframe, item.T_world_object);
    stamp = item.keyframe->stamp;
  }
  return stamp;
}

BackendUpdate
BackendThread::update (double stamp)
{
  const auto start = std::chrono::steady_clock::now ();
  BackendUpdate result;
  result.stamp = stamp;
  result.scene = backend_.update (output_, [this] (const std::string&, double) { return !stop_; });
  result.seconds = std::chrono::duration<double> (std::chrono::steady_clock::now () - start).count ();
  return result;
}

} // namespace pcl::cosection
