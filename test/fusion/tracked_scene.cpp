// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "tracked_scene.h"

#include "pcl_cosection/view/look_at.h"
#include <pcl/cosection/simulation/scene_renderer.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace pcl::cosection::test {
namespace {

const Eigen::Vector3d middle (0.0, 0.0, 0.1);

Eigen::Isometry3d
at (const Eigen::Vector3d& position)
{
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity ();
  T.translation () = position;
  return T;
}

BodyPart
part (Shape::ConstPtr shape, const Eigen::Vector3d& position)
{
  BodyPart result;
  result.shape = std::move (shape);
  result.T_body_part = at (position);
  return result;
}

} // namespace

std::optional<Image<std::uint16_t>>
noMask (int /*frame*/, const Image<std::uint16_t>& /*truth*/)
{
  return std::nullopt;
}

FrameInstances
FakeSegmenter::segment (const ObservedFrame& frame)
{
  const auto index = static_cast<int> (frame.images.index);
  FrameInstances found;
  found.mask = Image<std::uint16_t> (frame.camera.width, frame.camera.height, 0);
  for (std::size_t n = 0; n < frame.points.size (); ++n)
    if (std::isfinite (frame.points[n].z ()))
      found.mask->pixels[n] = static_cast<std::uint16_t> (
          label_ (frame.T_world_camera * frame.points[n].cast<double> (), index));
  if (classes_)
    found.classes = classes_ (index);
  return found;
}

bool
isThing (const Eigen::Vector3d& p, double x)
{
  return p.z () > 0.015 && p.z () < 0.3 && std::abs (p.x () - x) < 0.17 && std::abs (p.y ()) < 0.12;
}

Image<std::uint16_t>
reshuffled (const Image<std::uint16_t>& mask, int frame)
{
  Image<std::uint16_t> result = mask;
  for (std::uint16_t& pixel : result.pixels)
    if (pixel != 0)
      pixel = static_cast<std::uint16_t> (1 + (pixel * 37 + frame * 11) % 101);
  return result;
}

KeyedMotion
movingThing (const Eigen::Vector3d& from, const Eigen::Vector3d& to, double turn_rad)
{
  const Eigen::Quaterniond start = Eigen::Quaterniond::Identity ();
  const Eigen::Quaterniond end (Eigen::AngleAxisd (turn_rad, Eigen::Vector3d::UnitZ ()));
  return KeyedMotion (KeyedVector ({0.0, 1.0}, {from, to}), KeyedRotation ({0.0, 1.0}, {start, end}));
}

KeyedMotion
along (const std::vector<double>& times, const std::vector<Eigen::Vector3d>& places)
{
  return KeyedMotion (KeyedVector (times, places), KeyedRotation ({0.0}, {Eigen::Quaterniond::Identity ()}));
}

int
TrackedRun::framesWithCamera () const
{
  return static_cast<int> (std::count_if (
      frames.begin (), frames.end (), [] (const TrackedFrame& frame) { return frame.T_world_camera.has_value (); }));
}

int
TrackedRun::framesOf (int id) const
{
  return static_cast<int> (std::count_if (frames.begin (), frames.end (), [id] (const TrackedFrame& frame) {
    return frame.T_world_object.count (id) > 0;
  }));
}

double
TrackedRun::cameraError () const
{
  double largest = 0.0;
  for (std::size_t n = 0; n < frames.size (); ++n)
    if (frames[n].T_world_camera)
      largest = std::max (largest,
                          (frames[n].T_world_camera->translation () - T_world_camera[n].translation ()).norm ());
  return largest;
}

std::vector<double>
TrackedRun::objectErrors (int id, const SceneBody& body) const
{
  std::optional<Eigen::Isometry3d> T_object_body;
  std::vector<double> errors;
  for (std::size_t n = 0; n < frames.size (); ++n)
  {
    const auto pose = frames[n].T_world_object.find (id);
    if (pose == frames[n].T_world_object.end ())
      continue;
    const Eigen::Isometry3d truth = body.motion.at (times[n]);
    if (!T_object_body)
      T_object_body = pose->second.inverse () * truth;
    errors.push_back (((pose->second * *T_object_body).translation () - truth.translation ()).norm ());
  }
  return errors;
}

