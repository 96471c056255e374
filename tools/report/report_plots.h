// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "html_writer.h"
#include "report_content.h"

/** \brief Trajectories of the camera and of the objects' middles: from above, and each coordinate over time. Truth is
 * dashed, brought into the world of the run. \return whether there were any */
bool writeTrajectories (HtmlWriter& html, const ReportContent& content);

/** \brief What the run did in which time: a table with bars. \return whether the run says so */
bool writeTimings (HtmlWriter& html, const ReportContent& content);
