// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief How the measurements at a voxel are combined. */
enum class Weighting
{
  Mean, ///< divided by the number of points within the cut-off: bounded whatever the number of views
  Sum,  ///< equation (2) as printed
};

/** \brief The distance that the hull constraint asks for in free space. */
enum class HullDistance
{
  Exact,    ///< Euclidean distance to the hull
  OneVoxel, ///< the paper's lower bound
};

/** \brief How the energy is minimised. */
enum class SolverType
{
  Multigrid,  ///< semismooth Newton method; steps by multigrid cycles and the last direction
  FastJacobi, ///< the paper's optimiser, coarse to fine
};

/** \brief The priors: what is expected where nothing was measured and no constraint decides. They need
 * CoSectionOptions::use_extent_prior. */
struct PCL_COSECTION_EXPORT Priors
{
  bool extent = true;     ///< the shape ends so far from what was seen of it; without it, a volume of fixed padding
  bool symmetry = true;   ///< copies by mirror planes and turns for which the points are evidence
  bool revolution = true; ///< solid surfaces of revolution look the same from all sides
  bool vessels = true;    ///< cups, bowls, plates and open boxes have walls of one thickness
  bool extrusion = true;  ///< what is hidden below an observed surface reaches the plane
  bool plane = true;      ///< an object without known surroundings shows the plane on which it stands
  bool rays = true;       ///< nothing is on rays without return beside an object that was cut out
  bool learned = true;    ///< what CoSectionOptions::completion_network expects, if there is one
  bool proposals = true;  ///< meshes that the user proposes, where they explain what was measured

  /** \brief The names of those that are on, separated by commas: those of the members; or "all", or "none". */
  std::string names () const;

  /** \brief Those that are named, as names () has it. \throws InvalidArgument */
  static Priors named (const std::string& names);
};

/** \brief A network that has learned what the hidden sides of things look like: the learned prior.
 *
 * It sees an object in a cube of voxels that stands on the object's support plane, x away from the sensors. Several
 * threads may use one network. */
class PCL_COSECTION_EXPORT CompletionNetwork
{
public:
  /** \brief Shared pointer to what is constant. */
  using ConstPtr = std::shared_ptr<const CompletionNetwork>;

  static constexpr int size = 32;    ///< voxels along an edge of the cube
  static constexpr int channels = 4; ///< of the input

  virtual ~CompletionNetwork ();

  /** \brief Where matter is.
   * \param[in] observed channels x size x size x size values (z, y, x; x fastest): the signed distance from the
   * object's readings along their rays, in units of three voxels and truncated to [-1, 1], positive in front; 1 where a
   * view looks through; 1 behind the object's readings; 1 where no view tells anything
   * \return size x size x size logits of the probability that there is matter
   * \throws IoError if the network cannot be run */
  virtual std::vector<float> complete (const std::vector<float>& observed) const = 0;
};

/** \brief Read a network from an ONNX file: one input of 1 x 128 x 32 x 32 values, one output of 1 x 32 x 32 x 32
 * (heights are channels). It is checked and tried in a process of its own first. In the library pcl_cosection_dnn.
 * \throws IoError why it cannot be read or run, or what is wrong with its shapes */
PCL_COSECTION_EXPORT CompletionNetwork::ConstPtr loadCompletionNetwork (const std::string& path);

/** \brief The file of the network that is installed with the library; empty if there is none. In the library
 * pcl_cosection_dnn. */
PCL_COSECTION_EXPORT std::string completionNetworkFile ();

/** \brief Parameters of the minimisation. */
struct PCL_COSECTION_EXPORT SolverOptions
{
  SolverType type = SolverType::Multigrid; ///< of the solver
  int max_iterations = 60;         ///< per level: multigrid cycles (Fast Jacobi: cycles of \a cycle_length sweeps)
  double tolerance_vox = 0.03;     ///< stop this close to the solution, root mean square near the zero set
  double peak_tolerance_vox = 0.0; ///< and this close at every voxel there, which takes longer; 0: no such limit
  int cycle_length = 20;           ///< Fast Jacobi: sweeps in a cycle
  int smoothing_degree = 4; ///< multigrid: degree of the Chebyshev polynomial before and after each coarse correction
  int threads = 0;          ///< 0: all
};

