// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
// Writes training samples of the learned completion to its standard output: of each voxel the truncated distance (int8,
// 1/100), what is known (uint8: 1 free, 2 behind the object's own surface, 4 unknown) and the true distance (int8, 1/30
// voxel).
#include "training_views.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

using namespace pcl::cosection;

namespace {

std::int8_t
toByte (double value)
{
  return static_cast<std::int8_t> (std::lround (std::clamp (value, -127.0, 127.0)));
}

void
write (const TrainingSample& sample)
{
  std::vector<char> bytes (3 * CompletionCube::voxels);
  for (std::size_t n = 0; n < CompletionCube::voxels; ++n)
  {
    bytes[n] = toByte (100.0 * sample.inputs.distance[n]);
    bytes[CompletionCube::voxels + n] = static_cast<char> (sample.inputs.is_free[n] + 2 * sample.inputs.is_behind[n] +
                                                           4 * sample.inputs.is_unknown[n]);
    bytes[2 * CompletionCube::voxels + n] = toByte (30.0 * sample.distance_vox[n]);
  }
  std::cout.write (bytes.data (), static_cast<std::streamsize> (bytes.size ()));
}

} // namespace

int
main (int argc, char** argv)
{
  if (argc < 3)
  {
    std::cerr
        << "usage: make_training_samples SEED COUNT [--exclude NAME]... [FOLDER]...\n"
           "Samples of random bodies and of the meshes in the folders, without files whose names contain a NAME.\n";
    return 1;
  }
  std::vector<std::string> folders, excluded;
  for (int n = 3; n < argc; ++n)
    if (std::string (argv[n]) == "--exclude" && n + 1 < argc)
      excluded.emplace_back (argv[++n]);
    else
      folders.emplace_back (argv[n]);
  Dice dice (std::strtoull (argv[1], nullptr, 10));
  const long count = std::strtol (argv[2], nullptr, 10);

  // Each folder, and the random bodies, get the same share.
  std::vector<std::vector<TrainingShape>> sets;
  for (const std::string& folder : folders)
  {
    sets.push_back (loadTrainingShapes ({folder}, excluded));
    std::cerr << folder << ": " << sets.back ().size () << " shapes\n";
    if (sets.back ().empty ())
      sets.pop_back ();
  }
  std::vector<TrainingShape> bodies;
  Dice body_dice (7);
  while (bodies.size () < 600)
    try
    {
      bodies.emplace_back (randomBody (body_dice));
    }
    catch (const std::exception&) // flat, or a profile that crosses itself
    {}
  sets.push_back (std::move (bodies));
  const auto any = [&] () -> TrainingShape& {
    std::vector<TrainingShape>& set = sets[dice.below (static_cast<int> (sets.size ()))];
    return set[dice.below (static_cast<int> (set.size ()))];
  };
  for (long made = 0; made < count && std::cout;)
  {
    TrainingShape& shape = any ();
    shape.prepare ();
    std::vector<const TrainingShape*> others;
    if (dice.chance (0.5))
      for (int n = 1 + dice.below (3); n > 0; --n)
        others.push_back (&any ());
    if (const auto sample = randomSample (shape, others, dice))
    {
      write (*sample);
      ++made;
    }
  }
  return std::cout ? 0 : 1;
}
