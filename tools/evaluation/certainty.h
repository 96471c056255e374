// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation_output.h"
#include "pcl_cosection/evaluation/error_calibration.h"

#include <vector>

// What the evaluation says about expected errors and bounds.

/** \brief How expected errors compare with true ones: by provenance, and by classes of sigma.
 * \param[in] in_outer shares of true surfaces inside outer bounds, one for each object that has a bound */
void printCertainty (const std::vector<pcl::cosection::VertexError>& errors, const std::vector<double>& in_outer,
                     Terminal& terminal);

Json coverageJson (const pcl::cosection::ErrorCoverage& coverage);

/** \brief The tables of printCertainty (). */
Json certaintyJson (const std::vector<pcl::cosection::VertexError>& errors);
