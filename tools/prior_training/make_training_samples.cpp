// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
// Writes training samples of the learned completion to its standard output: of each voxel the truncated distance (int8,
// 1/100), what is known (uint8: 1 free, 2 behind the object's own surface, 4 unknown) and the true distance (int8, 1/30
// voxel).
#include "training_views.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

using namespace pcl::cosection;

namespace {

constexpr std::size_t random_bodies = 600;

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

/** \brief What the command line says. */
struct Wanted
{
  std::uint64_t seed = 0;
  long count = 0;
  std::vector<std::string> folders, excluded;
};

/** \throws std::invalid_argument, std::out_of_range */
Wanted
parse (int argc, char** argv)
{
  Wanted wanted;
  std::vector<std::string> numbers;
  for (int n = 1; n < argc; ++n)
  {
    const std::string word = argv[n];
    if (word == "--exclude" && n + 1 < argc)
      wanted.excluded.emplace_back (argv[++n]);
    else if (word.rfind ("--", 0) == 0)
      throw std::invalid_argument (word);
    else
      (numbers.size () < 2 ? numbers : wanted.folders).push_back (word);
  }
  if (numbers.size () < 2)
    throw std::invalid_argument ("no numbers");
  wanted.seed = std::stoull (numbers[0]);
  wanted.count = std::stol (numbers[1]);
  return wanted;
}

/** \brief Each folder, and random bodies. */
std::vector<std::vector<TrainingShape>>
shapeSets (const Wanted& wanted)
{
  std::vector<std::vector<TrainingShape>> sets;
  for (const std::string& folder : wanted.folders)
  {
    sets.push_back (loadTrainingShapes (folder, wanted.excluded));
    std::cerr << folder << ": " << sets.back ().size () << " shapes\n";
    if (sets.back ().empty ())
      throw std::runtime_error (folder + " has no mesh that can be used");
  }
  std::vector<TrainingShape> bodies;
  RandomNumbers random (7);
  while (bodies.size () < random_bodies)
    try
    {
      bodies.emplace_back (randomBody (random));
    }
    catch (const std::exception&) // flat, or a profile that crosses itself
    {}
  sets.push_back (std::move (bodies));
  return sets;
}

void
makeSamples (const Wanted& wanted)
{
  std::vector<std::vector<TrainingShape>> sets = shapeSets (wanted);
  RandomNumbers random (wanted.seed);
  const auto any = [&] () -> TrainingShape& { // each set has the same share
    std::vector<TrainingShape>& set = sets[random.below (static_cast<int> (sets.size ()))];
    return set[random.below (static_cast<int> (set.size ()))];
  };
  for (long made = 0; made < wanted.count;)
  {
    TrainingShape& shape = any ();
    shape.prepare ();
    std::vector<const TrainingShape*> others;
    if (random.chance (0.5))
      for (int n = 1 + random.below (3); n > 0; --n)
        others.push_back (&any ());
    if (const auto sample = randomSample (shape, others, random))
    {
      write (*sample);
      ++made;
    }
    if (!std::cout.flush ())
      throw std::runtime_error ("the samples cannot be written");
  }
}

} // namespace

int
main (int argc, char** argv)
{
  Wanted wanted;
  try
  {
    wanted = parse (argc, argv);
  }
  catch (const std::exception&)
  {
    std::cerr
        << "Usage: make_training_samples SEED COUNT [--exclude NAME]... [FOLDER]...\n"
           "Samples of random bodies and of the meshes in the folders, without files whose names contain a NAME.\n";
    return 2;
  }
  try
  {
    makeSamples (wanted);
  }
  catch (const std::exception& error)
  {
    std::cerr << "make_training_samples: error: " << error.what () << '\n';
    return 1;
  }
  return 0;
}
