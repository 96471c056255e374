// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// compare_masks OUTPUT SEGMENTATIONS [DATASET|PRESET|SPEC.json ...]: what is lost where there are no masks, on
// sequences with their truth: folders, or simulated (all presets). Tracks and completes their objects with the true
// masks of every tenth frame, and again with what each of SEGMENTATIONS, values of --segmentation with commas between,
// finds. Prints tables and saves them in OUTPUT/masks.md.

#include "benchmark_dataset.h"

#include "fusion_command_line.h"
#include "output_files.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <exception>
#include <iostream>
#include <set>
#include <sstream>
#include <tuple>

using namespace pcl::cosection;
namespace fs = std::filesystem;

namespace {

constexpr double clear_view_share = 1600.0 / (640.0 * 480.0); // of the image: smaller views of an object do not count

/** \brief True masks of every tenth frame. */
class TrueMasks : public FrameSegmenter
{
public:
  explicit TrueMasks (const BenchmarkDataset& data) : data_ (data) {}

  FrameInstances segment (const ObservedFrame& frame) override { return {data_.masks.read (frame.images.stamp), ""}; }

private:
  const BenchmarkDataset& data_;
};

/** \brief Pixels that two labellings have in common, summed up over frames or of one. */
struct Overlap
{
  std::map<int, std::size_t> of_truth, of_found;
  std::map<std::pair<int, int>, std::size_t> common;

