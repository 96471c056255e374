// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/fusion/frame_segmenter.h>

#include <memory>
#include <string>
#include <vector>

/** \brief The values of --segmentation. */
std::vector<std::string>
segmenterNames ();

/** \brief What finds objects where there are no masks. \param[in] name one of segmenterNames () \param[in] threads 0: all */
std::shared_ptr<pcl::cosection::FrameSegmenter>
makeSegmenter (const std::string& name, int threads);
