// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "training_shapes.h"

#include "pcl_cosection/priors/learned/completion_cube.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief What a network sees, and what it should answer; CompletionCube::voxels each. */
struct TrainingSample
{
  CompletionInputs inputs;
  std::vector<float> distance_vox; ///< signed, from the true surface
};

/** \brief A shape on a table among others in simulated views: readings are noisy or missing, masks are too large, too
 * small or shifted. Nothing if too little of the shape is seen.
 * \param[in] shape prepared
 * \param[in] others stand around it */
std::optional<TrainingSample> randomSample (const TrainingShape& shape, const std::vector<const TrainingShape*>& others,
                                            RandomNumbers& random);

} // namespace pcl::cosection
