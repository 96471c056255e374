// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "report_content.h"

#include <pcl/cosection/common/error.h>

#include <string>

/** \brief The report: one HTML page that needs nothing else. The same for the same content.
 * \param[in] progress called with what is being drawn; it may stop the work
 * \throws pcl::cosection::Cancelled if it does */
std::string reportPage (const ReportContent& content, const pcl::cosection::ProgressCallback& progress = {});
