// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "completion_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

namespace pcl::cosection::test {

struct CompletionView
{
  double voxel_m;
  bool from_above;
};

/** \brief A shape on a table, seen once from one side. */
class Completion : public testing::TestWithParam<std::tuple<Shape, CompletionView>>
{
protected:
  void SetUp () override
  {
    ASSERT_EQ (result_.objects.size (), 1u);
    ASSERT_EQ (object ().error, "");
  }

  const ObjectResult& object () const { return result_.objects.front (); }

  /** \brief Largest distance to the true surface, in voxels, over the vertices of a provenance for which \a where
   * holds. */
  template <typename Where> double largestError (Provenance provenance, Where&& where) const
  {
    double largest = 0.0;
    const TriangleMesh& mesh = object ().mesh;
    for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
    {
      const Eigen::Vector3d p = mesh.vertices[v].cast<double> ();
      if (mesh.provenance[v] == static_cast<std::uint8_t> (provenance) && where (p))
        largest = std::max (largest, std::abs (scene_.shape (1) (p)));
    }
    return largest / voxel_m_;
  }

  const double voxel_m_ = std::get<1> (GetParam ()).voxel_m;
  const AnalyticScene scene_ = tableScene (std::get<0> (GetParam ()));
  const Eigen::Isometry3d T_world_sensor_ = std::get<1> (GetParam ()).from_above ? fromAbove () : fromTheFront ();
  const RenderedView seen_ = scene_.render (tableCamera (), T_world_sensor_);
  const SceneResult result_ = complete (seen_, optionsFor (voxel_m_));
};

/** \brief All shapes, coarse and fine, from above and from the front. */
inline auto
completionCases ()
{
  return testing::Combine (testing::Values (Shape::Sphere, Shape::Box, Shape::Torus, Shape::Cup),
                           testing::Values (CompletionView{0.004, false}, CompletionView{0.006, true}));
}

inline std::string
completionCaseName (const testing::TestParamInfo<std::tuple<Shape, CompletionView>>& info)
{
  const CompletionView& view = std::get<1> (info.param);
  return nameOf (std::get<0> (info.param)) + std::to_string (static_cast<int> (1000.0 * view.voxel_m + 0.5)) + "mm" +
         (view.from_above ? "FromAbove" : "FromTheFront");
}

} // namespace pcl::cosection::test
