// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/io/pcd_view.h>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/** \brief Compares the labels of views of things at rest: a segmenter that sees one image after the other numbers their
 * objects anew in each. */
class LabelAgreement
{
public:
  /** \brief Compare the objects of a view with those of the views before.
   * \return a warning, if the points of a label lie on the surface of another label of these; nothing else */
  std::optional<std::string> add (const pcl::cosection::LabelledView& view);

private:
  pcl::PointCloud<pcl::PointXYZ> points_; // some of each label of each view, world frame
  std::vector<std::uint32_t> labels_;     // by point
};
