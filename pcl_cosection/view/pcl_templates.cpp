// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// PCL's libraries of sample consensus and search hold their templates for every type of point: 19 MB of addresses and a
// fifth of the time in which a program starts. Their headers give what is needed for one type.

#include <pcl/point_types.h>
#include <pcl/sample_consensus/impl/ransac.hpp>
#include <pcl/sample_consensus/impl/sac_model_plane.hpp>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_plane.h>
#include <pcl/search/impl/kdtree.hpp>
#include <pcl/search/impl/organized.hpp>
#include <pcl/search/impl/search.hpp>
#include <pcl/search/kdtree.h>
#include <pcl/search/organized.h>

template class pcl::RandomSampleConsensus<pcl::PointXYZ>;
template class pcl::SampleConsensusModelPlane<pcl::PointXYZ>;
template class pcl::search::Search<pcl::PointXYZ>;
template class pcl::search::KdTree<pcl::PointXYZ>;
template class pcl::search::OrganizedNeighbor<pcl::PointXYZ>;