  double iou (int truth, int found) const
  {
    const auto both = common.find ({truth, found});
    if (both == common.end ())
      return 0.0;
    return static_cast<double> (both->second) /
           static_cast<double> (of_truth.at (truth) + of_found.at (found) - both->second);
  }
};

/** \brief What the front end says of a sequence, beside the truth. */
struct FollowedSequence
{
  std::vector<Overlap> frames;
  std::map<int, int> found_as; ///< by number of the truth, one to one
  std::size_t found = 0;       ///< objects, true or not
};

FollowedSequence
follow (const BenchmarkDataset& data, std::shared_ptr<FrameSegmenter> segmenter)
{
  DynamicFusion fusion (data.images.camera ());
  fusion.setSegmenter (std::move (segmenter));
  FollowedSequence result;
  Overlap all;
  FrameReader reader (data.images, {});
  while (const std::optional<RgbdFrame> frame = reader.next ())
  {
    const auto truth = data.masks.read (frame->stamp);
    const TrackedFrame& tracked = fusion.process (*frame);
    if (!truth || !tracked.T_world_camera)
      continue;
    Overlap overlap;
    for (std::size_t n = 0; n < truth->pixels.size (); ++n)
    {
      const float z = frame->depth.pixels[n];
      if (!(z > 0.0f))
        continue;
      const int a = truth->pixels[n];
      const int b = tracked.instances.pixels[n] == TrackedFrame::unassigned ? 0 : tracked.instances.pixels[n];
      ++overlap.of_truth[a];
      ++overlap.of_found[b];
      ++overlap.common[{a, b}];
    }
    for (const auto& [id, pixels] : overlap.of_truth)
      all.of_truth[id] += pixels;
    for (const auto& [id, pixels] : overlap.of_found)
      all.of_found[id] += pixels;
    for (const auto& [pair, pixels] : overlap.common)
      all.common[pair] += pixels;
    result.frames.push_back (std::move (overlap));
  }
  std::vector<std::tuple<double, int, int>> pairs;
  for (const auto& [pair, pixels] : all.common)
    if (pair.first > 0 && pair.second > 0)
      pairs.emplace_back (-all.iou (pair.first, pair.second), pair.first, pair.second);
  std::sort (pairs.begin (), pairs.end ());
  std::set<int> taken;
  for (const auto& [iou, truth, found] : pairs)
    if (result.found_as.count (truth) == 0 && taken.insert (found).second)
      result.found_as[truth] = found;
  result.found = fusion.foundObjects ().size ();
  return result;
}

/** \brief Mean over the frames from the one in which it is found, and in how many of those that show it clearly it is
 * labelled. */
std::string
imageCells (const FollowedSequence& followed, int truth, std::size_t pixels)
{
  const auto found = followed.found_as.find (truth);
  double sum = 0.0;
  std::size_t frames = 0, labelled = 0, visible = 0;
  bool begun = false;
  for (const Overlap& frame : followed.frames)
  {
    const auto seen = frame.of_truth.find (truth);
    if (seen == frame.of_truth.end () ||
        static_cast<double> (seen->second) < clear_view_share * static_cast<double> (pixels))
      continue;
    ++visible;
    const double iou = found == followed.found_as.end () ? 0.0 : frame.iou (truth, found->second);
    begun = begun || iou > 0.0;
    labelled += iou > 0.0;
    frames += begun;
    sum += iou;
  }
  return frames == 0 ? "- | -" : format ("%.3f | %zu of %zu", sum / static_cast<double> (frames), labelled, visible);
}

struct Completed
{
  RunEvaluation evaluation;
  std::size_t objects = 0;
};

Completed
complete (const BenchmarkDataset& data, std::shared_ptr<FrameSegmenter> segmenter)
{
  TrackedSequence sequence (data.images);
  sequence.segmenter = std::move (segmenter);
  const SceneRecord estimate = recordOf (SequenceFusion (sequence).run ());
  return {evaluateRun (data.truth, estimate), estimate.objects.size ()};
}

const ObjectEvaluation*
evaluationOf (const RunEvaluation& run, int truth)
{
  for (const ObjectEvaluation& object : run.objects)
    if (object.truth_id == truth)
      return &object;
  return nullptr;
}

std::string
shapeCells (const RunEvaluation& with_masks, const RunEvaluation& run, int truth)
{
  const ObjectEvaluation* a = evaluationOf (with_masks, truth);
  const ObjectEvaluation* b = evaluationOf (run, truth);
  if (!b)
    return "- | - | -";
  const MeshComparison& mesh = b->mesh.comparison;
  std::string cells = format ("%.1f / %.1f / %.2f | ", 1e3 * mesh.accuracy.mean, 1e3 * mesh.completeness.mean,
                              mesh.f_score);
  cells += a ? format ("%.2f", std::max (mesh.accuracy.mean / a->mesh.comparison.accuracy.mean,
                                         mesh.completeness.mean / a->mesh.comparison.completeness.mean))
             : "-";
  return cells + format (" | %.1f", 1e3 * b->trajectory.ate_m.rmse);
}

std::string
runScene (const std::string& name, const fs::path& output, const std::vector<std::string>& segmentations)
{
  const BenchmarkDataset data (prepareDataset (name, output / sceneName (name)));
  for (const std::string& warning : data.notes.warnings)
    std::cerr << name << ": " << warning << '\n';
  const std::size_t pixels = static_cast<std::size_t> (data.images.camera ().width) * data.images.camera ().height;
  std::string text = "### " + sceneName (name) +
                     "\n\n| masks | object | IoU | frames | accuracy / completeness (mm) / F@1cm | worse by | ATE, mm "
                     "|\n|---|---|---|---|---|---|---|\n";
  std::optional<RunEvaluation> with_masks;
  std::vector<std::string> methods{"true"};
  methods.insert (methods.end (), segmentations.begin (), segmentations.end ());
  for (const std::string& method : methods)
  {
    const auto make = [&] () -> std::shared_ptr<FrameSegmenter> {
      return method == "true" ? std::make_shared<TrueMasks> (data) : makeSegmenter (method, 0, std::nullopt);
    };
    const FollowedSequence followed = follow (data, make ());
    const Completed run = complete (data, make ());
    if (!with_masks)
      with_masks = run.evaluation;
    for (const SceneRecord::Object& object : data.truth.objects)
      text += "| " + method + " | " + object.name + " | " + imageCells (followed, object.id, pixels) + " | " +
              shapeCells (*with_masks, run.evaluation, object.id) + " |\n";
    text += "| " + method + " | camera; " + std::to_string (run.objects) + " objects | | | | | " +
            format ("%.2f |\n", 1e3 * run.evaluation.camera.ate_m.rmse);
  }
  return text + "\n";
}

std::vector<std::string>
split (const std::string& names)
{
  std::vector<std::string> result;
  std::istringstream text (names);
  for (std::string name; std::getline (text, name, ',');)
    result.push_back (name);
  return result;
}

} // namespace

int
main (int argc, char** argv)
{
  if (argc < 3 || argv[1][0] == '-')
  {
    std::cerr << "Usage: compare_masks OUTPUT SEGMENTATIONS [DATASET|PRESET|SPEC.json ...]\n";
    return 2;
  }
  try
  {
    const fs::path output = argv[1];
    fs::create_directories (output);
    std::string text;
    for (const std::string& name : scenesOrPresets (argc - 3, argv + 3))
    {
      const std::string scene = runScene (name, output, split (argv[2]));
      std::cout << scene << std::flush;
      text += scene;
    }
    saveText (text, (output / "masks.md").string ());
    return 0;
  }
  catch (const std::exception& error)
  {
    std::cerr << "compare_masks: " << error.what () << '\n';
    return 1;
  }
}
