// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "galerkin_weights.h"

#include "row_kernels.h"

#include "pcl_cosection/common/parallel.h"

#include <algorithm>
#include <cstdlib>

namespace pcl::cosection {
namespace {

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

} // namespace

template <typename Real>
void
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
  entries_.assign (count, GuardedField<Real> (static_cast<std::size_t> (dims.x ()) * dims.y () * dims.z ()));
  const std::size_t rows = static_cast<std::size_t> (dims.y ()) * dims.z ();
  runs_.resize (rows * runCapacity ());
  run_count_.assign (rows, 0);
}

/** \brief Contract one axis after the other; \a plane (entry, z) gives a plane of the fine level. */
template <typename Real>
template <typename PlaneFunction>
void
GalerkinWeights<Real>::contract (const GridTransfer& transfer, const std::array<int, 3>& fine_span, int threads,
                                 PlaneFunction&& plane)
{
  const Eigen::Vector3i f = transfer.fineDims ();
  const Eigen::Vector3i c = dims;
  std::array<std::vector<std::vector<PairSource>>, 3> sources;
  for (int axis = 0; axis < 3; ++axis)
    sources[axis] = pairSources (transfer.axes[axis], fine_span[axis], span[axis]);

  const int fine_a = fine_span[0] + 1;
  const int fine_b = fine_span[1] + 1;
  const std::size_t fine_plane = static_cast<std::size_t> (f.x ()) * f.y ();
  parallelChunks (0, c.z (), threads, [&] (int first, int last) {
    std::vector<Real> scratch (fine_plane);
    std::vector<Real> planes (fine_plane * fine_a * fine_b);
    std::vector<Real> rows (static_cast<std::size_t> (f.x ()) * fine_a);
    for (int k = first; k < last; ++k)
      for (int cc = 0; cc <= span[2]; ++cc)
      {
        std::fill (planes.begin (), planes.end (), Real (0));
        for (const PairSource& source : sources[2][static_cast<std::size_t> (cc) * c.z () + k])
          for (int ba = 0; ba < fine_a * fine_b; ++ba)
            kernels::addScaledRow (plane (source.a * fine_a * fine_b + ba, source.x, scratch.data ()),
                                   static_cast<Real> (source.weight), static_cast<int> (fine_plane),
                                   planes.data () + ba * fine_plane);
        for (int bb = 0; bb <= span[1]; ++bb)
          for (int j = 0; j < c.y (); ++j)
          {
            std::fill (rows.begin (), rows.end (), Real (0));
            for (const PairSource& source : sources[1][static_cast<std::size_t> (bb) * c.y () + j])
              for (int a = 0; a < fine_a; ++a)
                kernels::addScaledRow (planes.data () + (source.a * fine_a + a) * fine_plane +
                                           static_cast<std::size_t> (source.x) * f.x (),
                                       static_cast<Real> (source.weight), f.x (),
                                       rows.data () + static_cast<std::size_t> (a) * f.x ());
            for (int aa = 0; aa <= span[0]; ++aa)
            {
              Real* out = entries_[(cc * (span[1] + 1) + bb) * (span[0] + 1) + aa].data () +
                          (static_cast<std::size_t> (k) * c.y () + j) * c.x ();
              for (int i = 0; i < c.x (); ++i)
              {
                Real sum = 0;
                for (const PairSource& source : sources[0][static_cast<std::size_t> (aa) * c.x () + i])
                  sum += static_cast<Real> (source.weight) *
                         rows[static_cast<std::size_t> (source.a) * f.x () + source.x];
                out[i] = sum;
              }
            }
          }
      }
  });
}

template <typename Real>
void
GalerkinWeights<Real>::coarsen (const GridTransfer& transfer, const std::uint16_t* diagonal, int threads)
{
  const std::size_t plane = static_cast<std::size_t> (transfer.fineDims ().x ()) * transfer.fineDims ().y ();
  contract (transfer, {0, 0, 0}, threads, [&] (int, int z, Real* scratch) {
    for (std::size_t i = 0; i < plane; ++i)
      scratch[i] = kernels::unpackWeight (diagonal[z * plane + i]);
    return static_cast<const Real*> (scratch);
  });
  findRuns (threads);
}

