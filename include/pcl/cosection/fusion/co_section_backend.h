// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/fusion/keyframe.h>
#include <pcl/cosection/surface/co_section.h>

#include <Eigen/Geometry>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace pcl::cosection {

/** \brief How much of a sequence CoSectionBackend keeps. */
struct PCL_COSECTION_EXPORT BackendOptions
{
  CoSectionOptions method;        ///< of CoSection
  std::size_t max_views = 100;    ///< depth images that are kept, keyframes among them; at least 4
  std::size_t max_keyframes = 40; ///< at least 2

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief The back end of a sequence: drives CoSection with keyframes as they come.
 *
 * Keyframes give oriented points and free space, frames between them free space. What is kept is bounded: when there
 * are too many views, those whose poses relative to everything in the scene are nearest to another's are given up with
 * their points, half of all; from then on, a view as near as that to a kept one is not taken.
 *
 * \code
 * CoSectionBackend backend;
 * for (const Keyframe& keyframe : keyframes)
 * {
 *   backend.addKeyframe (keyframe, poses.at (keyframe.stamp));
 *   const SceneResult so_far = backend.update (UpdateOutput::Meshes);
 * }
 * const SceneResult result = backend.solve ();
 * \endcode */
class PCL_COSECTION_EXPORT CoSectionBackend
{
public:
  using Poses = std::map<int, Eigen::Isometry3d>; ///< T_world_object by id, of the objects whose pose is known

  /** \brief An empty back end. \throws InvalidArgument as BackendOptions::validate () */
  explicit CoSectionBackend (const BackendOptions& options = {});

  /** \brief Add the points and the free space of a keyframe. Points of objects without a pose in \a T_world_object are
   * left out; for objects that never move, give the identity.
   * \return whether it was kept
   * \throws InvalidArgument if the view is not valid, a pose not finite or an id negative; nothing is kept then */
  bool addKeyframe (const Keyframe& keyframe, const Poses& T_world_object);

  /** \brief Add the free space of a frame. \return whether it was kept \throws InvalidArgument as addKeyframe () */
  bool addFrame (DepthView view, const Poses& T_world_object);

  /** \brief Remove what turned out to be no object, or a part of another one, with its points. */
  void removeObject (int id);

  /** \brief Complete everything, from the last solution on: CoSection::update (). \throws Cancelled */
  SceneResult update (UpdateOutput output, const ProgressCallback& progress = {});

  /** \brief Complete everything from the start, from all that is kept. Earlier updates only say where voxels are.
   * \throws Cancelled */
  SceneResult solve (const ProgressCallback& progress = {}) const;

  /** \brief Forget the results of updates, and free their memory: CoSection::forgetUpdates (). */
  void forgetUpdates () { scene_.forgetUpdates (); }

  /** \brief Views that are kept, keyframes among them. */
  std::size_t views () const { return kept_.size (); }

  /** \brief Keyframes that are kept. */
  std::size_t keyframes () const;

private:
  /** \brief Where the sensor was, relative to the world (id 0) and to the objects. */
  struct KeptView
  {
    std::map<int, Eigen::Isometry3d> T_body_sensor;
    bool keyframe;
  };

  static double gap (const KeptView& a, const KeptView& b);
  /** \brief Take the view's place, if it is not too near to another and there is room or can be made. */
  bool reserve (KeptView view);
  /** \brief Give up half of the keyframes, or of the other views. */
  void thin (bool keyframes);

  BackendOptions options_;
  CoSection scene_;
  std::vector<KeptView> kept_; // as in scene_
  double least_gap_m_ = -1.0;  // from a new view to all others; negative: none is asked for
};

/** \brief Everything completed with the views up to a keyframe. */
struct PCL_COSECTION_EXPORT BackendUpdate
{
  double stamp = 0.0;   ///< of the keyframe
  SceneResult scene;    ///< everything that is completed
  double seconds = 0.0; ///< that the update took
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
  /** \brief Start the thread.
   * \param[in] backend not to be touched as long as the thread is there
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
