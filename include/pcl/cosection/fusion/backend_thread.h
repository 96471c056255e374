// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/fusion/co_section_backend.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace pcl::cosection
{

/** \brief Everything completed with the views up to a keyframe. */
struct PCL_COSECTION_EXPORT BackendUpdate
{
  double stamp = 0.0; ///< of the keyframe
  SceneResult scene;
  double seconds = 0.0;
};

/** \brief Updates a CoSectionBackend in a thread of its own, while the front end goes on.
 *
 * Views are used in the order in which they are added. After a keyframe, everything is completed; keyframes that come
 * meanwhile are completed together, in the next update. What the back end has in the end does not depend on how the
 * threads run, which updates there were does, unless wait (0) follows each keyframe.
 *
 * \code
 * CoSectionBackend backend;
 * {
 *   BackendThread thread (backend);
 *   for (const Keyframe& keyframe : keyframes)
 *   {
 *     thread.addKeyframe (keyframe, poses.at (keyframe.stamp));
 *     for (const BackendUpdate& update : thread.takeUpdates ())
 *       show (update.scene);
 *   }
 *   while (!thread.wait (0, std::chrono::seconds (1)))
 *     ;
 * }
 * const SceneResult result = backend.solve ();
 * \endcode
 * All functions are for one thread, the front end's. */
class PCL_COSECTION_EXPORT BackendThread
{
public:
  /** \param[in] backend not to be touched as long as the thread is there
   * \param[in] output of the updates
   * \throws Error if no thread can be started */
  explicit BackendThread (CoSectionBackend& backend, UpdateOutput output = UpdateOutput::Meshes);

  /** \brief Cancels the update that runs. Views that wait are not used. */
  ~BackendThread ();

  BackendThread (const BackendThread&) = delete;
  BackendThread& operator= (const BackendThread&) = delete;

  /** \brief Have a keyframe used and everything completed. Does not wait: see wait (). */
  void addKeyframe (Keyframe keyframe, CoSectionBackend::Poses T_world_object);

  /** \brief Have the free space of a frame used. */
  void addFrame (DepthView view, CoSectionBackend::Poses T_world_object);

  /** \brief The updates that were finished since the last time, in their order.
   * \throws what CoSectionBackend threw, again and again; nothing is done any more then */
  std::vector<BackendUpdate> takeUpdates ();

  /** \brief Wait until no more than so many views wait to be used; with 0, until no update runs either.
   * \return whether it is so; false: the time was up \throws as takeUpdates () */
  bool wait (std::size_t views, std::chrono::milliseconds time);

private:
  struct Item
  {
    std::optional<Keyframe> keyframe; // else
    DepthView view;
    CoSectionBackend::Poses T_world_object;
  };

  void add (Item item);

  void run () noexcept;

  void work ();

  /** \brief Give views to the back end. \return the stamp of the last keyframe among them */
  std::optional<double> use (std::vector<Item> items);

  BackendUpdate update (double stamp);

  CoSectionBackend& backend_; // the thread's
  const UpdateOutput output_;
  std::atomic<bool> stop_{false};

  std::mutex mutex_; // of what follows
  std::condition_variable changed_;
  std::vector<Item> waiting_;
  bool busy_ = false;
  std::vector<BackendUpdate> updates_;
  std::exception_ptr failure_;

  std::thread thread_; // last: it uses the rest
};

} // namespace pcl::cosection