/** \brief The parameters of Co-Section. Lengths are in metres unless the name says otherwise. */
struct PCL_COSECTION_EXPORT CoSectionOptions
{
  double voxel_size_m = 0.0; ///< h; 0: from \a resolution
  int resolution = 0; ///< voxels along the longest observed side; 0: 64, but fewer where the points' spacing does not
                      ///< support them; up to 96 where a vessel's wall, or what is thin, needs more
  /** \brief Volume beyond the observed box on each side, as a fraction of its longest side; 0: as far as the
   * extent prior lets the shape extend, or 0.3 without views, hull constraint or that prior. */
  double padding = 0.0;
  double background_voxel_size_m = 0.0; ///< 0: twice the smallest object voxel that is asked for, or that points'
                                        ///< spacing supports; see also \a whole_background

  bool use_hull = true;             ///< E_hull, equation (3)
  bool use_intersection = true;     ///< E_inter, equation (5)
  bool use_planes = true;           ///< find support planes in the background and continue them under the objects
  bool use_extent_prior = true;     ///< remedy for swelling: a weak pull outside where nothing suggests the object
  bool use_symmetric_extent = true; ///< part of the extent prior: hidden parts extend as far as those seen do
  CompletionNetwork::ConstPtr completion_network = nullptr; ///< the learned prior; null: there is none
  Priors priors;                ///< which of the priors; those that the switches above turn off stay off
  bool carve_free_space = true; ///< with the hull: cut the result along the outlines seen by views, finer than a voxel
  bool revise_votes = true;     ///< free space can be revised by contradicting evidence
  bool intersect_solved = true; ///< neighbours act through their optimised fields (false: through their data alone, the
                                ///< paper)

  double alpha = 0.005;                  ///< weight of the Hessian on the grid; the metric weight is alpha h^4
  double beta_hull = 0.01;               ///< weight of the hull constraint
  double beta_inter = 0.04;              ///< weight of the intersection constraint
  double beta_extent = 0.001;            ///< weight of the pull that prevents swelling
  double sigma_vox = 1.0;                ///< width of a point's Gaussian; cut off at three times it
  double max_bound_vox = 5.0;            ///< cap of the intersection distance, and of the evidence behind data
  Weighting weighting = Weighting::Mean; ///< of the data term
  HullDistance hull_distance = HullDistance::Exact; ///< d_hull

  /** \brief Complete all of the background, not only what is near objects: with voxels of 2 cm unless given, smaller in
   * small scenes. */
  bool whole_background = false;
  /** \brief Edge in voxels of the largest volume in which a whole background is solved: one that needs more voxels than
   * the cube of it is solved in overlapping blocks of at most this edge, where there are points. From 32 to 1024; 0:
   * 256. Smaller blocks need less memory and more time. */
  int background_block_vox = 0;
  /** \brief reconstruct () leaves out points of the background that are of objects, before these were known as such:
   * those that views look through, more than a few by mistake would, those on the surface of an object where it was,
   * and those of views before its first one in its volume where it began. */
  bool leave_out_moved = false;
  bool compute_hull = false;   ///< also give the hull of each object as a mesh
  bool compute_bounds = false; ///< also give an inner and an outer bound of each object as meshes

  std::size_t min_points = 1;       ///< objects with fewer are not completed
  int max_passes = 5;               ///< simultaneous passes over all objects, at half and at full resolution each
  std::size_t max_memory_bytes = 0; ///< 0: no limit
  SolverOptions solver;             ///< of the minimisation; its threads are those below
  int threads = 0;                  ///< 0: all

  /** \brief The parameters of the publication. */
  static CoSectionOptions paper ();

  /** \brief The priors that neither \a priors nor another switch turns off. */
  Priors activePriors () const;

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

} // namespace pcl::cosection
