// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "bindings.h"

#include <pcl/cosection/version.h>

PYBIND11_MODULE (_core, module)
{
  module.doc () = "What pcl_cosection's Python code needs of the C++ library. Use pcl_cosection instead.";
  module.attr ("__version__") = PCL_COSECTION_VERSION;
  bindErrors (module);
  bindMeshes (module);
  bindCompletion (module);
  bindSegmentation (module);
  bindEvaluation (module);
  bindFusion (module);
}
