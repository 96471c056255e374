// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/evaluation/run_evaluation.h>

#include <string>
#include <vector>

namespace pcl::cosection
{

/** \brief What was odd about the files. */
struct PCL_COSECTION_EXPORT ReadingNotes
{
  std::vector<std::string> warnings;
  bool whole = true; ///< every file that is there could be read
};

/** \brief Read what a run wrote: trajectory/camera.txt, trajectory/object_ID.txt, mesh/object_ID.ply,
 * mesh/background.ply.
 * \param[out] notes what is missing or cannot be read, beside the camera
 * \throws IoError if there is no such folder, or the camera cannot be read */
PCL_COSECTION_EXPORT SceneRecord readRun (const std::string& folder, ReadingNotes& notes);

/** \brief Read the truth of a dataset: gt-cam-0.txt, gt-NAME-ID.txt, gt-mesh/NAME.ply, gt-mesh/room.ply or
 * background.ply, calibration.txt.
 * \param[out] notes what is missing or cannot be read, beside the camera
 * \throws IoError if there is no such folder, or the camera cannot be read */
PCL_COSECTION_EXPORT SceneRecord readTruth (const std::string& folder, ReadingNotes& notes);

} // namespace pcl::cosection
