// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh_alignment.h"
#include "pcl_cosection/priors/learned/learned_completion.h"
#include "pcl_cosection/priors/object_priors.h"
#include "pcl_cosection/priors/proposal.h"

#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief A mesh that was proposed as an object's shape, where it fits the measurements best. */
struct ProposedShape
{
  ProposalFit fit;
  TriangleMesh mesh; ///< aligned, object frame
};

/** \brief What the network of the learned prior completes, and how well that fits. */
struct LearnedShape
{
  LearnedCompletion completion;
  ProposalFit fit;
};

/** \brief The best of an object's proposals, and what the network completes. They are found once. */
struct ProposedShapes
{
  bool aligned = false, completed = false;
  std::optional<ProposedShape> best;
  std::optional<LearnedShape> learned;
};

/** \brief The best of an object's proposals, aligned with its measurements; null if there are none.
 * \param[in] planes on which it may stand */
const ProposedShape* proposedShape (const Observation& object, const ObjectSetting& setting,
                                    const std::vector<Eigen::Vector4d>& planes);

/** \brief Use the best proposal only if it explains about as many of an object's points as its shape without proposals
 * does: the noise is the same for both.
 * \param[in] without signed distance of that shape
 * \param[in] planes on which it may stand
 * \return whether it is used */
bool keepIfAsGood (const SignedDistanceField& without, const Observation& object, const ObjectSetting& setting,
                   const std::vector<Eigen::Vector4d>& planes);

/** \brief The object as the network of the learned prior completes it; null if there is none, no view, or nothing is
 * expected. \param[in] plane on which it stands */
const LearnedShape* learnedShape (const Observation& object, const ObjectSetting& setting,
                                  const Eigen::Vector4d& plane);

/** \brief Forget what the network completes. */
void leaveOutLearned (const Observation& object);

/** \brief Mean thickness of what consists of thin walls, metres: twice its volume by its area. 0 if it is thicker than
 * some voxels, or open. */
double wallOf (const TriangleMesh& shape, double voxel_size_m);

/** \brief Expect a signed distance where nothing was measured.
 * \param[in] distance metres, on the grid of the energy
 * \param[in] energy with data term and free space */
void addExpectedDistance (const SignedDistanceField& distance, const BodyEnergy& energy, Proposal& proposal);

/** \brief Expect a proposed surface where nothing was measured, and behind a measured one, where a wall ends.
 * \param[in,out] energy with data term, free space, and which way the points face */
void addProposedShape (const TriangleMesh& shape, BodyEnergy& energy, Proposal& proposal);

} // namespace pcl::cosection
