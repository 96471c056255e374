// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "energy.h"

#include "hessian_rows.h"
#include "pcl_cosection/common/parallel.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pcl::cosection {

LowerBound::LowerBound (float distance_vox, float weight)
{
  if (weight > 0.0f)
    bits_ = static_cast<std::uint32_t> (kernels::packWeight (weight)) << 16 |
            static_cast<std::uint32_t> (std::lround (std::clamp (distance_vox, 0.0f, 255.0f) * 256.0f));
}

template <typename Real>
double
evaluate (const EnergyProblem& problem, const HessianOperator<Real>& hessian, const Real* u, Real* residual,
          std::uint16_t* weights)
{
  const int nx = problem.dims.x ();
  const int ny = problem.dims.y ();
  std::vector<double> planes (problem.dims.z (), 0.0); // each plane is summed by one thread, row after row
  hessian.forEachRow (u, [&] (int j, int k, const Real* product) {
    const std::size_t at = (static_cast<std::size_t> (k) * ny + j) * nx;
    planes[k] += kernels::evaluateRow (energyRow (problem, at), product, u + at, static_cast<Real> (problem.alpha), nx,
                                       residual ? residual + at : nullptr, weights ? weights + at : nullptr);
  });
  return std::accumulate (planes.begin (), planes.end (), 0.0);
}

template <typename Real>
void
predictActiveSet (const EnergyProblem& problem, const Real* u, const Real* p, Real* residual, std::uint16_t* weights,
                  int threads)
{
  const std::size_t plane = static_cast<std::size_t> (problem.dims.x ()) * problem.dims.y ();
  parallelFor (0, problem.dims.z (), threads, [&] (int k) {
    const std::size_t at = k * plane;
    kernels::predictRow (energyRow (problem, at), u + at, p + at, static_cast<int> (plane), residual + at,
                         weights + at);
  });
}

template <typename Real>
kernels::LinePair
boundDerivatives (const EnergyProblem& problem, const Real* u, const Real* p, double t_1, double t_2, int threads)
{
  const std::size_t plane = static_cast<std::size_t> (problem.dims.x ()) * problem.dims.y ();
  std::vector<kernels::LinePair> planes (problem.dims.z ());
  parallelFor (0, problem.dims.z (), threads, [&] (int k) {
    const std::size_t at = k * plane;
    planes[k] = kernels::boundsRow (energyRow (problem, at), u + at, p + at, static_cast<Real> (t_1),
                                    static_cast<Real> (t_2), static_cast<int> (plane));
  });
  kernels::LinePair all;
  for (const kernels::LinePair& of_plane : planes)
    all += of_plane;
  return all;
}

template <typename Real>
double
evaluateEnergy (const EnergyProblem& problem, const std::vector<Real>& u, std::vector<Real>* residual, int threads)
{
  const HessianOperator<Real> hessian (problem.dims, threads);
  if (!residual)
    return evaluate<Real> (problem, hessian, u.data (), nullptr, nullptr);
  residual->resize (u.size ());
  std::vector<std::uint16_t> weights (u.size ());
  return evaluate (problem, hessian, u.data (), residual->data (), weights.data ());
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
        forEachChild ([&] (std::size_t child) {
          coarse.weight[n] += problem.weight[child];
          coarse.weighted_target[n] += problem.weighted_target[child];
        });
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

#define PCL_COSECTION_INSTANTIATE(Real)                                                                                \
  template double evaluate<Real> (const EnergyProblem&, const HessianOperator<Real>&, const Real*, Real*,              \
                                  std::uint16_t*);                                                                     \
  template void predictActiveSet<Real> (const EnergyProblem&, const Real*, const Real*, Real*, std::uint16_t*, int);   \
  template kernels::LinePair boundDerivatives<Real> (const EnergyProblem&, const Real*, const Real*, double, double,   \
                                                     int);                                                             \
  template double evaluateEnergy<Real> (const EnergyProblem&, const std::vector<Real>&, std::vector<Real>*, int);

PCL_COSECTION_INSTANTIATE (float)
PCL_COSECTION_INSTANTIATE (double)

} // namespace pcl::cosection
