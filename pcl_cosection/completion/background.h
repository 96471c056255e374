// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "surroundings.h"

#include <memory>
#include <vector>

namespace pcl::cosection {

/** \brief The bodies of the background: all of it, or a piece around objects that are near each other. */
struct BackgroundBodies
{
  std::vector<std::unique_ptr<BodyState>> pieces; // empty if all of the background is completed
  std::vector<BodyState*> bodies;                 // those pieces, or the background of the scene's state
};

/** \brief The completed background. */
struct Background
{
  TriangleMesh mesh; // open, trimmed to supported regions; world frame
  std::vector<BackgroundResult> pieces;

  std::vector<SignedDistanceField::ConstPtr> fields () const;
};

/** \brief Give the background grids: near the objects, or everywhere. A failure is a warning.
 * \param[in] used_bytes memory in use, of that which the options allow */
BackgroundBodies placeBackground (const Scene& scene, const std::vector<SceneObject>& objects, CompletionMode mode,
                                  std::size_t used_bytes, SceneState& state, CompletionLog& log);

/** \brief Minimise E_data + E_reg + E_hull of the background, its support planes continued under and behind the
 * objects. A failure is a warning. */
Background solveBackground (const Scene& scene, const std::vector<SceneObject>& objects, CompletionMode mode,
                            UpdateOutput output, const std::vector<BodyState*>& bodies, CompletionLog& log);

} // namespace pcl::cosection
