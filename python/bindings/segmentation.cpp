// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "arrays.h"
#include "bindings.h"

#include "pcl_cosection/segmentation/clusters/cloud_segmentation.h"

#include <pcl/cosection/segmentation/geometric_segmentation.h>

#include <cstring>

namespace py = pybind11;
using namespace pcl::cosection;

namespace {

/** \brief Labels of height x width points of the sensor's frame, and the planes on which objects stand. */
py::tuple
segment (const DenseArray<float>& points, double max_object_size_m, double min_object_size_m,
         double min_support_area_m2, double concave_angle_rad, int threads)
{
  OrganizedCloud cloud;
  cloud.height = static_cast<int> (points.shape (0));
  cloud.width = static_cast<int> (points.shape (1));
  cloud.points.resize (static_cast<std::size_t> (cloud.width) * static_cast<std::size_t> (cloud.height));
  std::memcpy (static_cast<void*> (cloud.points.data ()), points.data (),
               cloud.points.size () * sizeof (Eigen::Vector3f));
  ObjectSegmentationOptions options;
  options.max_object_size_m = max_object_size_m;
  options.min_object_size_m = min_object_size_m;
  options.min_support_area_m2 = min_support_area_m2;
  options.concave_angle_rad = concave_angle_rad;
  options.threads = threads;
  const ObjectSegmentation found = [&] {
    const py::gil_scoped_release unlocked;
    return segmentCloud (cloud, options);
  }();
  py::array_t<std::int32_t> labels ({points.shape (0), points.shape (1)});
  for (std::size_t n = 0; n < found.labels.size (); ++n)
    labels.mutable_data ()[n] = static_cast<std::int32_t> (found.labels[n]);
  py::list planes;
  for (const Eigen::Vector4f& plane : found.support_planes)
    planes.append (py::make_tuple (plane[0], plane[1], plane[2], plane[3]));
  return py::make_tuple (labels, planes);
}

} // namespace

void
bindSegmentation (py::module_& module)
{
  const ObjectSegmentationOptions defaults;
  module.def ("segment", segment, py::arg ("points"), py::kw_only (),
              py::arg ("max_object_size_m") = defaults.max_object_size_m,
              py::arg ("min_object_size_m") = defaults.min_object_size_m,
              py::arg ("min_support_area_m2") = defaults.min_support_area_m2,
              py::arg ("concave_angle_rad") = defaults.concave_angle_rad, py::arg ("threads") = 0);
}
