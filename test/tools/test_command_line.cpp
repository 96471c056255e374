// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "command_line.h"
#include "option_values.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

using namespace pcl::cosection;

namespace {

Settings
parse (const std::string& arguments)
{
  std::istringstream stream (arguments);
  std::vector<std::string> words = {"pcl_cosection"};
  for (std::string word; stream >> word;)
    words.push_back (word);
  std::vector<const char*> pointers;
  for (const std::string& word : words)
    pointers.push_back (word.c_str ());
  return (parseCommandLine (static_cast<int> (pointers.size ()), pointers.data ()).value ());
}

std::string
usageError (const std::string& arguments)
{
  try
  {
    parse (arguments);
  }
  catch (const UsageError& error)
  {
    EXPECT_EQ (std::string (error.what ()).find ('\n'), std::string::npos);
    return (error.what ());
  }
  ADD_FAILURE () << "no error: " << arguments;
  return ("");
}

class ConfigFile
{
public:
  explicit ConfigFile (const std::string& content)
      : path ((std::filesystem::temp_directory_path () / ("command_line_" + std::to_string (getpid ()) + ".ini"))
                  .string ())
  {
    std::ofstream (path) << content;
  }
  ~ConfigFile () { std::remove (path.c_str ()); }

  const std::string path;
};

} // namespace

TEST (Suggestion, FindsTheNearestName)
{
  const std::vector<std::string> names = {"--voxel-size", "--resolution", "--alpha", "--beta-hull", "--beta-inter"};
  EXPECT_EQ (nearestName ("--voxelsize", names), "--voxel-size");
  EXPECT_EQ (nearestName ("--vox", names), "--voxel-size");
  EXPECT_EQ (nearestName ("--resloution", names), "--resolution");
  EXPECT_EQ (nearestName ("--beta_hull", names), "--beta-hull");
  EXPECT_EQ (nearestName ("--anything", {}), "");
  EXPECT_EQ (nearestName ("--cheesecake", names), "");
  EXPECT_EQ (suggestion ("--cheesecake", names), "");
  EXPECT_EQ (suggestion ("--voxelsize", names), "; did you mean --voxel-size?");
  EXPECT_EQ (suggestion ("--voxelsize", names, true), "; did you mean voxel-size?");
}

TEST (OptionValues, Sizes)
{
  EXPECT_EQ (parseSize ("1000"), 1000u);
  EXPECT_EQ (parseSize ("4k"), 4096u);
  EXPECT_EQ (parseSize ("500M"), 500u << 20);
  EXPECT_EQ (parseSize ("1.5GiB"), std::size_t (3) << 29);
  EXPECT_EQ (parseSize ("2gb"), std::size_t (2) << 30);
  for (const char* bad : {"", "M", "-1M", "0", "1X", "1MM", "nan", "1e40", "infG", "1 M"})
    EXPECT_FALSE (parseSize (bad)) << bad;
}

TEST (OptionValues, Tuples)
{
  EXPECT_EQ (parseTuples<4> ({"1,2,3,-4.5"})->at (0)[3], -4.5);
  EXPECT_EQ (parseTuples<4> ({"1", "2", "3", "4", "5", "6", "7", "8"})->at (1)[0], 5.0);
  for (const char* bad :
       {"", "1,2,3", "1,2,3,4,5", "1,2,3,x", "1,,2,3", "1,2,3,", "1,2,3,4,", "1,2,3,nan", "1,2,3,inf"})
    EXPECT_FALSE (parseTuples<4> ({bad})) << bad;
  EXPECT_EQ (parseTuples<3> ({"1,2,3", "4,5,6"})->at (1)[2], 6.0);
  EXPECT_FALSE (parseTuples<3> ({"1,2,3,4"}));
}

