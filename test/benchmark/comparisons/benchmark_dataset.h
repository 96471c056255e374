// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/evaluation/run_evaluation.h>
#include <pcl/cosection/fusion/sequence_fusion.h>

#include <filesystem>
#include <string>
#include <vector>

/** \brief A sequence with its truth; it refers to itself. */
struct BenchmarkDataset
{
  explicit BenchmarkDataset (const std::string& folder);
  BenchmarkDataset (const BenchmarkDataset&) = delete;
  BenchmarkDataset& operator= (const BenchmarkDataset&) = delete;

  pcl::cosection::ReadingNotes notes;
  pcl::cosection::SceneRecord truth; ///< of the objects, those that have a mesh
  pcl::cosection::RgbdSequence images;
  pcl::cosection::MaskSequence masks;
  pcl::cosection::KnownSequence known; ///< all of that
};

/** \brief The folder of a dataset, the preset or the specification \a name, for tables. */
std::string sceneName (const std::string& name);

/** \brief The names of the command line, or those of all presets. */
std::vector<std::string> scenesOrPresets (int argc, const char* const* argv);

/** \brief A sequence's folder as it is; else the scene, a preset or a specification, simulated into \a folder / data.
 */
std::string prepareDataset (const std::string& name, const std::filesystem::path& folder);

/** \brief What a run found, as an evaluation takes it. */
pcl::cosection::SceneRecord recordOf (pcl::cosection::FusionResult result);

/** \brief A line of text, as std::printf () would write it. */
std::string format (const char* text, ...);