template <typename Real>
void
GalerkinWeights<Real>::coarsen (const GridTransfer& transfer, const GalerkinWeights& fine, int threads)
{
  const std::size_t plane = static_cast<std::size_t> (fine.dims.x ()) * fine.dims.y ();
  contract (transfer, fine.span, threads, [&] (int entry, int z, Real*) { return fine.entry (entry) + z * plane; });
  findRuns (threads);
}

template <typename Real>
template <typename Function>
void
GalerkinWeights<Real>::forEachCoupledRow (int j, int k, Function&& f) const
{
  if (entries_.empty ())
    return;
  for (int z = std::max (0, k - span[2]); z <= std::min (dims.z () - 1, k + span[2]); ++z)
    for (int y = std::max (0, j - span[1]); y <= std::min (dims.y () - 1, j + span[1]); ++y)
      f (static_cast<std::size_t> (z) * dims.y () + y,
         static_cast<std::size_t> (std::min (k, z)) * dims.y () + std::min (j, y), std::abs (y - j), std::abs (z - k));
}

template <typename Real>
void
GalerkinWeights<Real>::findRuns (int threads)
{
  const int nx = dims.x ();
  parallelFor (0, dims.z (), threads, [&] (int k) {
    for (std::size_t row = static_cast<std::size_t> (k) * dims.y (); row < static_cast<std::size_t> (k + 1) * dims.y ();
         ++row)
    {
      Run* of_row = runs_.data () + row * runCapacity ();
      std::uint16_t count = 0;
      for (int begin = 0; begin < nx; begin += kernels::run_block)
      {
        const int end = std::min (nx, begin + kernels::run_block);
        const bool zero = std::all_of (entries_.begin (), entries_.end (), [&] (const GuardedField<Real>& values) {
          const Real* v = values.data () + row * nx;
          return std::all_of (v + begin, v + end, [] (Real value) { return value == Real (0); });
        });
        if (zero)
          continue;
        if (count > 0 && of_row[count - 1].end == begin)
          of_row[count - 1].end = end;
        else
          of_row[count++] = {begin, end};
      }
      run_count_[row] = count;
    }
  });
}

template <typename Real>
void
GalerkinWeights<Real>::addRowProduct (const Real* v, int j, int k, Real* out) const
{
  const int nx = dims.x ();
  std::array<kernels::SymmetricRun<Real>, 64> batch;
  std::size_t count = 0;
  forEachCoupledRow (j, k, [&] (std::size_t from, std::size_t base, int b, int c) {
    const auto values = [&] (int a) { return a <= span[0] ? entry (a, b, c) + base * nx : nullptr; };
    const kernels::SymmetricRun<Real> row{v + from * nx, values (0), values (1), values (2), 0, 0};
    int done = 0; // end of the last run: an entry couples to the next values of the row, where a new run may begin
    const Run* of_row = runs_.data () + base * runCapacity ();
    for (const Run* run = of_row; run != of_row + run_count_[base]; ++run)
    {
      const int begin = std::max (done, run->begin);
      const int size = std::min (nx, run->end + span[0]) - begin;
      if (size <= 0)
        continue;
      batch[count] = row;
      batch[count].begin = begin;
      batch[count].blocks = (size + kernels::run_block - 1) / kernels::run_block;
      done = begin + batch[count].blocks * kernels::run_block;
      if (++count < batch.size ())
        continue;
      kernels::symmetricRuns (batch.data (), count, out);
      count = 0;
    }
  });
  kernels::symmetricRuns (batch.data (), count, out);
}

template <typename Real>
void
GalerkinWeights<Real>::addAbsoluteRowSums (int j, int k, Real* out) const
{
  const int nx = dims.x ();
  forEachCoupledRow (j, k, [&] (std::size_t, std::size_t base, int b, int c) {
    for (int a = 0; a <= span[0]; ++a)
    {
      const Real* values = entry (a, b, c) + base * nx;
      const Run* of_row = runs_.data () + base * runCapacity ();
      for (const Run* run = of_row; run != of_row + run_count_[base]; ++run)
        for (int i = run->begin; i < std::min (run->end, nx - a); ++i)
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

} // namespace pcl::cosection
