// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/evaluation/run_evaluation.h>

#include <vector>

namespace pcl::cosection {

/** \brief An object as the camera sees it. */
struct ViewedObject
{
  const SceneRecord::Object* object = nullptr;
  std::vector<StampedPose> poses; ///< T_camera_object, where the camera has a pose too
};

/** \brief The objects of a scene that have a mesh and poses together with the camera. */
std::vector<ViewedObject> viewObjects (const SceneRecord& scene, double max_difference_s, const char* whose,
                                       std::vector<std::string>& warnings);

struct ObjectMatch
{
  std::size_t truth = 0; ///< indices
  std::size_t estimate = 0;
  double overlap = 0.0;
};

/** \brief Match one to one, by ascending index of the estimate. */
std::vector<ObjectMatch> matchObjects (const std::vector<ViewedObject>& truth,
                                       const std::vector<ViewedObject>& estimate, double max_difference_s, int threads);

} // namespace pcl::cosection
