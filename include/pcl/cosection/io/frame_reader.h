// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/io/rgbd_sequence.h>

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace pcl::cosection
{

/** \brief Which frames FrameReader reads. */
struct PCL_COSECTION_EXPORT FrameRange
{
  std::size_t first = 0;                                       ///< index
  std::size_t last = std::numeric_limits<std::size_t>::max (); ///< index of the frame behind the last; larger: the
                                                               ///< sequence's end
};

/** \brief Reads the frames of a sequence ahead, in a thread of its own.
 *
 * Frames come in their order. One that cannot be read is skipped and told in warnings (). The same files give the same
 * frames and warnings, however the threads run.
 *
 * \code
 * FrameReader reader (sequence);
 * while (const std::optional<RgbdFrame> frame = reader.next ())
 *   use (*frame);
 * \endcode */
class PCL_COSECTION_EXPORT FrameReader
{
public:
  /** \brief Start to read. The reader has a copy of the sequence, which is names only.
   * \param[in] ahead frames that are held at most until they are asked for
   * \throws InvalidArgument if the range has no frame of the sequence, or \a ahead is 0 */
  explicit FrameReader (const RgbdSequence& sequence, const FrameRange& range = {}, std::size_t ahead = 4);

  /** \brief Stops as soon as the frame that is being read is done. */
  ~FrameReader ();

  FrameReader (const FrameReader&) = delete;
  FrameReader& operator= (const FrameReader&) = delete;

  /** \brief The next frame that can be read; waits for it. Nothing at the end, again and again.
   * \throws std::bad_alloc if memory ran out even for a message about a frame */
  std::optional<RgbdFrame> next ();

  /** \brief Lines about the frames up to the last that next () returned, in their order: the first twenty, then how
   * many more. From any thread. */
  std::vector<std::string> warnings () const;

  /** \brief How many frames were skipped up to the last that next () returned. From any thread. */
  std::size_t skipped () const;

private:
  struct Result
  {
    std::optional<RgbdFrame> frame; // nothing: skipped
    std::vector<std::string> warnings;
  };

  void run (std::size_t first, std::size_t last) noexcept;

  void readFrames (std::size_t first, std::size_t last);

  Result readFrame (std::size_t index) const;

  const RgbdSequence sequence_;
  const std::size_t ahead_;

  mutable std::mutex mutex_; // of what follows
  std::condition_variable changed_;
  std::deque<Result> results_;
  bool done_ = false;
  bool stop_ = false;
  std::exception_ptr failure_;
  std::vector<std::string> kept_warnings_;
  std::size_t more_warnings_ = 0;
  std::size_t skipped_ = 0;

  std::thread thread_; // last: it uses the rest
};

} // namespace pcl::cosection
