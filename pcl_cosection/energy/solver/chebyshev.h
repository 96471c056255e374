// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pcl::cosection {

/** \brief Safety factor for an estimated largest eigenvalue. */
constexpr double chebyshev_safety = 1.08;

/** \brief Coefficients of a Chebyshev iteration of the fourth kind, which needs only the largest
 * eigenvalue of D^-1 A (J. Lottes, "Optimal polynomial smoothers for multigrid V-cycles", Numerical
 * Linear Algebra with Applications 2023): d <- momentum d + step D^-1 (b - A z), z <- z + d. */
class ChebyshevSteps
{
public:
  ChebyshevSteps (int degree, double largest_eigenvalue) : degree_ (degree), scale_ (1.0 / largest_eigenvalue) {}

  int degree () const { return degree_; }

  double momentum (int s) const { return (2.0 * s - 1.0) / (2.0 * s + 3.0); }

  double step (int s) const { return (8.0 * s + 4.0) / (2.0 * s + 3.0) * scale_; }

private:
  int degree_;
  double scale_;
};

} // namespace pcl::cosection