TEST (OptionValues, ARangeWithoutAnEndNamesNone)
{
  EXPECT_EQ (numberRange (-unlimited, unlimited) ("abc"), "\"abc\" is not valid, it must be a number");
  EXPECT_EQ (numberRange (0.0, unlimited) ("-1"), "\"-1\" is not valid, it must be a number, 0 or more");
}

TEST (CommandLine, PlainUse)
{
  const Settings settings = parse ("a.pcd b.pcd out");
  EXPECT_EQ (settings.inputs, (std::vector<std::string>{"a.pcd", "b.pcd"}));
  EXPECT_EQ (settings.output, "out");
  EXPECT_EQ (settings.format, "ply");
  EXPECT_EQ (settings.constraints, "all");
  EXPECT_EQ (settings.method.alpha, CoSectionOptions ().alpha);
  EXPECT_GT (settings.method.max_memory_bytes, 0u);
  EXPECT_EQ (parse ("a.pcd out.STL").format, "stl");
  EXPECT_EQ (parse ("a.pcd out --format obj").format, "obj");
}

TEST (CommandLine, PriorsThatAreListedAreOn)
{
  EXPECT_EQ (parse ("a.pcd out").method.activePriors ().names (), "all");
  EXPECT_EQ (parse ("a.pcd out --priors none").method.activePriors ().names (), "none");
  EXPECT_EQ (parse ("a.pcd out --priors extrusion,extent").method.activePriors ().names (), "extent,extrusion");
  EXPECT_EQ (parse ("a.pcd out --priors extrusion --priors extent").method.activePriors ().names (),
             "extent,extrusion");
  EXPECT_EQ (parse ("a.pcd out --no-planes").method.activePriors ().names (),
             "extent,symmetry,revolution,vessels,extrusion,rays,learned,proposals");
  EXPECT_EQ (parse ("a.pcd out --preset paper").method.activePriors ().names (), "none");
  EXPECT_EQ (parse ("a.pcd out --preset paper --priors rays").method.activePriors ().names (), "rays");
}

TEST (CommandLine, ANetworkNeedsTheLearnedPrior)
{
  EXPECT_EQ (parse ("a.pcd out --model n.onnx").model, "n.onnx");
  EXPECT_THROW (parse ("a.pcd out --model n.onnx --priors extent"), UsageError);
  EXPECT_THROW (parse ("a.pcd out --model n.onnx --preset paper"), UsageError);
}

TEST (CommandLine, OptionsReachTheMethod)
{
  const Settings s = parse (
      "--voxel-size 0.004 --padding 0.5 --background-voxel-size=0.02 --constraints hull --no-planes "
      "--plane 0,0,1,0.5 --plane -1,0,0,2 --alpha 0.1 --beta-hull 0.2 --beta-inter 0.3 --sigma 2 --weighting "
      "sum --solver fast-jacobi --max-iterations 7 --tolerance 0.5 --threads 3 --max-memory 1G "
      "--world-points --intrinsics 500,510,320,240 --scale 0.001 --save-sdf --json s.json --quiet a.pcd out");
  EXPECT_EQ (s.method.voxel_size_m, 0.004);
  EXPECT_EQ (s.method.padding, 0.5);
  EXPECT_EQ (s.method.background_voxel_size_m, 0.02);
  EXPECT_TRUE (s.method.use_hull);
  EXPECT_FALSE (s.method.use_intersection);
  EXPECT_FALSE (s.method.use_planes);
  ASSERT_EQ (s.planes.size (), 2u);
  EXPECT_EQ (s.planes[1], Eigen::Vector4d (-1, 0, 0, 2));
  EXPECT_EQ (s.method.alpha, 0.1);
  EXPECT_EQ (s.method.beta_hull, 0.2);
  EXPECT_EQ (s.method.beta_inter, 0.3);
  EXPECT_EQ (s.method.sigma_vox, 2.0);
  EXPECT_EQ (s.method.weighting, Weighting::Sum);
  EXPECT_EQ (s.method.solver.type, SolverType::FastJacobi);
  EXPECT_EQ (s.method.solver.max_iterations, 7);
  EXPECT_EQ (s.method.solver.tolerance_vox, 0.5);
  EXPECT_EQ (s.method.threads, 3);
  EXPECT_EQ (s.method.max_memory_bytes, std::size_t (1) << 30);
  EXPECT_TRUE (s.reading.world_points);
  EXPECT_EQ ((*s.reading.intrinsics)[1], 510.0);
  EXPECT_EQ (s.reading.scale, 0.001);
  EXPECT_TRUE (s.save_sdf);
  EXPECT_EQ (s.json, "s.json");
  EXPECT_EQ (s.verbosity, Verbosity::Quiet);
}

