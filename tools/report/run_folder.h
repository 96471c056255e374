// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "json_fields.h"

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/evaluation/run_evaluation.h>
#include <pcl/cosection/io/trajectory.h>
#include <pcl/cosection/visualization/run_scene.h>

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

/** \brief What pcl_cosection_fusion wrote of an object; what is missing is empty. */
struct RunObject
{
  int id = 0;
  std::vector<pcl::cosection::StampedPose> poses; ///< T_world_object
  pcl::cosection::TriangleMesh completed;         ///< the object's frame
  pcl::cosection::TriangleMesh seen;              ///< the zero level of the TSDF, the object's frame
  Json summary;                                   ///< its entry in summary.json
};

/** \brief A folder that pcl_cosection_fusion or pcl_cosection wrote. */
struct RunFolder
{
  std::string path;
  std::string date;      ///< when the run ended, by the time of its summary: "2026-01-31 12:00 UTC"
  Json summary;          ///< null: the run has no summary
  std::string failure;   ///< why the run as a whole failed; empty: it did not
  bool of_views = false; ///< what pcl_cosection wrote
  std::vector<pcl::cosection::StampedPose> camera; ///< T_world_camera
  std::optional<pcl::cosection::PinholeCamera> intrinsics;
  std::vector<RunObject> objects;          ///< by ascending ids
  pcl::cosection::TriangleMesh background; ///< world frame
  std::vector<std::string> notes;          ///< what is missing or cannot be read
};

/** \brief Read what is there of a run, be it incomplete.
 * \throws pcl::cosection::IoError if there is no such folder, or nothing of a run in it; the message says what it is
 * instead, where that can be found out */
RunFolder readRunFolder (const std::string& path);

/** \brief The part of a run that is compared with a truth, and drawn: what has poses. */
pcl::cosection::RunScene sceneOf (const RunFolder& run);
