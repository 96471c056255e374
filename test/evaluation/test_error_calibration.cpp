// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

#include "pcl_cosection/evaluation/error_calibration.h"

#include "common/small_meshes.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace pcl::cosection;

namespace {

/** \brief Errors that are as large as expected: Gaussians whose sigma is between 1 and 10 mm. */
std::vector<VertexError>
calibratedErrors (std::size_t count)
{
  std::mt19937 random (1);
  std::uniform_real_distribution<double> sigma_m (0.001, 0.01);
  std::normal_distribution<double> unit;
  std::vector<VertexError> errors (count);
  for (std::size_t n = 0; n < count; ++n)
  {
    errors[n].sigma_m = sigma_m (random);
    errors[n].error_m = std::abs (errors[n].sigma_m * unit (random));
    errors[n].provenance = static_cast<std::uint8_t> (n % 4);
  }
  return errors;
}

} // namespace

TEST (ErrorCoverage, OfGaussiansIsTheirs)
{
  const std::vector<VertexError> errors = calibratedErrors (40000);
  const ErrorCoverage coverage = errorCoverage (errors);
  EXPECT_EQ (coverage.vertices, 40000u);
  EXPECT_NEAR (coverage.within_sigma, 0.683, 0.01);
  EXPECT_NEAR (coverage.within_two_sigma, 0.954, 0.005);
  EXPECT_NEAR (coverage.mean_sigma_m, 0.0055, 0.0001);
  EXPECT_EQ (errorCoverage (errors, Provenance::Hull).vertices, 10000u);
  EXPECT_NEAR (errorCoverage (errors, Provenance::Hull).within_two_sigma, 0.954, 0.01);
  EXPECT_EQ (errorCoverage ({}).vertices, 0u);
}

TEST (CalibrationCurve, IsTheDiagonalForErrorsAsExpected)
{
  const std::vector<ErrorCoverage> curve = calibrationCurve (calibratedErrors (40000), 8);
  ASSERT_EQ (curve.size (), 8u);
  double last_m = 0.0;
  for (const ErrorCoverage& coverage : curve)
  {
    EXPECT_EQ (coverage.vertices, 5000u);
    EXPECT_GT (coverage.mean_sigma_m, last_m);
    EXPECT_NEAR (coverage.p95_error_m / (1.96 * coverage.mean_sigma_m), 1.0, 0.1);
    last_m = coverage.mean_sigma_m;
  }
  EXPECT_EQ (calibrationCurve (calibratedErrors (3), 8).size (), 3u);
}

TEST (RankCorrelation, ShowsWhetherSigmaIsInformative)
{
  std::vector<VertexError> errors;
  for (int n = 0; n < 100; ++n)
    errors.push_back ({0.001 * n, 0.0002 * n * n, 0});
  EXPECT_DOUBLE_EQ (rankCorrelation (errors), 1.0);
  for (VertexError& vertex : errors)
    vertex.sigma_m = 1.0 - vertex.sigma_m;
  EXPECT_DOUBLE_EQ (rankCorrelation (errors), -1.0);
  for (VertexError& vertex : errors)
    vertex.sigma_m = 0.005;
  EXPECT_EQ (rankCorrelation (errors), 0.0);
  EXPECT_EQ (rankCorrelation ({}), 0.0);
  EXPECT_GT (rankCorrelation (calibratedErrors (1000)), 0.2);
}

TEST (VertexErrors, AreDistancesToTheTruth)
{
  const TriangleMesh truth = test::boxMesh ({0, 0, 0}, {1, 1, 1});
  TriangleMesh mesh = test::boxMesh ({0, 0, 0}, {1, 1, 1.1f});
  EXPECT_TRUE (vertexErrors (SurfaceDistance (truth), mesh).empty ()); // it has no sigma
  mesh.provenance.assign (8, 1);
  mesh.sigma_m.assign (8, 0.06f);
  const std::vector<VertexError> errors = vertexErrors (SurfaceDistance (truth), mesh);
  ASSERT_EQ (errors.size (), 8u);
  for (std::size_t v = 0; v < errors.size (); ++v)
    EXPECT_NEAR (errors[v].error_m, mesh.vertices[v].z () > 1.0f ? 0.1 : 0.0, 1e-6);
  EXPECT_EQ (errorCoverage (errors).within_sigma, 0.5);
  EXPECT_EQ (errorCoverage (errors).within_two_sigma, 1.0);
}

TEST (ShareInside, CountsTheSurfaceThatABoundHolds)
{
  const TriangleMesh inner = test::boxMesh ({0.1f, 0.1f, 0.1f}, {0.9f, 0.9f, 0.9f});
  const TriangleMesh half = test::boxMesh ({-1, -1, -1}, {2, 2, 0.5f});
  EXPECT_EQ (shareInside (inner, test::boxMesh ({0, 0, 0}, {1, 1, 1}), 0.0, 1000, 0), 1.0);
  EXPECT_EQ (shareInside (test::boxMesh ({0, 0, 0}, {1, 1, 1}), inner, 0.05, 1000, 0), 0.0);
  EXPECT_EQ (shareInside (test::boxMesh ({0, 0, 0}, {1, 1, 1}), inner, 0.2, 1000, 0), 1.0);
  EXPECT_NEAR (shareInside (inner, half, 0.0, 10000, 0), 0.5, 0.02);
  TriangleMesh open = half;
  open.triangles.pop_back ();
  EXPECT_THROW (shareInside (inner, open, 0.0, 1000, 0), InvalidArgument);
}
