// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "fusion_scene.h"

#include <filesystem>
#include <map>
#include <string>

/** \brief A folder with the sequence sim and what pcl_cosection_fusion made of it, out; made once for all tests.
 * pcl_cosection_viewer runs in that folder. */
class FusedScene : public FusionScene
{
protected:
  static void SetUpTestSuite ();

  FusedScene ();

  /** \brief Run the viewer, without a display unless \a prepare sets one. \return the exit status */
  int view (const Words& arguments, const std::function<void ()>& prepare = {});

  /** \brief It fails with a line that has \a part in it, and nothing else is said. */
  void expectNoView (const Words& arguments, int status, const std::string& part);

  /** \brief All files of a folder, with their contents and times. */
  std::map<std::string, std::pair<std::string, std::filesystem::file_time_type>>
  snapshot (const std::string& folder) const;
};
