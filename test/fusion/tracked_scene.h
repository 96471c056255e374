// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/fusion/dynamic_fusion.h>
#include <pcl/cosection/fusion/frame_segmenter.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace pcl::cosection::test {

/** \brief The mask that the front end gets for a frame, made of the true one; nothing: none. */
using MaskPolicy = std::function<std::optional<Image<std::uint16_t>> (int frame, const Image<std::uint16_t>& truth)>;

/** \brief Never any. */
std::optional<Image<std::uint16_t>> noMask (int frame, const Image<std::uint16_t>& truth);

/** \brief How far the front end may be off, metres: the camera, the camera where a segmenter finds the objects, whose
 * instances end above the floor, and an object. */
constexpr double camera_limit_m = 0.004, segmented_camera_limit_m = 0.006, object_limit_m = 0.010;

/** \brief A vertex of the background this far from the true one is wrong, metres. */
constexpr double wrong_m = 0.04;

/** \brief Whether a point of the world is of a thing, see TrackedScene::addThing (), that stands at (\a x, 0, 0). */
bool isThing (const Eigen::Vector3d& p, double x);

/** \brief A mask whose instances have other numbers, which differ from frame to frame. */
Image<std::uint16_t> reshuffled (const Image<std::uint16_t>& mask, int frame);

/** \brief From one place to another in a second, turning about z by \a turn_rad. */
KeyedMotion movingThing (const Eigen::Vector3d& from, const Eigen::Vector3d& to, double turn_rad);

/** \brief Through places at times, of a second, without turning. */
KeyedMotion along (const std::vector<double>& times, const std::vector<Eigen::Vector3d>& places);

/** \brief Labels points of the world as a function says, which may be wrong, and names classes as another one does. */
class FakeSegmenter : public FrameSegmenter
{
public:
  using Label = std::function<int (const Eigen::Vector3d& world, int frame)>;
  using Classes = std::function<std::map<std::uint16_t, ClassScore> (int frame)>;

  /** \param[in] exact whether it says that it finds all and that its masks are exact */
  explicit FakeSegmenter (Label label, bool exact = false, Classes classes = {})
      : label_ (std::move (label))
      , exact_ (exact)
      , classes_ (std::move (classes))
  {}

  FrameInstances segment (const ObservedFrame& frame) override;

  bool findsAll () const override { return exact_; }

  bool isExact () const override { return exact_; }

private:
  Label label_;
  bool exact_;
  Classes classes_;
};

/** \brief The results of the front end for a scene, and the truth. */
struct TrackedRun
{
  std::vector<TrackedFrame> frames;
  std::vector<Eigen::Isometry3d> T_world_camera; ///< true; the first is given to the front end
  std::vector<double> times;                     ///< s
  std::vector<Image<std::uint16_t>> masks;       ///< true
  std::set<int> found;
  std::map<std::uint16_t, std::string> refused; ///< instances of masks that are no object, and why
  std::map<int, ClassScore> classes;            ///< by object up to number 100, where they are known
  std::vector<std::string> events;
  TriangleMesh background;

  int framesWithCamera () const;

  /** \brief Number of frames in which an object of the front end was tracked. */
  int framesOf (int id) const;

  /** \brief Largest error of the camera's position, metres. */
  double cameraError () const;

  /** \brief Errors of the object's position relative to its first pose, metres, in the frames in which it was tracked.
   */
  std::vector<double> objectErrors (int id, const SceneBody& body) const;

  /** \brief The largest of objectErrors (). */
  double objectError (int id, const SceneBody& body) const;

  /** \brief The last of objectErrors (), if there is one. */
  double lastObjectError (int id, const SceneBody& body) const;

  /** \brief The object of the front end that most pixels of a body belong to in the last frame. */
  int foundAs (int body) const;

  /** \brief Share of the background's vertices that were deeper than \a depth_m within a body in some frame. */
  double shareOfBackgroundInside (const class TrackedScene& scene, int body, double depth_m) const;

  /** \brief Share of the background's vertices that are farther than \a tolerance_m from the surface of the true one.
   */
  double shareOfBackgroundWrong (const class TrackedScene& scene, double tolerance_m) const;

  /** \brief Whether a line about a decision contains this. */
  bool said (const std::string& words) const;
};

/** \brief A corner of a room with things in it, as a structured-light camera sees it in a second. */
class TrackedScene
{
public:
  enum class Surroundings
  {
    Room,
    Wall, ///< and nothing else
  };

  explicit TrackedScene (int frames, Surroundings surroundings = Surroundings::Room);

  /** \brief A box with a ball beside it, on the floor. */
  void addThing (int id, const KeyedMotion& motion);

  /** \brief As wide and high as a person who leans over the floor. */
  void addPerson (int id, const KeyedMotion& motion);

  /** \brief A fist and an arm that comes from the left. */
  void addHand (int id, const KeyedMotion& motion);

  void addBall (int id, const KeyedMotion& motion);

  /** \brief Give all that has been added a pattern of this period. */
  void paint (double period_m);

  /** \brief Along a line, looking at the middle of the floor. */
  void moveCamera (const Eigen::Vector3d& from, const Eigen::Vector3d& to);

  /** \brief Change the depth of each frame before the front end gets it. */
  void spoil (std::function<void (int frame, Image<float>& depth)> change) { spoil_ = std::move (change); }

  const SceneBody& body (int id) const;

  TrackedRun run (const MaskPolicy& masks, DynamicFusionOptions options = {},
                  std::shared_ptr<FrameSegmenter> segmenter = nullptr) const;

private:
  SimulatedScene scene_;
  std::function<void (int frame, Image<float>& depth)> spoil_;
};

} // namespace pcl::cosection::test
