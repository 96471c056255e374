// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "html_writer.h"
#include "report_content.h"

/** \brief How near the run is to the truth: the camera, and a row for each object and the background. Needs the truth.
 */
void writeAccuracy (HtmlWriter& html, const ReportContent& content);

/** \brief The run beside what was seen alone and other runs: errors where there is a truth, else volumes and
 * penetrations. Writes nothing where there is nothing to compare. \return whether there was */
bool writeComparison (HtmlWriter& html, const ReportContent& content);
