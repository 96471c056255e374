// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grid_transfer.h"
#include "pcl_cosection/common/parallel.h"
#include "row_kernels.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace pcl::cosection {

/** \brief Values, one per voxel, with zeros before and behind them: vectorised loops may read over the
 * ends of a row, also of the first and the last. */
template <typename Real> class GuardedField
{
public:
  static constexpr int guard = 16; ///< values that are readable before and behind

  explicit GuardedField (std::size_t size = 0) : values_ (size + 2 * guard, Real (0)) {}

  std::size_t size () const { return values_.size () - 2 * guard; }

  Real* data () { return values_.data () + guard; }

  const Real* data () const { return values_.data () + guard; }

  Real& operator[] (std::size_t n) { return values_[guard + n]; }

private:
  std::vector<Real> values_;
};

/** \brief Galerkin products of a diagonal matrix: P^T diag (w) P, level by level.
 *
 * The entry between voxels I and J depends, per axis, on min (I, J) and |I - J| only, as tensor
 * products of symmetric one-dimensional pairs do; so 8 values a voxel describe the 27 entries of the
 * first coarse level and 27 values the 125 of the levels below. Most of them are zero, as data and active
 * bounds are thin; products pass over the zeros. */
template <typename Real> class GalerkinWeights
{
public:
  /** \brief Largest |I - J| per axis. */
  const std::array<int, 3>& span () const { return span_; }

  /** \brief Allocate for the level that is coarser than one with \a fine_span. */
  void allocate (const GridTransfer& transfer, const std::array<int, 3>& fine_span)
  {
    dims_ = transfer.coarseDims ();
    std::size_t count = 1;
    for (int axis = 0; axis < 3; ++axis)
    {
      const bool kept = transfer.axes[axis].coarse_size == transfer.axes[axis].fine_size;
      span_[axis] = kept ? fine_span[axis] : std::min (2, fine_span[axis] + 1);
      count *= span_[axis] + 1;
    }
    entries_.assign (count, GuardedField<Real> (static_cast<std::size_t> (dims_.x ()) * dims_.y () * dims_.z ()));
    const std::size_t rows = static_cast<std::size_t> (dims_.y ()) * dims_.z ();
    runs_.resize (rows * runCapacity ());
    run_count_.assign (rows, 0);
  }

  /** \brief Compute P^T diag (w) P from packed weights w on the finest level. */
  void coarsen (const GridTransfer& transfer, const std::uint16_t* diagonal, int threads)
  {
    const std::size_t plane = static_cast<std::size_t> (transfer.fineDims ().x ()) * transfer.fineDims ().y ();
    contract (transfer, {0, 0, 0}, threads, [&] (int, int z, Real* scratch) {
      for (std::size_t i = 0; i < plane; ++i)
        scratch[i] = kernels::unpackWeight (diagonal[z * plane + i]);
      return static_cast<const Real*> (scratch);
    });
  }

  /** \brief Compute P^T W P from the matrix W of the next finer level. */
  void coarsen (const GridTransfer& transfer, const GalerkinWeights& fine, int threads)
  {
    const std::size_t plane = static_cast<std::size_t> (fine.dims_.x ()) * fine.dims_.y ();
    contract (transfer, fine.span_, threads,
              [&] (int entry, int z, Real*) { return fine.entries_[entry].data () + z * plane; });
  }

  /** \brief out += row (j, k) of the matrix times v.
   * \param[in] v the values of a GuardedField
   * \param[in,out] out with room for GuardedField::guard values more than a row */
  void addRowProduct (const Real* v, int j, int k, Real* out) const
  {
    const int nx = dims_.x ();
    std::array<kernels::SymmetricRun<Real>, 64> batch;
    std::size_t count = 0;
    forEachCoupledRow (j, k, [&] (std::size_t from, std::size_t base, int b, int c) {
      const auto values = [&] (int a) { return a <= span_[0] ? entry (a, b, c) + base * nx : nullptr; };
      const kernels::SymmetricRun<Real> row{v + from * nx, values (0), values (1), values (2), 0, 0};
      int done = 0; // end of the last run: an entry couples to the next values of the row, where a new run may begin
      const Run* of_row = runs_.data () + base * runCapacity ();
      for (const Run* run = of_row; run != of_row + run_count_[base]; ++run)
      {
        const int begin = std::max (done, run->begin);
        const int size = std::min (nx, run->end + span_[0]) - begin;
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

  /** \brief out += sums of the absolute values of row (j, k), an upper bound of its eigenvalues. (At the
   * border interpolation extrapolates, with negative weights.) */
  void addAbsoluteRowSums (int j, int k, Real* out) const
  {
    const int nx = dims_.x ();
    forEachCoupledRow (j, k, [&] (std::size_t, std::size_t base, int b, int c) {
      for (int a = 0; a <= span_[0]; ++a)
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

private:
  /** \brief A part of a row with entries that are not zero. */
  struct Run
  {
    int begin;
    int end;
  };

  /** \brief The symmetric pair (x, x + a) of the fine axis contributes \a weight times its value. */
  struct PairSource
  {
    int x;
    int a;
    double weight;
  };

  /** \brief The entries between voxels with |I - J| = (a, b, c), by the voxel min (I, J). */
  const Real* entry (int a, int b, int c) const
  {
    return entries_[(c * (span_[1] + 1) + b) * (span_[0] + 1) + a].data ();
  }

  std::size_t runCapacity () const { return static_cast<std::size_t> (dims_.x ()) / (2 * kernels::run_block) + 1; }

  /** \brief Sources of every coarse pair (I, I + A), at [A * coarse_size + I]. */
  static std::vector<std::vector<PairSource>> pairSources (const AxisTransfer& transfer, int fine_span, int coarse_span)
  {
    std::vector<std::vector<PairSource>> sources (static_cast<std::size_t> (coarse_span + 1) * transfer.coarse_size);
    for (int x = 0; x < transfer.fine_size; ++x)
      for (int a = 0; a <= fine_span && x + a < transfer.fine_size; ++a)
        for (const auto& p : transfer.parents[x])
          for (const auto& q : transfer.parents[x + a])
          {
            // e_x e_y^T + e_y e_x^T (a > 0) gives both orders of a coarse pair, and twice its diagonal;
            // e_x e_x^T gives each order once, of which one is kept.
            if (p.weight == 0.0 || q.weight == 0.0 || (a == 0 && p.voxel > q.voxel))
              continue;
            const double weight = p.weight * q.weight * (a > 0 && p.voxel == q.voxel ? 2.0 : 1.0);
            auto& list = sources[static_cast<std::size_t> (std::abs (p.voxel - q.voxel)) * transfer.coarse_size +
                                 std::min (p.voxel, q.voxel)];
            const auto same = std::find_if (list.begin (), list.end (),
                                            [&] (const PairSource& s) { return s.x == x && s.a == a; });
            if (same != list.end ())
              same->weight += weight;
            else
              list.push_back ({x, a, weight});
          }
    return sources;
  }

  /** \brief Contract one axis after the other; \a plane (entry, z, scratch) gives a plane of the fine level. */
  template <typename PlaneFunction>
  void contract (const GridTransfer& transfer, const std::array<int, 3>& fine_span, int threads, PlaneFunction&& plane)
  {
    const Eigen::Vector3i f = transfer.fineDims ();
    const Eigen::Vector3i& c = dims_;
    std::array<std::vector<std::vector<PairSource>>, 3> sources;
    for (int axis = 0; axis < 3; ++axis)
      sources[axis] = pairSources (transfer.axes[axis], fine_span[axis], span_[axis]);

    const int fine_a = fine_span[0] + 1;
    const int fine_b = fine_span[1] + 1;
    const std::size_t fine_nx = f.x ();
    const std::size_t fine_plane = fine_nx * f.y ();
    parallelChunks (0, c.z (), threads, [&] (int first, int last) {
      std::vector<Real> scratch (fine_plane);
      std::vector<Real> planes (fine_plane * fine_a * fine_b);
      std::vector<Real> rows (fine_nx * fine_a);
      for (int k = first; k < last; ++k)
        for (int cc = 0; cc <= span_[2]; ++cc)
        {
          std::fill (planes.begin (), planes.end (), Real (0));
          for (const PairSource& source : sources[2][static_cast<std::size_t> (cc) * c.z () + k])
            for (int ba = 0; ba < fine_a * fine_b; ++ba)
              kernels::addScaledRow (plane (source.a * fine_a * fine_b + ba, source.x, scratch.data ()),
                                     static_cast<Real> (source.weight), static_cast<int> (fine_plane),
                                     planes.data () + ba * fine_plane);
          for (int bb = 0; bb <= span_[1]; ++bb)
            for (int j = 0; j < c.y (); ++j)
            {
              std::fill (rows.begin (), rows.end (), Real (0));
              for (const PairSource& source : sources[1][static_cast<std::size_t> (bb) * c.y () + j])
                for (int a = 0; a < fine_a; ++a)
                  kernels::addScaledRow (planes.data () + (source.a * fine_a + a) * fine_plane + source.x * fine_nx,
                                         static_cast<Real> (source.weight), f.x (), rows.data () + a * fine_nx);
              for (int aa = 0; aa <= span_[0]; ++aa)
              {
                Real* out = entries_[(cc * (span_[1] + 1) + bb) * (span_[0] + 1) + aa].data () +
                            (static_cast<std::size_t> (k) * c.y () + j) * c.x ();
                for (int i = 0; i < c.x (); ++i)
                {
                  Real sum = 0;
                  for (const PairSource& source : sources[0][static_cast<std::size_t> (aa) * c.x () + i])
                    sum += static_cast<Real> (source.weight) * rows[source.a * fine_nx + source.x];
                  out[i] = sum;
                }
              }
            }
        }
    });
    findRuns (threads);
  }

  void findRuns (int threads)
  {
    const int nx = dims_.x ();
    const std::size_t ny = dims_.y ();
    parallelFor (0, dims_.z (), threads, [&] (int k) {
      for (std::size_t row = k * ny; row < (k + 1) * ny; ++row)
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

  /** \brief f (row in v, row of entries, |dy|, |dz|) for every row that row (j, k) couples to. */
  template <typename Function> void forEachCoupledRow (int j, int k, Function&& f) const
  {
    if (entries_.empty ())
      return;
    const std::size_t ny = dims_.y ();
    for (int z = std::max (0, k - span_[2]); z <= std::min (dims_.z () - 1, k + span_[2]); ++z)
      for (int y = std::max (0, j - span_[1]); y <= std::min (dims_.y () - 1, j + span_[1]); ++y)
        f (z * ny + y, std::min (k, z) * ny + std::min (j, y), std::abs (y - j), std::abs (z - k));
  }

  Eigen::Vector3i dims_ = Eigen::Vector3i::Zero ();
  std::array<int, 3> span_{};
  std::vector<GuardedField<Real>> entries_; // [(c * (span_y + 1) + b) * (span_x + 1) + a]
  std::vector<Run> runs_;                   // runCapacity () a row
  std::vector<std::uint16_t> run_count_;    // by row
};

} // namespace pcl::cosection
