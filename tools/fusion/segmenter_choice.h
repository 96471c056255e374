// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "network_options.h"

#include <pcl/cosection/fusion/frame_segmenter.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

/** \brief The values of --segmentation. */
std::vector<std::string> segmenterNames ();

/** \brief What finds objects where there are no masks. \param[in] name one of segmenterNames () \param[in] threads 0:
 * all \param[in] network for mask-rcnn \throws UsageError, pcl::cosection::IoError */
std::shared_ptr<pcl::cosection::FrameSegmenter> makeSegmenter (const std::string& name, int threads,
                                                               const std::optional<NetworkSettings>& network);
