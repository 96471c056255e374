// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/fusion/sequence_fusion.h>

#include <sys/types.h>

#include <atomic>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

/** \brief What there is to show of a run that goes on. */
struct LiveScene
{
  std::vector<pcl::cosection::StampedPose> camera;
  std::map<int, std::vector<pcl::cosection::StampedPose>> objects;
  std::map<int, pcl::cosection::TriangleMesh> seen, completed; ///< that are not written yet, object frame
  std::deque<pcl::cosection::TriangleMesh> background;         ///< as keyframes see it, world frame
  bool changed_background = false;
};

/** \brief Shows a run in a window while it goes on: pcl_cosection_viewer as a process of its own, which reads
 * snapshots. Whatever becomes of the window, the run is not concerned. Snapshots are written in a thread; what comes
 * meanwhile is shown together. In the end, the window stays and shows the result. */
class LiveView
{
public:
  /** \brief Open the window. \param[in] dataset, output of the run, as on the command line
   * \throws pcl::cosection::IoError that says why it cannot be opened */
  LiveView (const std::string& dataset, const pcl::cosection::PinholeCamera& camera, const std::string& output);

  /** \brief Let go of the window. */
  ~LiveView ();

  LiveView (const LiveView&) = delete;
  LiveView& operator= (const LiveView&) = delete;

  /** \brief Show a frame; of keyframes, what was seen of the objects as well. */
  void show (const pcl::cosection::FrameReport& frame);

  /** \brief Show completed meshes. */
  void show (const pcl::cosection::KeyframeReport& keyframe);

private:
  void start (const std::string& output);
  /** \brief Wait until the window is there. */
  void waitUntilReady ();
  bool hasEnded ();
  /** \brief What is to be written; with the mutex. */
  LiveScene takeChanges ();
  void writeSnapshots ();
  /** \brief End the process and remove the snapshots. */
  void giveUp ();

  const pcl::cosection::PinholeCamera camera_;
  std::string folder_;
  pid_t process_ = -1;
  int input_ = -1; ///< of the process, which ends with the run

  std::mutex mutex_; // of what follows
  std::condition_variable changed_;
  LiveScene scene_;
  bool is_new_ = false;
  bool stop_ = false;

  std::atomic<bool> is_over_{false}; ///< the window is closed
  std::thread thread_;               // last: it uses the rest
};
