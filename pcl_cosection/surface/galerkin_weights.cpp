// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "galerkin_weights.h"

#include "row_kernels.h"

#include <pcl/cosection/common/parallel.h>

#include <algorithm>
#include <cstdlib>

namespace pcl
{
namespace cosection
{

namespace
{

/** \brief The symmetric pair (x, x + a) of the fine axis contributes \a weight times its value. */
struct PairSource
{
  int x;
  int a;
  double weight;
};

/** \brief Sources of every coarse pair (I, I + A), at [A * coarse_size + I]. */
std::vector<std::vector<PairSource>>
pairSources (const AxisTransfer& transfer, int fine_span, int coarse_span)
{
  std::vector<std::vector<PairSource>> sources (static_cast<std::size_t> (coarse_span + 1) * transfer.coarse_size);
  for (int x = 0; x < transfer.fine_size; ++x)
    for (int a = 0; a <= fine_span && x + a < transfer.fine_size; ++a)
      for (const auto& p : transfer.parents[x])
        for (const auto& q : transfer.parents[x + a])
        {
          if (p.weight == 0.0 || q.weight == 0.0)
            continue;
          // e_x e_y^T + e_y e_x^T (a > 0) gives both orders of a coarse pair, and twice its diagonal;
          // e_x e_x^T gives each order once, of which one is kept.
          double weight = p.weight * q.weight;
          if (a > 0 && p.coarse == q.coarse)
            weight *= 2.0;
          if (a == 0 && p.coarse > q.coarse)
            continue;
          auto& list = sources[static_cast<std::size_t> (std::abs (p.coarse - q.coarse)) * transfer.coarse_size +
                               std::min (p.coarse, q.coarse)];
          const auto same = std::find_if (list.begin (), list.end (),
                                          [&] (const PairSource& s) { return s.x == x && s.a == a; });
          if (same != list.end ())
            same->weight += weight;
          else
            list.push_back ({x, a, weight});
        }
  return sources;
}

/** \brief Contract one axis after the other; \a plane (entry, z) gives a plane of the fine level. */
template <typename Real, typename PlaneFunction> void
contract (const GridTransfer& transfer, const std::array<int, 3>& fine_span, GalerkinWeights<Real>& coarse, int threads,
          PlaneFunction&& plane)
{
  const Eigen::Vector3i f = transfer.fineDims ();
  const Eigen::Vector3i c = coarse.dims;
  std::array<std::vector<std::vector<PairSource>>, 3> sources;
  for (int axis = 0; axis < 3; ++axis)
    sources[axis] = pairSources (transfer.axes[axis], fine_span[axis], coarse.span[axis]);

  const int fine_a = fine_span[0] + 1;
  const int fine_b = fine_span[1] + 1;
  const std::size_t fine_plane = static_cast<std::size_t> (f.x ()) * f.y ();
  parallelChunks (0, c.z (), threads, [&] (int first, int last) {
    std::vector<Real> scratch (fine_plane);
    std::vector<Real> planes (fine_plane * fine_a * fine_b);
    std::vector<Real> rows (static_cast<std::size_t> (f.x ()) * fine_a);
    for (int k = first; k < last; ++k)
      for (int cc = 0; cc <= coarse.span[2]; ++cc)
      {
        std::fill (planes.begin (), planes.end (), Real (0));
        for (const PairSource& source : sources[2][static_cast<std::size_t> (cc) * c.z () + k])
          for (int ba = 0; ba < fine_a * fine_b; ++ba)
            kernels::addScaledRow (plane (source.a * fine_a * fine_b + ba, source.x, scratch.data ()),
                                   static_cast<Real> (source.weight), static_cast<int> (fine_plane),
                                   planes.data () + ba * fine_plane);
        for (int bb = 0; bb <= coarse.span[1]; ++bb)
          for (int j = 0; j < c.y (); ++j)
          {
            std::fill (rows.begin (), rows.end (), Real (0));
            for (const PairSource& source : sources[1][static_cast<std::size_t> (bb) * c.y () + j])
              for (int a = 0; a < fine_a; ++a)
                kernels::addScaledRow (planes.data () + (source.a * fine_a + a) * fine_plane +
                                           static_cast<std::size_t> (source.x) * f.x (),
                                       static_cast<Real> (source.weight), f.x (),
                                       rows.data () + static_cast<std::size_t> (a) * f.x ());
            for (int aa = 0; aa <= coarse.span[0]; ++aa)
            {
              Real* out = coarse.entries[(cc * (coarse.span[1] + 1) + bb) * (coarse.span[0] + 1) + aa].data () +
                          (static_cast<std::size_t> (k) * c.y () + j) * c.x ();
              for (int i = 0; i < c.x (); ++i)
              {
                Real sum = 0;
                for (const PairSource& source : sources[0][static_cast<std::size_t> (aa) * c.x () + i])
                  sum += static_cast<Real> (source.weight) * rows[static_cast<std::size_t> (source.a) * f.x () + source.x];
                out[i] = sum;
              }
            }
          }
      }
  });
}

} // namespace

template <typename Real> void
GalerkinWeights<Real>::allocate (const GridTransfer& transfer, const std::array<int, 3>& fine_span)
{
  dims = transfer.coarseDims ();
  std::size_t count = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    const bool kept = transfer.axes[axis].coarse_size == transfer.axes[axis].fine_size;
    span[axis] = kept ? fine_span[axis] : std::min (2, fine_span[axis] + 1);
    count *= span[axis] + 1;
  }
  entries.resize (count);
  for (auto& values : entries)
    values.assign (static_cast<std::size_t> (dims.x ()) * dims.y () * dims.z (), Real (0));
}

template <typename Real> void
GalerkinWeights<Real>::coarsen (const GridTransfer& transfer, const std::uint16_t* diagonal, int threads)
{
  const std::size_t plane = static_cast<std::size_t> (transfer.fineDims ().x ()) * transfer.fineDims ().y ();
  contract (transfer, {0, 0, 0}, *this, threads, [&] (int, int z, Real* scratch) {
    for (std::size_t i = 0; i < plane; ++i)
      scratch[i] = kernels::unpackWeight (diagonal[z * plane + i]);
    return static_cast<const Real*> (scratch);
  });
}

template <typename Real> void
GalerkinWeights<Real>::coarsen (const GridTransfer& transfer, const GalerkinWeights& fine, int threads)
{
  const std::size_t plane = static_cast<std::size_t> (fine.dims.x ()) * fine.dims.y ();
  contract (transfer, fine.span, *this, threads,
            [&] (int entry, int z, Real*) { return fine.entries[entry].data () + z * plane; });
}

template <typename Real>
template <typename Function> void
GalerkinWeights<Real>::forEachCoupledRow (int j, int k, Function&& f) const
{
  if (entries.empty ())
    return;
  for (int z = std::max (0, k - span[2]); z <= std::min (dims.z () - 1, k + span[2]); ++z)
    for (int y = std::max (0, j - span[1]); y <= std::min (dims.y () - 1, j + span[1]); ++y)
      f ((static_cast<std::size_t> (z) * dims.y () + y) * dims.x (),
         (static_cast<std::size_t> (std::min (k, z)) * dims.y () + std::min (j, y)) * dims.x (), std::abs (y - j),
         std::abs (z - k));
}

template <typename Real> void
GalerkinWeights<Real>::addRowProduct (const Real* v, int j, int k, Real* out) const
{
  forEachCoupledRow (j, k, [&] (std::size_t from, std::size_t base, int b, int c) {
    kernels::symmetricRow (v + from, entry (0, b, c).data () + base, span[0] > 0 ? entry (1, b, c).data () + base : nullptr,
                           span[0] > 1 ? entry (2, b, c).data () + base : nullptr, dims.x (), out);
  });
}

template <typename Real> void
GalerkinWeights<Real>::addAbsoluteRowSums (int j, int k, Real* out) const
{
  const int nx = dims.x ();
  forEachCoupledRow (j, k, [&] (std::size_t, std::size_t base, int b, int c) {
    for (int a = 0; a <= span[0]; ++a)
    {
      const Real* values = entry (a, b, c).data () + base;
      for (int i = 0; i + a < nx; ++i)
      {
        out[i] += std::abs (values[i]);
        if (a > 0)
          out[i + a] += std::abs (values[i]);
      }
    }
  });
}

template struct GalerkinWeights<float>;
template struct GalerkinWeights<double>;

} // namespace cosection
} // namespace pcl
