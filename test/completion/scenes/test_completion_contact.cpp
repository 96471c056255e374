// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "completion_fixture.h"

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

class CompletionContact : public Completion
{};

} // namespace

TEST_P (CompletionContact, IsRightWhereTheTableBoundsIt)
{
  EXPECT_LE (largestError (Provenance::Intersection, [] (const Eigen::Vector3d&) { return true; }), 2.25);
}

/** \brief Vertices marked as observed have the normals of the observed surface. */
TEST_P (CompletionContact, ObservedSurfaceFacesOutwards)
{
  const TriangleMesh& mesh = object ().mesh;
  std::size_t wrong = 0, observed = 0;
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
    if (mesh.provenance[v] == static_cast<std::uint8_t> (Provenance::Observed))
    {
      ++observed;
      const Eigen::Vector3d outward = gradient (scene_.shape (1), mesh.vertices[v].cast<double> ());
      wrong += mesh.normals[v].cast<double> ().dot (outward) < 0.0;
    }
  EXPECT_LE (wrong, observed / 100);
}

INSTANTIATE_TEST_SUITE_P (Table, CompletionContact, completionCases (), completionCaseName);