double
TrackedRun::objectError (int id, const SceneBody& body) const
{
  const std::vector<double> errors = objectErrors (id, body);
  return errors.empty () ? 0.0 : *std::max_element (errors.begin (), errors.end ());
}

double
TrackedRun::lastObjectError (int id, const SceneBody& body) const
{
  return objectErrors (id, body).back ();
}

int
TrackedRun::foundAs (int body) const
{
  std::map<int, int> counts;
  for (std::size_t n = 0; n < masks.back ().pixels.size (); ++n)
    if (masks.back ().pixels[n] == body)
      ++counts[frames.back ().instances.pixels[n]];
  counts.erase (TrackedFrame::unassigned);
  const auto most = std::max_element (counts.begin (), counts.end (),
                                      [] (const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts.end () ? 0 : most->first;
}

double
TrackedRun::shareOfBackgroundInside (const TrackedScene& scene, int id, double depth_m) const
{
  const SceneBody& body = scene.body (id);
  std::size_t inside = 0;
  for (const Eigen::Vector3f& vertex : background.vertices)
    inside += std::any_of (times.begin (), times.end (), [&] (double time) {
      return body.distance (body.motion.at (time).inverse () * vertex.cast<double> ()) < -depth_m;
    });
  return static_cast<double> (inside) / static_cast<double> (std::max<std::size_t> (1, background.vertices.size ()));
}

double
TrackedRun::shareOfBackgroundWrong (const TrackedScene& scene, double tolerance_m) const
{
  const SceneBody& room = scene.body (0);
  const auto wrong = std::count_if (
      background.vertices.begin (), background.vertices.end (),
      [&] (const Eigen::Vector3f& vertex) { return std::abs (room.distance (vertex.cast<double> ())) > tolerance_m; });
  return static_cast<double> (wrong) / static_cast<double> (std::max<std::size_t> (1, background.vertices.size ()));
}

bool
TrackedRun::said (const std::string& words) const
{
  return std::any_of (events.begin (), events.end (),
                      [&] (const std::string& line) { return line.find (words) != std::string::npos; });
}

TrackedScene::TrackedScene (int frames, Surroundings surroundings)
{
  scene_.camera = PinholeCamera{320, 240, 262.0, 262.0, 159.5, 119.5};
  scene_.frames = frames;
  scene_.rate = frames;
  // The noise of a camera of 640 x 480 whose image is reduced.
  DepthNoise noise;
  const double reduction = scene_.camera.width / 640.0;
  noise.disparity_sigma_px *= reduction;
  noise.disparity_step_px *= reduction;
  noise.lateral_sigma_px *= reduction;
  scene_.noise = noise;
  SceneBody room;
  room.name = "room";
  if (surroundings == Surroundings::Room)
  {
    room.parts.push_back (part (makeRoom ({3.2, 3.2, 2.4}), {0.0, 0.0, 1.2}));
    room.parts.push_back (part (makeBox ({0.5, 0.3, 0.6}), {0.1, 1.2, 0.3}));
    room.parts.push_back (part (makeBox ({0.4, 0.4, 0.35}), {1.1, 0.3, 0.175}));
    for (BodyPart& wall : room.parts) // the camera looks into a corner
      wall.T_body_part.prerotate (Eigen::AngleAxisd (0.7, Eigen::Vector3d::UnitZ ()));
    scene_.camera_motion = KeyedMotion (lookAt ({0.0, -1.3, 0.9}, middle));
  }
  else
  {
    room.parts.push_back (part (makeRoom ({20.0, 2.0, 20.0}), Eigen::Vector3d::Zero ()));
    scene_.camera_motion = KeyedMotion (lookAt ({0.0, -0.3, 0.0}, {0.0, 1.0, 0.0}));
  }
  scene_.bodies.push_back (room);
}

void
TrackedScene::addThing (int id, const KeyedMotion& motion)
{
  SceneBody thing;
  thing.name = "thing" + std::to_string (id);
  thing.id = id;
  thing.parts.push_back (part (makeBox ({0.26, 0.16, 0.12}), {0.0, 0.0, 0.061}));
  thing.parts.push_back (part (makeSphere (0.07), {0.06, 0.0, 0.16}));
  thing.motion = motion;
  scene_.bodies.push_back (thing);
}

void
TrackedScene::addPerson (int id, const KeyedMotion& motion)
{
  SceneBody person;
  person.name = "person" + std::to_string (id);
  person.id = id;
  person.parts.push_back (part (makeBox ({0.35, 0.25, 0.8}), {0.0, 0.0, 0.41}));
  person.parts.push_back (part (makeSphere (0.11), {0.0, 0.0, 0.9}));
  person.parts.push_back (part (makeBox ({0.08, 0.3, 0.08}), {-0.1, -0.25, 0.5}));
  person.motion = motion;
  scene_.bodies.push_back (person);
}

void
TrackedScene::addHand (int id, const KeyedMotion& motion)
{
  SceneBody hand;
  hand.name = "hand" + std::to_string (id);
  hand.id = id;
  hand.parts.push_back (part (makeSphere (0.05), {0.0, 0.0, 0.0}));
  hand.parts.push_back (part (makeBox ({0.5, 0.06, 0.06}), {-0.27, 0.0, 0.0}));
  hand.motion = motion;
  scene_.bodies.push_back (hand);
}

void
TrackedScene::addBall (int id, const KeyedMotion& motion)
{
  SceneBody ball;
  ball.name = "ball" + std::to_string (id);
  ball.id = id;
  ball.parts.push_back (part (makeSphere (0.12), {0.0, 0.0, 0.121}));
  ball.motion = motion;
  scene_.bodies.push_back (ball);
}

void
TrackedScene::paint (double period_m)
{
  for (SceneBody& body : scene_.bodies)
    body.pattern_size_m = period_m;
}

void
TrackedScene::moveCamera (const Eigen::Vector3d& from, const Eigen::Vector3d& to)
{
  scene_.camera_motion = KeyedMotion (KeyedVector ({0.0, 1.0}, {from, to}), KeyedVector ({0.0}, {middle}),
                                      Eigen::Vector3d::UnitZ ());
}

const SceneBody&
TrackedScene::body (int id) const
{
  return *std::find_if (scene_.bodies.begin (), scene_.bodies.end (),
                        [id] (const SceneBody& body) { return body.id == id; });
}

TrackedRun
TrackedScene::run (const MaskPolicy& masks, DynamicFusionOptions options,
                   std::shared_ptr<FrameSegmenter> segmenter) const
{
  const SceneRenderer renderer (scene_);
  options.first_pose = scene_.camera_motion.at (0.0);
  options.background_resolution = 128;
  DynamicFusion fusion (scene_.camera, options);
  fusion.setSegmenter (std::move (segmenter));
  TrackedRun run;
  for (int n = 0; n < scene_.frames; ++n)
  {
    const double time = scene_.timeOf (n);
    const SimulatedFrame seen = renderer.render (time);
    RgbdFrame frame;
    frame.index = static_cast<std::size_t> (n);
    frame.stamp = n;
    frame.colour = seen.colour;
    frame.depth = measureDepth (seen.depth, seen.normals, scene_.camera, *scene_.noise, scene_.seed,
                                static_cast<std::uint64_t> (n));
    if (spoil_)
      spoil_ (n, frame.depth);
    const std::optional<Image<std::uint16_t>> mask = masks (n, seen.mask);
    run.frames.push_back (fusion.process (frame, mask ? &*mask : nullptr));
    run.T_world_camera.push_back (seen.T_world_camera);
    run.times.push_back (time);
    run.masks.push_back (seen.mask);
  }
  run.found = fusion.foundObjects ();
  run.refused = fusion.refusedInstances ();
  for (int id = 0; id <= 100; ++id)
    if (const std::optional<ClassScore> best = fusion.objectClass (id))
      run.classes[id] = *best;
  run.events = fusion.events ();
  run.background = fusion.backgroundMesh ();
  return run;
}

} // namespace pcl::cosection::test
