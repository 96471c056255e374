// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "energy.h"

#include "hessian_rows.h"

#include <algorithm>
#include <cmath>

namespace pcl
{
namespace cosection
{

LowerBound::LowerBound (float distance_vox, float weight)
: distance_ (static_cast<std::uint16_t> (std::lround (std::clamp (distance_vox, 0.0f, 255.0f) * 256.0f)))
, weight_ (weight > 0.0f ? kernels::packWeight (weight) : std::uint16_t (0))
{}

template <typename Real> double
evaluate (const EnergyProblem& problem, const HessianOperator<Real>& hessian, const Real* u, Real* residual,
          std::uint16_t* weights)
{
  const int nx = problem.dims.x ();
  const int ny = problem.dims.y ();
  const Real alpha = static_cast<Real> (problem.alpha);
  const LowerBound* exterior = problem.exterior.empty () ? nullptr : problem.exterior.data ();
  const LowerBound* intersection = problem.intersection.empty () ? nullptr : problem.intersection.data ();
  std::vector<double> rows (static_cast<std::size_t> (ny) * problem.dims.z ());
  hessian.forEachRow (u, [&] (int j, int k, const Real* product) {
    const std::size_t offset = (static_cast<std::size_t> (k) * ny + j) * nx;
    double sum = 0.0;
    for (int i = 0; i < nx; ++i)
    {
      const std::size_t n = offset + i;
      const Real value = u[n];
      float weight = problem.weight[n];
      const Real smooth = alpha * product[i] + static_cast<Real> (weight) * value;
      const Real target = problem.weighted_target[n];
      sum += static_cast<double> (value) * (static_cast<double> (smooth) - 2.0 * target);
      Real r = target - smooth;
      for (const LowerBound* bounds : {exterior, intersection})
      {
        if (!bounds || !bounds[n])
          continue;
        const Real violation = static_cast<Real> (bounds[n].distance ()) - value;
        if (violation <= Real (0))
          continue;
        const float beta = bounds[n].weight ();
        weight += beta;
        r += static_cast<Real> (beta) * violation;
        sum += static_cast<double> (beta) * violation * violation;
      }
      if (residual)
        residual[n] = r;
      if (weights)
        weights[n] = kernels::packWeight (weight);
    }
    rows[static_cast<std::size_t> (k) * ny + j] = sum;
  });
  double energy = 0.0;
  for (const double sum : rows)
    energy += sum;
  return energy;
}

template <typename Real> LineDerivatives
boundDerivatives (const EnergyProblem& problem, const Real* u, const Real* p, double t, int threads)
{
  const std::size_t plane = static_cast<std::size_t> (problem.dims.x ()) * problem.dims.y ();
  std::vector<LineDerivatives> planes (problem.dims.z ());
  const Real step = static_cast<Real> (t);
  parallelFor (0, problem.dims.z (), threads, [&] (int k) {
    LineDerivatives sum;
    for (const auto* bounds : {&problem.exterior, &problem.intersection})
    {
      if (bounds->empty ())
        continue;
      for (std::size_t n = k * plane; n < (k + 1) * plane; ++n)
      {
        const LowerBound& bound = (*bounds)[n];
        if (!bound)
          continue;
        const Real violation = static_cast<Real> (bound.distance ()) - u[n] - step * p[n];
        if (violation <= Real (0))
          continue;
        const double beta = bound.weight ();
        sum.slope -= beta * violation * p[n];
        sum.curvature += beta * p[n] * p[n];
      }
    }
    planes[k] = sum;
  });
  LineDerivatives total;
  for (const LineDerivatives& sum : planes)
  {
    total.slope += sum.slope;
    total.curvature += sum.curvature;
  }
  return total;
}

template <typename Real> double
evaluateEnergy (const EnergyProblem& problem, const std::vector<Real>& u, std::vector<Real>* residual, int threads)
{
  const HessianOperator<Real> hessian (problem.dims, threads);
  if (residual)
    residual->resize (u.size ());
  return evaluate (problem, hessian, u.data (), residual ? residual->data () : nullptr, nullptr);
}

EnergyProblem
coarsen (const EnergyProblem& problem, bool bounds, int threads)
{
  EnergyProblem coarse;
  const Eigen::Vector3i& fine = problem.dims;
  coarse.dims = (fine.array () + 1) / 2;
  coarse.alpha = problem.alpha / 2.0;
  coarse.weight.resize (coarse.size ());
  coarse.weighted_target.resize (coarse.size ());
  if (bounds && !problem.exterior.empty ())
    coarse.exterior.resize (coarse.size ());
  if (bounds && !problem.intersection.empty ())
    coarse.intersection.resize (coarse.size ());
  parallelFor (0, coarse.dims.z (), threads, [&] (int k) {
    for (int j = 0; j < coarse.dims.y (); ++j)
      for (int i = 0; i < coarse.dims.x (); ++i)
      {
        const std::size_t n = (static_cast<std::size_t> (k) * coarse.dims.y () + j) * coarse.dims.x () + i;
        const auto forEachChild = [&] (auto&& f) {
          for (int z = 2 * k; z < std::min (2 * k + 2, fine.z ()); ++z)
            for (int y = 2 * j; y < std::min (2 * j + 2, fine.y ()); ++y)
              for (int x = 2 * i; x < std::min (2 * i + 2, fine.x ()); ++x)
                f ((static_cast<std::size_t> (z) * fine.y () + y) * fine.x () + x);
        };
        float weight = 0.0f;
        float target = 0.0f;
        forEachChild ([&] (std::size_t child) {
          weight += problem.weight[child];
          target += problem.weighted_target[child];
        });
        coarse.weight[n] = weight;
        coarse.weighted_target[n] = target;
        const auto gather = [&] (const std::vector<LowerBound>& from, std::vector<LowerBound>& to) {
          if (to.empty ())
            return;
          float beta = 0.0f;
          float distance = 0.0f;
          forEachChild ([&] (std::size_t child) {
            beta += from[child].weight ();
            distance += from[child].weight () * from[child].distance ();
          });
          if (beta > 0.0f)
            to[n] = LowerBound (distance / beta, beta);
        };
        gather (problem.exterior, coarse.exterior);
        gather (problem.intersection, coarse.intersection);
      }
  });
  return coarse;
}

#define PCL_COSECTION_INSTANTIATE(Real)                                                                              \
  template double evaluate<Real> (const EnergyProblem&, const HessianOperator<Real>&, const Real*, Real*,            \
                                  std::uint16_t*);                                                                   \
  template LineDerivatives boundDerivatives<Real> (const EnergyProblem&, const Real*, const Real*, double, int);     \
  template double evaluateEnergy<Real> (const EnergyProblem&, const std::vector<Real>&, std::vector<Real>*, int);

PCL_COSECTION_INSTANTIATE (float)
PCL_COSECTION_INSTANTIATE (double)

} // namespace cosection
} // namespace pcl
