// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "html_writer.h"
#include "report_content.h"

/** \brief What the page begins with: what was run and when, the figures that matter most, and whether something went
 * wrong. */
void writeHeader (HtmlWriter& html, const ReportContent& content);
