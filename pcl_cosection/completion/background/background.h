// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/completion/surroundings.h"
#include "pcl_cosection/view/sensor_views.h"

#include <memory>
#include <optional>
#include <vector>

namespace pcl::cosection {

/** \brief The bodies of the background: all of it, or a piece around objects that are near each other. */
struct BackgroundBodies
{
  std::vector<std::unique_ptr<BodyState>> pieces;    // empty if all of the background is completed
  std::vector<BodyState*> bodies;                    // those pieces, or the background of the scene's state
  BackgroundBlocks* blocks = nullptr;                // of the scene's state, if that background has coarser voxels
  std::optional<std::vector<OrientedPoint>> at_rest; // the points of the background, if some have moved

  /** \brief The points of the background that count. */
  const std::vector<OrientedPoint>& points (const Scene& scene) const { return at_rest ? *at_rest : scene.background; }
};

/** \brief The completed background. */
struct Background
{
  TriangleMesh mesh; // open, trimmed to supported regions; world frame
  std::vector<BackgroundResult> pieces;

  std::vector<SignedDistanceField::ConstPtr> fields () const;
};

/** \brief Give the background grids: near the objects, or everywhere, then also in blocks if one volume is too small
 * for its voxels. A failure is a warning.
 * \param[in] used_bytes memory in use, of that which the options allow */
BackgroundBodies placeBackground (const Scene& scene, const std::vector<SceneObject>& objects, CompletionMode mode,
                                  std::size_t used_bytes, SceneState& state, CompletionLog& log);

/** \brief Minimise E_data + E_reg + E_hull of the background, its support planes continued under and behind the
 * objects. A failure is a warning. */
Background solveBackground (const Scene& scene, const std::vector<SceneObject>& objects, CompletionMode mode,
                            UpdateOutput output, const BackgroundBodies& bodies, CompletionLog& log);

/** \brief The views from which the background has points. */
SensorViews sensorViews (const Scene& scene);

} // namespace pcl::cosection
