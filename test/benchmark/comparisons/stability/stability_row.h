// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/physics/physical_scene.h"

#include <cstddef>
#include <string>
#include <vector>

/** \brief How the bodies of some scenes rest when a simulator moves them: a row of a table. */
class StabilityRow
{
public:
  explicit StabilityRow (std::string method) : method_ (std::move (method)) {}

  /** \brief Simulate a scene, and say on the error stream what does not stay.
   * \param[in] name of the scene, for that
   * \param[in] objects how many there are: what has no body is missing
   * \param[in] folder for the scene's files, which is removed */
  void add (const std::string& name, std::size_t objects, const pcl::cosection::PhysicalScene& scene,
            const std::string& folder);

  /** \brief Two lines of Markdown. */
  static std::string head ();

  /** \brief A line of Markdown. */
  std::string text () const;

private:
  /** \brief \return whether the simulation did not fail */
  bool simulate (const std::string& file, const std::string& who);

  std::string method_;
  std::size_t scenes_ = 0, failed_scenes_ = 0;
  std::size_t bodies_ = 0, missing_ = 0, stayed_ = 0, flown_ = 0;
  std::vector<double> drifts_m_;   ///< of bodies, where the simulation did not fail
  std::vector<double> contacts_m_; ///< the deepest one of each scene before the first step
};
