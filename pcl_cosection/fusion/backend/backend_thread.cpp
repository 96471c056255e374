// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/fusion/co_section_backend.h>

#include <pcl/cosection/common/error.h>

#include <string>
#include <system_error>
#include <utility>

namespace pcl::cosection {

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
