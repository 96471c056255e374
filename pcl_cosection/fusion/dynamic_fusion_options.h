// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include "pcl_cosection/fusion/mapping/background_model.h"

#include <pcl/cosection/fusion/dynamic_fusion.h>

namespace pcl::cosection
{

/** \brief What the options of the front end mean for its background. */
BackgroundOptions backgroundOptions (const DynamicFusionOptions& options);

/** \brief What they mean for its association. */
AssociationOptions associationOptions (const DynamicFusionOptions& options);

} // namespace pcl::cosection
