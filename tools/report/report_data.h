// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "json_fields.h"
#include "report_content.h"

#include <pcl/cosection/common/error.h>

/** \brief What page/report.js writes into the page: numbers in SI units, null where they are not known.
 *
 * - `version`, `title`, `path`, `date`, `method`, `truth_folder`, `licence` (of three.js): texts;
 * - `failure`, `has_summary`, `failed` (`id`, `error`), `warnings`, `events`: what went wrong;
 * - `has_seen`: whether there are surfaces as they were seen;
 * - `frames`, `frames_per_second`, `timings_s` (by stage, `total`), `parameters` (name and value in words);
 * - `has_background`, `objects`: `id`, `name`, `completed`, `is_known` (more than a trajectory), `size_m`, `volume_m3`,
 *   `closed`, `provenance` (shares), `penetration_m`, `frames`, `iterations`, `converged`, `pictures`;
 * - `scene_pictures`, `error_max_m` (of the colours of errors);
 * - `accuracy`, null without a truth: `camera`, `objects`, `background`, `unmatched` (ids), `missed` (names);
 * - `comparison`, null without anything to compare: `columns` (names of objects) and `methods` (`name`, `remark`, and
 * for each column `scores` with a truth, else `summaries`);
 * - `trajectories`: `period` and `paths` (`name`, `id` or 0 for the camera, `poses` and `truth`, each pose a stamp and
 *   x, y, z in axes of which the third is up);
 * - `scene`: what sceneData () says, for page/scene_view.js; null without meshes or three.js.
 *
 * \param[in] progress called with what is being drawn; it may stop the work
 * \throws pcl::cosection::Cancelled if it does */
Json reportData (const ReportContent& content, const pcl::cosection::ProgressCallback& progress);
