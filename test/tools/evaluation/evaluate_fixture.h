// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/tool_run.h"

#include <pcl/cosection/io/mesh_io.h>

#include <string>
#include <vector>

namespace pcl::cosection::test {

using Words = std::vector<std::string>;

/** \brief Runs pcl_cosection_evaluate in a folder of its own. */
class Evaluate : public ToolTest
{
protected:
  Evaluate () : ToolTest (PCL_COSECTION_EVALUATE) {}

  void save (const std::string& name, const TriangleMesh& mesh) const { saveMesh (mesh, folder_.file (name)); }

  /** \brief One line, with the name of the program. */
  void expectOneLine (const std::string& part) const { expectErrorLine (errors_, "pcl_cosection_evaluate", part); }
};

} // namespace pcl::cosection::test