TEST (CommandLine, ExplicitOptionsOverrideThePreset)
{
  const CoSectionOptions paper = CoSectionOptions::paper ();
  const Settings plain = parse ("--preset paper a.pcd out");
  EXPECT_EQ (plain.method.weighting, paper.weighting);
  EXPECT_EQ (plain.method.beta_hull, paper.beta_hull);
  EXPECT_EQ (plain.method.max_passes, paper.max_passes);
  const Settings changed = parse ("a.pcd out --beta-hull 0.5 --solver multigrid --preset paper");
  EXPECT_EQ (changed.method.beta_hull, 0.5);
  EXPECT_EQ (changed.method.solver.type, SolverType::Multigrid);
  EXPECT_EQ (changed.method.beta_inter, paper.beta_inter);
}

TEST (CommandLine, ConfigurationFile)
{
  const ConfigFile file (
      "# a comment\nvoxel-size = 0.004\nplane = [0, 0, 1, 0.5, 1, 0, 0, 2]\nsolver = \"fast-jacobi\"\n"
      "save-sdf = true\nno-planes = false\nworld-points\npriors = extent,extrusion\n");
  const Settings s = parse ("--config " + file.path + " a.pcd out --solver multigrid");
  EXPECT_EQ (s.method.voxel_size_m, 0.004);
  ASSERT_EQ (s.planes.size (), 2u);
  EXPECT_EQ (s.planes[1][3], 2.0);
  EXPECT_EQ (s.method.solver.type, SolverType::Multigrid);
  EXPECT_TRUE (s.save_sdf);
  EXPECT_TRUE (s.method.use_planes);
  EXPECT_TRUE (s.reading.world_points);
  EXPECT_EQ (s.method.priors.names (), "extent,extrusion");
}

TEST (CommandLine, WrongConfigurationFiles)
{
  const auto error = [] (const std::string& content) {
    const ConfigFile file (content);
    return (usageError ("--config " + file.path + " a.pcd out"));
  };
  EXPECT_NE (error ("voxelsize = 1\n").find ("did you mean voxel-size?"), std::string::npos);
  EXPECT_NE (error ("[volume]\nvoxel-size = 1\n").find ("no sections"), std::string::npos);
  EXPECT_NE (error ("voxel-size = big\n").find ("--voxel-size"), std::string::npos);
  EXPECT_NE (error ("config = other.ini\n").find ("config"), std::string::npos);
  EXPECT_EQ (usageError ("--config missing.ini a.pcd out"), "--config: missing.ini cannot be read");
}

