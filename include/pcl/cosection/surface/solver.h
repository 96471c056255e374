// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/surface/options.h>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief A one-sided quadratic penalty beta max (0, d - u)^2 at one voxel, in four bytes: the
 * distance in steps of 1/256 voxel up to 255 voxels, the weight with eight significant bits. */
class PCL_COSECTION_EXPORT LowerBound
{
public:
  LowerBound () = default;

  /** \brief A bound.
   * \param[in] distance_vox d, clamped to [0, 255]
   * \param[in] weight beta >= 0 */
  LowerBound (float distance_vox, float weight);

  /** \brief d, voxels. */
  float distance () const { return static_cast<float> (bits_ & 0xffffu) * (1.0f / 256.0f); }

  /** \brief beta. */
  float weight () const
  {
    const std::uint32_t bits = bits_ & 0xffff0000u;
    float value;
    std::memcpy (&value, &bits, sizeof (value));
    return value;
  }

  /** \brief False where there is no bound. */
  explicit operator bool () const { return (bits_ & 0xffff0000u) != 0; }

  /** \brief Whether distance and weight are equal, as they are stored. */
  bool operator== (const LowerBound& other) const { return bits_ == other.bits_; }

private:
  std::uint32_t bits_ = 0; // the upper half of the weight as a float, and the distance in its steps
};

/** \brief The energy of the paper on one grid, in units of voxels:
 *
 *     E (u) = sum_x (W u^2 - 2 C u)  +  alpha ||H u||_F^2
 *           + sum_x beta_e max (0, d_e - u)^2  +  sum_x beta_i max (0, d_i - u)^2
 *
 * with the data term of equation (2) gathered in W = sum w_i and C = sum w_i f_i (each divided by
 * the count for mean weighting; the constant sum w_i f_i^2 is left out), the \e exterior bound from
 * the hull, equation (3), or from the extent prior (their domains are disjoint), and the
 * \e intersection bound of equation (5). */
struct PCL_COSECTION_EXPORT EnergyProblem
{
  Eigen::Vector3i dims = Eigen::Vector3i::Zero (); ///< voxels along x, y, z; x varies fastest
  double alpha = 0.005;                            ///< weight of the Hessian, voxel units
  std::vector<float> weight;                       ///< W, one per voxel
  std::vector<float> weighted_target;              ///< C, voxels
  std::vector<LowerBound> exterior;                ///< one per voxel, or empty
  std::vector<LowerBound> intersection;            ///< one per voxel, or empty

  /** \brief Number of voxels. */
  std::size_t size () const { return static_cast<std::size_t> (dims.x ()) * dims.y () * dims.z (); }
};

/** \brief The energy on a grid of half the resolution, with u still in fine voxels: W, C and the
 * weights of the bounds summed over the children, distances averaged by weight, alpha halved.
 * Without \a bounds they are left out. */
PCL_COSECTION_EXPORT EnergyProblem coarsen (const EnergyProblem& problem, bool bounds, int threads = 0);

/** \brief E (u) and, if asked for, minus half its gradient.
 * \param[in] problem the energy
 * \param[in] u one value per voxel, voxels
 * \param[out] residual -dE/du / 2, one value per voxel, or null
 * \param[in] threads 0: all */
template <typename Real>
PCL_COSECTION_EXPORT double evaluateEnergy (const EnergyProblem& problem, const std::vector<Real>& u,
                                            std::vector<Real>* residual = nullptr, int threads = 0);

/** \brief Why a solver stopped. */
enum class Termination
{
  Converged,     ///< within the tolerance of the solution, as far as the last changes show
  MaxIterations, ///< the iterations were used up
};

/** \brief What a solver did. */
struct PCL_COSECTION_EXPORT SolverSummary
{
  Termination termination = Termination::MaxIterations; ///< why it stopped
  int iterations = 0;                                   ///< on the finest level
  double energy = 0.0;                                  ///< E (u) at the end, voxel units
  double change_vox = 0.0;      ///< root mean square change near the zero set in the last iteration
  double seconds = 0.0;         ///< that it took
  std::vector<double> energies; ///< E at the start and after every iteration on the finest level; never rises

  /** \brief Whether the solution is within the tolerance. */
  bool converged () const { return termination == Termination::Converged; }
};

/** \brief Minimise an energy.
 * \code
 * std::vector<float> u; // empty: coarse to fine
 * const SolverSummary summary = solve (problem, SolverOptions (), u);
 * \endcode
 * \param[in] problem dims of at least 1; one weight and one weighted target per voxel
 * \param[in] options of the solver
 * \param[in,out] u the field in voxels; if its size is not that of the problem, the solver starts
 * coarse to fine, else from the values given, on the finest level only
 * \param[in] progress called now and then, may cancel
 * \throws Cancelled if \a progress returns false */
template <typename Real>
PCL_COSECTION_EXPORT SolverSummary solve (const EnergyProblem& problem, const SolverOptions& options,
                                          std::vector<Real>& u, const ProgressCallback& progress = {});

/** \cond */
extern template SolverSummary solve<float> (const EnergyProblem&, const SolverOptions&, std::vector<float>&,
                                            const ProgressCallback&);
extern template SolverSummary solve<double> (const EnergyProblem&, const SolverOptions&, std::vector<double>&,
                                             const ProgressCallback&);
/** \endcond */

} // namespace pcl::cosection
