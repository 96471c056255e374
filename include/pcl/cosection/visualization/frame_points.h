// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/visualization/run_scene.h>

#include <Eigen/Core>

#include <memory>
#include <string>
#include <vector>

namespace pcl::cosection
{

/** \brief Readings of a frame in the world. */
struct PCL_COSECTION_EXPORT FramePoints
{
  std::vector<Eigen::Vector3f> points;       ///< metres, world frame
  std::vector<TriangleMesh::Colour> colours; ///< one per point
};

/** \brief Reads the frames that a run has read. */
class PCL_COSECTION_EXPORT FramePointReader
{
public:
  /** \param[in] dataset empty: the one that the run's summary names
   * \throws IoError if there is none, or it cannot be read */
  explicit FramePointReader (const RunScene& scene, const std::string& dataset = "");
  ~FramePointReader ();
  FramePointReader (FramePointReader&&) noexcept;
  FramePointReader& operator= (FramePointReader&&) noexcept;

  /** \brief The readings of the frame nearest to \a stamp, at the run's pose of the camera; none if there is no such
   * frame or no pose.
   * \param[in] every take every so many pixels along each axis
   * \throws IoError naming the image that cannot be read */
  FramePoints read (const RunScene& scene, double stamp, int every = 1) const;

private:
  std::unique_ptr<RgbdSequence> images_;
  std::vector<double> stamps_;
};

} // namespace pcl::cosection
