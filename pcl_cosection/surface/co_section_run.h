// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "shape_volume.h"

#include <pcl/cosection/surface/co_section.h>
#include <pcl/cosection/surface/intersection_constraint.h>

#include <chrono>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace pcl
{
namespace cosection
{

/** \brief A body that objects cannot enter. */
struct Obstacle
{
  SignedDistanceField::ConstPtr field;
  std::vector<Eigen::Isometry3d> T_field_world;
};

/** \brief What the user has told a CoSection. */
struct CoSection::Impl
{
  CoSectionOptions options;
  std::vector<FreeSpaceView> views;
  std::vector<OrientedPoint> background;
  std::vector<ObjectInput> objects;
  std::vector<Eigen::Vector4d> planes; // unit normals
  std::vector<Obstacle> bodies;
};

/** \brief One execution of CoSection::reconstruct (). */
class CoSectionRun
{
public:
  CoSectionRun (const CoSection::Impl& scene, const ProgressCallback& progress);

  SceneResult
  run ();

private:
  struct Object
  {
    const ObjectInput* input = nullptr;
    ObjectResult* result = nullptr;
    std::unique_ptr<ShapeVolume> volume;
    std::vector<Eigen::Vector4d> planes;             // world
    SignedDistanceField field;                       // what it tells its neighbours
    std::map<std::size_t, double> beta;              // grown weights of single neighbours

    bool
    alive () const
    {
      return volume != nullptr;
    }
  };

  /** \brief Relative poses of two bodies over the views, thinned to motions of more than half a voxel. */
  std::vector<Eigen::Isometry3d>
  relativePoses (const Object& of, const Object* to) const;
  Eigen::Isometry3d
  pose (const Object& object, std::size_t view) const;

  void
  createVolumes ();
  /** \brief The plane with its normal to the side of most of the object's points. */
  Eigen::Vector4d
  towards (const Object& object, const Eigen::Vector4d& plane) const;
  void
  findPlanes ();
  void
  solveBackground ();
  void
  prepareObject (Object& object);
  std::vector<LowerBound>
  bounds (const Object& object) const;
  void
  solveObjects ();
  void
  solvePass (int pass);
  bool
  growWeightsWherePenetrating ();
  double
  penetration (const Object& object, const SignedDistanceField& body, const std::vector<Eigen::Isometry3d>& poses) const;
  double
  penetration (const Object& object) const;
  void
  finishObject (Object& object);

  template <typename Function> void
  timed (const char* stage, Function&& f);
  template <typename Function> void
  guarded (Object& object, Function&& f);
  void
  report (const std::string& stage, double fraction) const;

  const CoSection::Impl& scene_;
  const ProgressCallback& progress_;
  SceneResult result_;
  std::vector<Object> objects_;
  std::vector<SignedDistanceField> background_;
};

} // namespace cosection
} // namespace pcl