TEST (CommandLine, WrongUsageIsNamed)
{
  const auto expect = [] (const std::string& arguments, const std::string& part) {
    const std::string message = usageError (arguments);
    EXPECT_NE (message.find (part), std::string::npos) << arguments << ": " << message;
  };
  expect ("", "INPUT and OUTPUT are missing");
  expect ("a.pcd", "OUTPUT is missing");
  expect ("a.pcd b.pcd", "point cloud");
  expect ("--voxelsize 1 a.pcd out", "did you mean --voxel-size?");
  expect ("--voxelsize=1 a.pcd out", "did you mean --voxel-size?");
  expect ("-q a.pcd out", "unknown option -q");
  for (const char* value : {"-1", "0", "nan", "-nan", "inf", "abc", "1x"})
    expect (std::string ("a.pcd out --voxel-size ") + value, "--voxel-size");
  expect ("a.pcd out --voxel-size", "--voxel-size needs a value");
  expect ("--free-space= a.pcd b.pcd out", "--free-space needs a value; it is empty");
  expect ("--alpha 1 --alpha 2 a.pcd out", "--alpha is given more than once");
  expect ("--voxel-size 1 --resolution 64 a.pcd out", "exclude each other");
  expect ("--quiet --verbose a.pcd out", "exclude each other");
  expect ("--resolution 1.5 a.pcd out", "whole number");
  expect ("--threads 0 a.pcd out", "--threads");
  expect ("--constraints both a.pcd out", "--constraints");
  expect ("--solver gauss a.pcd out", "multigrid");
  for (const char* list : {"wall", "extrusion,,rays", "extrusion,", "all,extrusion", "extrusion,none"})
    expect (std::string ("a.pcd out --priors ") + list, "--priors: unknown prior");
  expect ("--preset mine a.pcd out", "paper");
  expect ("--format vtk a.pcd out", "--format");
  expect ("--format stl a.pcd out.ply", "contradicts");
  expect ("--plane 1,2,3 a.pcd out", "four numbers");
  expect ("--plane 0,0,0,1 a.pcd out", "normal");
  expect ("--intrinsics 0,1,2,3 a.pcd out", "--intrinsics");
  expect ("--max-memory many a.pcd out", "--max-memory");
  expect ("--scale -1 a.pcd out", "--scale");
  expect ("--preset fast a.pcd out", "--preset: \"fast\" is not valid, it must be paper");
  expect ("--format glb a.pcd out", "--format: \"glb\" is not valid, it must be ply, stl or obj");
}

TEST (CommandLine, ConfigurationFileIsOverriddenAlsoByTheOtherWayToSayTheSizeOfVoxels)
{
  const ConfigFile file ("voxel-size = 0.01\n");
  const Settings settings = parse ("--config " + file.path + " --resolution 32 a.pcd out");
  EXPECT_EQ (settings.method.resolution, 32);
  EXPECT_EQ (settings.method.voxel_size_m, 0.0);
  EXPECT_NE (usageError ("--voxel-size 0.01 --resolution 32 a.pcd out"), "");
}

TEST (CommandLine, ConfigurationLineWithoutEqualsSign)
{
  const ConfigFile file ("resolution 64\n");
  EXPECT_EQ (usageError ("--config " + file.path + " a.pcd out"),
             "the configuration file has a line without \"=\": resolution 64");
}

TEST (CommandLine, SpansOfFrames)
{
  EXPECT_EQ (parseFrames ("3:50").first, 3u);
  EXPECT_EQ (parseFrames ("3:50").last, 50u);
  EXPECT_EQ (parseFrames (":50").first, 0u);
  for (const char* to_the_end : {"3:", "0:", ":"})
    EXPECT_FALSE (parseFrames (to_the_end).last) << to_the_end;
  EXPECT_EQ (parseFrames ("7:1000000000").last, 1000000000u);
  EXPECT_EQ (parseFrames ("1000000000000:", 1e12).first, 1000000000000u);
  for (const char* wrong :
       {"", "3", "a:b", "3:2", "5:5", ":0", "-1:2", "1:2:3", "1.5:2", "nan:", ":inf", "1000000001:", ":1e300"})
    EXPECT_THROW (parseFrames (wrong), UsageError) << wrong;
}

TEST (CommandLine, FormatsThatAreNotWritten)
{
  for (const char* name : {"out.off", "out.VTP", "out.glb"})
    EXPECT_NE (usageError (std::string ("a.pcd ") + name).find ("is not written"), std::string::npos);
  EXPECT_EQ (parse ("a.pcd out.d").output, "out.d");
}
