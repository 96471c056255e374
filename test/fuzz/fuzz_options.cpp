// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Bytes as a command line: an argument per line (or, if there is a zero byte, between zero bytes). The first may be the
// name of a program, else it is pcl_cosection.
// What follows a line "%%" is the configuration file that the argument @config@ names.

#include "fuzz_target.h"
#include "memory_file.h"

#include "command_line.h"
#include "fusion_command_line.h"
#include "report_command_line.h"
#include "segment_command_line.h"
#include "simulate_command_line.h"
#include "viewer_command_line.h"

#include <pcl/cosection/common/error.h>

#include <iostream>
#include <optional>
#include <sstream>

using namespace pcl::cosection;

namespace {

const std::string placeholder = "@config@";
const std::string separator = "%%\n";

std::vector<std::string>
split (const std::string& text)
{
  std::vector<std::string> arguments;
  const char end = text.find ('\0') == std::string::npos ? '\n' : '\0';
  std::istringstream stream (text);
  for (std::string argument; std::getline (stream, argument, end);)
    arguments.push_back (argument.c_str ());
  return (arguments);
}

/** \brief Whether the arguments name a file to read other than ours: it may be one that never ends. */
bool
readsOtherFiles (const std::vector<std::string>& arguments, const std::string& own)
{
  const std::string option = "--config";
  for (std::size_t i = 0; i < arguments.size (); ++i)
    if (arguments[i].rfind (option, 0) == 0)
    {
      const bool inside = arguments[i].size () > option.size ();
      const std::string file = inside                      ? arguments[i].substr (option.size () + 1)
                               : i + 1 < arguments.size () ? arguments[i + 1]
                                                           : "";
      if (file != own && file.find ('/') != std::string::npos)
        return (true);
    }
  return (false);
}

/** \brief While it lives, nothing is printed on standard output. */
class SilentOutput
{
public:
  SilentOutput () : buffer_ (std::cout.rdbuf (&nowhere_)) {}
  SilentOutput (const SilentOutput&) = delete;
  SilentOutput& operator= (const SilentOutput&) = delete;
  ~SilentOutput () { std::cout.rdbuf (buffer_); }

private:
  std::stringbuf nowhere_;
  std::streambuf* buffer_;
};

void
check (const Settings& settings)
{
  fuzz::require (!settings.inputs.empty () && !settings.output.empty (), "there are inputs and an output");
  fuzz::require (settings.format == "ply" || settings.format == "stl" || settings.format == "obj", "a known format");
  settings.method.validate ();
  settings.reading.validate ();
  for (const Eigen::Vector4d& plane : settings.planes)
    fuzz::require (plane.allFinite () && plane.head<3> ().norm () > 0.0, "planes have a normal");
}

void
check (const FusionSettings& settings)
{
  fuzz::require (!settings.dataset.empty () && !settings.output.empty (), "there are an input and an output");
  settings.source.validate ();
}

void
check (const SegmentSettings& settings)
{
  fuzz::require (!settings.input.empty () && !settings.output.empty (), "there are an input and an output");
  settings.segmentation.validate ();
}

void
check (const SimulateSettings& settings)
{
  const bool prints = settings.list_presets || !settings.print_preset.empty ();
  fuzz::require (prints || !settings.output.empty (), "there is an output");
  fuzz::require (settings.first_frame >= 0, "frames are counted from 0");
}

void
check (const ReportSettings& settings)
{
  fuzz::require (!settings.run.empty () && !settings.output.empty (), "there are an input and an output");
}

void
check (const ViewerSettings& settings)
{
  fuzz::require (!settings.run.empty () && settings.every > 0, "there is an input, and frames go on");
  settings.view.validate ();
}

/** \return whether the command line was accepted \throws Error */
template <typename Settings>
bool
reads (std::optional<Settings> (*parse) (int argc, const char* const* argv), const std::vector<const char*>& arguments)
{
  std::optional<Settings> settings;
  {
    const SilentOutput silent;
    settings = parse (static_cast<int> (arguments.size ()), arguments.data ());
  }
  if (settings)
    check (*settings);
  return (true);
}

bool
readsAs (const std::string& program, const std::vector<const char*>& arguments)
{
  if (program == "pcl_cosection_fusion")
    return (reads (parseFusionCommandLine, arguments));
  if (program == "pcl_cosection_segment")
    return (reads (parseSegmentCommandLine, arguments));
  if (program == "pcl_cosection_simulate")
    return (reads (parseSimulateCommandLine, arguments));
  if (program == "pcl_cosection_report")
    return (reads (parseReportCommandLine, arguments));
  if (program == "pcl_cosection_viewer")
    return (reads (parseViewerCommandLine, arguments));
  return (reads (parseCommandLine, arguments));
}

} // namespace

