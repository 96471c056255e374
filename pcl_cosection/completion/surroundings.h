// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "completion_log.h"
#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/priors/object_priors.h"
#include "scene.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief The planes that bound an object, given or found in the background: n.x + d = 0, unit n towards the object,
 * world frame. */
struct SupportPlanes
{
  std::vector<Eigen::Vector4d> planes;
  bool inferred = false; // the only plane is that of inferSupportPlane (): it bounds the mesh, but not the hull
  std::optional<Eigen::Vector4d> top; // that of the top of another object, on which the object stands
  std::vector<OrientedPoint> feet;    // of objects that stand on this one's top, world frame

  /** \brief With that of the other object's top, which bounds this object alone. */
  std::vector<Eigen::Vector4d> all () const;
};

/** \brief One object of the scene with a grid. */
struct SceneObject
{
  std::size_t index = 0; // in the scene
  const ObjectInput* input = nullptr;
  const Observation* observation = nullptr;
  const SupportPlanes* support = nullptr;
  BodyState* body = nullptr;
  std::vector<Eigen::Isometry3d> T_world_object; // relativePoses () with respect to the world

  const std::vector<OrientedPoint>& points () const { return observation->points (); }

  const VoxelGrid& grid () const { return *body->grid; }

  /** \brief The planes in the object's frame, at all of its poses. */
  std::vector<Eigen::Vector4d> planes () const;
};

/** \brief Call f (o) for all objects that have not failed. If it throws, only that object fails. */
template <typename Function>
void
forEachObject (const std::vector<SceneObject>& objects, CompletionLog& log, Function&& f)
{
  for (std::size_t o = 0; o < objects.size (); ++o)
    if (!log.failed (objects[o].index))
      log.guard (objects[o].index, [&] { f (o); });
}

/** \brief Call f (o, true) as forEachObject () calls f (o), but f (o, false) for several small objects at the same
 * time, as none of them keeps all threads busy. Then f may change only what is its object's, and must not use the log.
 * \param[in] done called on this thread with the number of objects that are done, after those of the same time */
template <typename Function, typename Done>
void
forEachObjectAtOnce (const std::vector<SceneObject>& objects, int threads, CompletionLog& log, Function&& f,
                     Done&& done)
{
  constexpr std::size_t small = 1U << 18; // voxels
  constexpr std::size_t per_thread = 8;   // objects: some take longer than others
  const std::size_t most = resolveThreads (threads) > 1 ? per_thread * resolveThreads (threads) : 1;
  for (std::size_t o = 0; o < objects.size ();)
  {
    std::size_t end = o;
    while (end < objects.size () && end < o + most && objects[end].grid ().size () < small)
      ++end;
    const bool is_alone = end <= o + 1;
    end = std::max (end, o + 1);
    parallelFor (static_cast<int> (o), static_cast<int> (end), is_alone ? 1 : threads, [&] (int n) {
      const SceneObject& object = objects[static_cast<std::size_t> (n)];
      if (!log.failed (object.index))
        log.guard (object.index, [&] { f (static_cast<std::size_t> (n), is_alone); });
    });
    o = end;
    done (o);
  }
}

template <typename Function>
void
forEachObjectAtOnce (const std::vector<SceneObject>& objects, int threads, CompletionLog& log, Function&& f)
{
  forEachObjectAtOnce (
      objects, threads, log, [&] (std::size_t o, bool) { f (o); }, [] (std::size_t) {});
}

/** \brief 1 for each object that has not failed: to be asked while others may fail. */
inline std::vector<std::uint8_t>
aliveObjects (const std::vector<SceneObject>& objects, const CompletionLog& log)
{
  std::vector<std::uint8_t> alive;
  for (const SceneObject& object : objects)
    alive.push_back (!log.failed (object.index));
  return alive;
}

/** \brief The surroundings of an object, as priors need them. */
ObjectSetting settingOf (const Scene& scene, const ObjectInput& object);

/** \brief The given planes that may bound an object, with normals towards it, world frame: those within reach of it, or
 * all, if it moves. */
std::vector<Eigen::Vector4d> givenPlanes (const Scene& scene, const ObjectInput& object,
                                          const Observation& observation);

/** \brief givenPlanes () of the object, and its support planes found in the background. */
std::vector<Eigen::Vector4d> boundingPlanes (const Scene& scene, const ObjectInput& object,
                                             const Observation& observation);

/** \brief boundingPlanes () of each object; inferSupportPlane () for an object without known surroundings. Warns if
 * given planes cut off many points. */
std::vector<SupportPlanes> findObjectPlanes (const Scene& scene, const std::vector<Observation>& observations,
                                             CompletionLog& log);

/** \brief The planes of all objects, without duplicates. */
std::vector<Eigen::Vector4d> differentPlanes (const Scene& scene, const std::vector<Observation>& observations,
                                              const std::vector<SupportPlanes>& support);

/** \brief The obstacles as fields; meshes are sampled where objects may be. Warns if an obstacle contains many points
 * of an object, and if a mesh has to be left out.
 * \param[in] used_bytes memory in use, without obstacles */
std::vector<Obstacle> sampleObstacles (const Scene& scene, const std::vector<SceneObject>& objects,
                                       std::size_t used_bytes, CompletionLog& log);

} // namespace pcl::cosection
