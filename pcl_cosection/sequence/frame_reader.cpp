// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/io/rgbd_sequence.h>

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <exception>
#include <system_error>

namespace pcl::cosection {

FrameReader::FrameReader (const RgbdSequence& sequence, const FrameRange& range, std::size_t ahead)
    : sequence_ (sequence)
    , ahead_ (ahead)
{
  const std::size_t last = std::min (range.last, sequence_.size ());
  if (range.first >= last)
    throw InvalidArgument ("the frames " + std::to_string (range.first) + ":" + std::to_string (range.last) +
                           " are not there; the sequence has 0:" + std::to_string (sequence_.size ()));
  if (ahead == 0)
    throw InvalidArgument ("ahead must be at least 1 frame");
  try
  {
    thread_ = std::thread (&FrameReader::run, this, range.first, last);
  }
  catch (const std::system_error& error)
  {
    throw Error (std::string ("no thread can be started to read the frames: ") + error.what ());
  }
}

FrameReader::~FrameReader ()
{
  {
    const std::lock_guard<std::mutex> lock (mutex_);
    stop_ = true;
  }
  changed_.notify_all ();
  thread_.join ();
}

void
FrameReader::run (std::size_t first, std::size_t last) noexcept
{
  std::exception_ptr failure;
  try
  {
    readFrames (first, last);
  }
  catch (...) // there is no memory even for a message
  {
    failure = std::current_exception ();
  }
  const std::lock_guard<std::mutex> lock (mutex_);
  failure_ = failure;
  done_ = true;
  changed_.notify_all ();
}

void
FrameReader::readFrames (std::size_t first, std::size_t last)
{
  for (std::size_t index = first; index < last; ++index)
  {
    Result result = readFrame (index);
    std::unique_lock<std::mutex> lock (mutex_);
    changed_.wait (lock, [this] { return stop_ || results_.size () < ahead_; });
    if (stop_)
      return;
    results_.push_back (std::move (result));
    changed_.notify_all ();
  }
}

FrameReader::Result
FrameReader::readFrame (std::size_t index) const
{
  Result result;
  try
  {
    result.frame = sequence_.read (index, result.warnings);
  }
  catch (const Error& error)
  {
    result.warnings.push_back (std::string (error.what ()) + "; the frame is skipped");
  }
  catch (const std::exception& error) // which names no file
  {
    result.warnings.push_back (sequence_.files (index).depth + ": " + error.what () + "; the frame is skipped");
  }
  return result;
}

std::optional<RgbdFrame>
FrameReader::next ()
{
  constexpr std::size_t most_warnings = 20;
  std::unique_lock<std::mutex> lock (mutex_);
  for (;;)
  {
    changed_.wait (lock, [this] { return done_ || !results_.empty (); });
    if (results_.empty () && failure_)
      std::rethrow_exception (failure_);
    if (results_.empty ())
      return std::nullopt;
    Result result = std::move (results_.front ());
    results_.pop_front ();
    changed_.notify_all ();
    for (std::string& warning : result.warnings)
      if (kept_warnings_.size () < most_warnings)
        kept_warnings_.push_back (std::move (warning));
      else
        ++more_warnings_;
    if (result.frame)
      return std::move (result.frame);
    ++skipped_;
  }
}

std::vector<std::string>
FrameReader::warnings () const
{
  const std::lock_guard<std::mutex> lock (mutex_);
  std::vector<std::string> lines = kept_warnings_;
  if (more_warnings_ > 0)
    lines.push_back ("and " + std::to_string (more_warnings_) +
                     (more_warnings_ == 1 ? " more warning" : " more warnings") + " about frames");
  return lines;
}

std::size_t
FrameReader::skipped () const
{
  const std::lock_guard<std::mutex> lock (mutex_);
  return skipped_;
}

} // namespace pcl::cosection