std::vector<std::string>
fuzz::seeds ()
{
  return {
      "in.pcd\nout\n",
      "front.pcd\nleft.pcd\ncup.ply\n",
      "--plane\n0,0,1,0.72\n--voxel-size\n0.003\ncup.pcd\ncup.stl\n",
      "--preset\npaper\n--constraints\nhull\n--json\nsummary.json\nscene.pcd\nout\n",
      "--world-points\n--intrinsics\n500,510,320,240\n--scale=0.001\n--resolution\n64\n--padding\n0.5\n"
      "--background-voxel-size\n0.01\n--max-memory\n1.5GiB\nin.pcd\nout\n",
      "--no-planes\n--alpha\n0.1\n--beta-hull\n1e3\n--beta-inter\n0\n--sigma\n2\n--weighting\nsum\n--solver\n"
      "fast-jacobi\n--max-iterations\n7\n--tolerance\n1e-3\nin.pcd\nout\n",
      "--plane\n-1,0,0,2\n--plane\n0,0,1,0\n--format\nobj\n--save-sdf\n--threads\n3\n--verbose\n--\n-in.pcd\nout\n",
      "--quiet\nin.pcd\n./-out\n",
      "--viewpoint\n-0.5,1,2\n--viewpoint=1,2,3\na.pcd\nb.pcd\nout\n",
      "--free-space\nb.pcd\n--free-space=c.pcd\n--object-trajectory\n1=t.txt\n--save-hull\nin.pcd\nout\n",
      "--config\n@config@\nin.pcd\nout\n%%\nvoxel-size = 0.004\nplane = [0, 0, 1, 0.72]\n",
      "pcl_cosection_fusion\n--camera-trajectory\nc.txt\n--object-trajectory\n3=o.txt\n--masks\nmasks\n--frames\n"
      "0:10\n--format\ntum\n--intrinsics\n500,500,320,240\n--depth-scale\n5000\n--keyframe-every\n5\ndata\nout\n",
      "pcl_cosection_fusion\n--segmentation\nmotion\n--ignore-region\n0,0,10,20\n--max-depth\n4\n--live\ndata\nout\n",
      "pcl_cosection_segment\n--max-object-size\n0.4\n--min-support-area\n0.1\n--json\ns.json\nin.pcd\nout.pcd\n",
      "pcl_cosection_segment\n--method\nmask-rcnn\n--model\nm.onnx\n--classes\ncup,3\n--input-size\n640,640\n"
      "--input-mean\n1,2,3\nin.pcd\nout.pcd\n",
      "pcl_cosection_simulate\n--preset\ntable\n--frames\n0:5\n--seed\n7\n--views-every\n2\nout\n",
      "pcl_cosection_simulate\n--meshes\nthings\n--per-scene\n3\n--views\n2\n--camera-height\n0.5\nout\n",
      "pcl_cosection_report\n--truth\ndata\n--compare\nother\n-o\nr.html\nrun\n",
      "pcl_cosection_viewer\n--mode\ntsdf\n--colour\nerror\n--truth\ndata\n--size\n640x480\n--hide\npath\n"
      "--screenshot\na.png\nrun\n",
      "pcl_cosection_viewer\n--record\nframes\n--every\n3\n--viewpoint\nv.json\nrun\n",
      "in.pcd\nout.obj\n--config=@config@\n%%\n# a comment\nquiet = true\nno-planes\nthreads = 2\n"
      "intrinsics = \"500,500,320,240\"\nconstraints = 'none'\n"};
}

std::vector<std::string>
fuzz::dictionary ()
{
  return {"--voxel-size",
          "--resolution",
          "--padding",
          "--background-voxel-size",
          "--max-memory",
          "--preset",
          "paper",
          "--constraints",
          "hull",
          "none",
          "all",
          "intersection",
          "--no-planes",
          "--alpha",
          "--beta-hull",
          "--beta-inter",
          "--sigma",
          "--weighting",
          "mean",
          "sum",
          "--solver",
          "multigrid",
          "fast-jacobi",
          "--max-iterations",
          "--tolerance",
          "--format",
          "ply",
          "--save-sdf",
          "--json",
          "--threads",
          "--verbose",
          "--quiet",
          "--config",
          "@config@",
          "--version",
          "--help",
          "-h",
          "--",
          "-",
          "--plane",
          "--intrinsics",
          "--scale",
          "--world-points",
          "0,0,1,0",
          "1,2,3",
          "1G",
          "5k",
          "[",
          "]",
          "[a.b]",
          "\"",
          "'",
          "%%\n",
          "true",
          "false",
          "=",
          ",",
          "++",
          "--x",
          "\\",
          "a.pcd",
          "a.ply",
          "--free-space",
          "--obstacle",
          "--object-trajectory",
          "1=t.txt",
          "--max-faces",
          "--save-hull",
          "--save-bounds",
          "--viewpoint",
          "--frames",
          "0:5",
          "--masks",
          "--segmentation",
          "--model",
          "--classes",
          "--ignore-region",
          "1,2,3,4",
          "--size",
          "640x480",
          "--screenshot",
          "--seed",
          "pcl_cosection_fusion\n",
          "pcl_cosection_viewer\n",
          "[[",
          "\"\"\"",
          "'''",
          "{",
          ";",
          "out.pcd"};
}

bool
fuzz::accepts (const std::string& input)
{
  static MemoryFile file;
  const std::size_t cut = input.find (separator);
  file.set (cut == std::string::npos ? "" : input.substr (cut + separator.size ()));
  std::vector<std::string> arguments = split (input.substr (0, cut));
  for (std::string& argument : arguments)
    if (const std::size_t i = argument.find (placeholder); i != std::string::npos)
      argument.replace (i, placeholder.size (), file.path ());
  if (readsOtherFiles (arguments, file.path ()))
    return (false);
  const bool is_named = !arguments.empty () && arguments.front ().rfind ("pcl_cosection", 0) == 0;
  std::vector<const char*> pointers;
  if (!is_named)
    pointers.push_back ("pcl_cosection");
  for (const std::string& argument : arguments)
    pointers.push_back (argument.c_str ());
  try
  {
    return (readsAs (pointers.front (), pointers));
  }
  catch (const UsageError& error)
  {
    require (error.what ()[0] != '\0', "an error has a message"); // main () makes it one line
  }
  catch (const IoError& error) // of a file that is read as well
  {
    requireMessage (error.what ());
  }
  return (false);
}
