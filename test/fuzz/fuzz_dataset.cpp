// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Bytes as one of the small files of a dataset, which the first line names, or as the names of the files in a folder.

#include "fuzz_target.h"
#include "memory_file.h"

#include "pcl_cosection/sequence/numbered_files.h"
#include "pcl_cosection/sequence/pose_matrix.h"
#include "pcl_cosection/sequence/sequence_layouts.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/evaluation/run_evaluation.h>

#include <algorithm>
#include <cmath>
#include <sstream>

using namespace pcl::cosection;

namespace {

const std::string separator = "%%\n"; // between two lists

void
list (const std::string& folder)
{
  const SequenceListing listing = listSequence (folder, {});
  fuzz::require (!listing.files.empty (), "a sequence has frames");
  for (std::size_t n = 0; n < listing.files.size (); ++n)
  {
    const FrameFiles& files = listing.files[n];
    fuzz::require (std::isfinite (files.stamp), "stamps are finite");
    fuzz::require (n == 0 || listing.files[n - 1].stamp < files.stamp, "stamps ascend");
    fuzz::require (!files.depth.empty (), "a frame has depth");
  }
  fuzz::requireMessages (listing.warnings);
}

void
readAssociations (const std::string& bytes)
{
  static fuzz::MemoryFolder folder;
  folder.set ("associations.txt", bytes);
  list (folder.path ());
}

/** \brief depth.txt, and rgb.txt behind a line "%%". */
void
readLists (const std::string& bytes)
{
  static fuzz::MemoryFolder both, depth_only;
  const std::size_t cut = bytes.find (separator);
  fuzz::MemoryFolder& folder = cut == std::string::npos ? depth_only : both;
  folder.set ("depth.txt", bytes.substr (0, cut));
  if (cut != std::string::npos)
    folder.set ("rgb.txt", bytes.substr (cut + separator.size ()));
  list (folder.path ());
}

void
readPose (const std::string& bytes)
{
  static fuzz::MemoryFile file;
  file.set (bytes);
  fuzz::requireRigid (readPoseMatrix (file.path ()));
}

/** \brief As the truth of an evaluation has it. */
void
readCalibration (const std::string& bytes)
{
  static fuzz::MemoryFolder folder;
  folder.set ("gt-cam-0.txt", "0 0 0 0 0 0 0 1\n");
  folder.set ("calibration.txt", bytes);
  ReadingNotes notes;
  const SceneRecord truth = readTruth (folder.path (), notes);
  fuzz::requireMessages (notes.warnings);
  fuzz::require (notes.whole == truth.intrinsics.has_value (), "a camera was read, or a warning says why not");
  if (truth.intrinsics)
    truth.intrinsics->validate ();
  else
    throw IoError (notes.warnings.front ());
}

/** \brief Names of files, one in each line. */
void
readNames (const std::string& bytes)
{
  std::vector<std::string> names;
  std::istringstream lines (bytes);
  for (std::string name; std::getline (lines, name);)
    if (!name.empty ())
      names.push_back (name);
  std::sort (names.begin (), names.end ());
  const std::vector<std::string> endings = {".png", ".depth.png", ".txt"};
  for (const std::vector<std::string>& beginnings : {std::vector<std::string>{}, {"depth", ""}, {"frame-"}})
  {
    std::vector<std::string> warnings;
    const std::vector<NumberedFile> files = numberedFiles ("folder", names, {beginnings, endings}, warnings);
    for (std::size_t n = 0; n < files.size (); ++n)
    {
      fuzz::require (std::isfinite (files[n].number) && files[n].number >= 0.0, "numbers are finite");
      fuzz::require (n == 0 || files[n - 1].number < files[n].number, "numbers ascend");
    }
  }
  for (const PairedFile& file : pairedFiles ("folder", names, endings))
    fuzz::require (std::isfinite (file.first) && std::isfinite (file.second), "numbers are finite");
}

} // namespace

std::vector<std::string>
fuzz::seeds ()
{
  return {"associations.txt\n1.5 rgb/1.5.png 1.51 depth/1.51.png\n2.5 rgb/2.5.png 2.51 depth/2.51.png\n",
          "associations.txt\n# depth first\n0 depth/0.exr 0 colour/0.jpg\n1 depth/1.exr 1 colour/1.jpg\n"
          "3 depth/3.exr 3 colour/3.jpg\n",
          "depth.txt\n# timestamp filename\n1305031453.374112 depth/1305031453.374112.png\n"
          "1305031453.404816 depth/1305031453.404816.png\n",
          "depth.txt\n1.000 depth/a.png\n1.033 depth/b.png\n1.066 depth/c.png\n%%\n# colour\n1.001 rgb/a.png\n"
          "1.030 rgb/b.png\r\n1.070 rgb/c.png\n",
          "pose.txt\n1 0 0 0.5\n0 1 0 -0.25\n0 0 1 2\n0 0 0 1\n",
          "pose.txt\n 9.9e-01\t 1.2e-01\t -3.4e-02\t -3.9e-01\t\n -1.2e-01\t 9.9e-01\t 2.0e-02\t 1.4e-01\t\n"
          " 3.6e-02\t -1.6e-02\t 9.99e-01\t 1.1e+00\t\n 0 0 0 1.0\n",
          "calibration.txt\n525 525 319.5 239.5\n",
          "calibration.txt\n262.5 262.5 159.5 119.5 320 240\n",
          "names\nDepth0001.png\nDepth0002.png\nDepth0010.png\n",
          "names\nframe-000001.depth.png\nframe-000000.depth.png\n1305031453.374112.png\n1305031453374112000.png\n",
          "names\n0001_0.png\n0001_1.png\n12-3.png\n0.033333.png\n000007.txt\n"};
}

std::vector<std::string>
fuzz::dictionary ()
{
  return {"associations.txt\n",
          "depth.txt\n",
          "pose.txt\n",
          "calibration.txt\n",
          "names\n",
          "%%\n",
          "#",
          "\n",
          "\r\n",
          "\t",
          "/",
          "..",
          ".png",
          ".exr",
          "depth/1.png",
          "rgb/1.png",
          "1305031453.374112",
          "1e-5",
          "+",
          "_",
          "0 0 0 1\n",
          "-1 0 0 0\n",
          "Depth"};
}

bool
fuzz::accepts (const std::string& input)
{
  const auto [kind, bytes] = splitFirstLine (input);
  void (*const read) (const std::string&) = kind == "associations.txt"  ? readAssociations
                                            : kind == "depth.txt"       ? readLists
                                            : kind == "pose.txt"        ? readPose
                                            : kind == "calibration.txt" ? readCalibration
                                            : kind == "names"           ? readNames
                                                                        : nullptr;
  if (read == nullptr)
    return (false);
  try
  {
    read (bytes);
    return (true);
  }
  catch (const IoError& error) // and no other
  {
    requireMessage (error.what ());
    return (false);
  }
}
