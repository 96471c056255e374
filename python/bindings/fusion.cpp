// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "arrays.h"
#include "bindings.h"
#include "result_parts.h"
#include "running.h"
#include "view_data.h"

#include "fusion_command_line.h"
#include "fusion_outputs.h"

#include <pcl/cosection/fusion/sequence_fusion.h>
#include <pcl/cosection/io/rgbd_sequence.h>

#include <pcl/common/time.h>

#include <pybind11/stl.h>

#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <utility>

namespace py = pybind11;
using namespace pcl::cosection;

namespace {

template <typename Pixel, typename Scalar>
Image<Pixel>
toImage (const DenseArray<Scalar>& array)
{
  Image<Pixel> image (static_cast<int> (array.shape (1)), static_cast<int> (array.shape (0)));
  static_assert (sizeof (Pixel) % sizeof (Scalar) == 0);
  std::memcpy (image.pixels.data (), array.data (), image.pixels.size () * sizeof (Pixel));
  return image;
}

template <typename Scalar, typename Pixel>
py::array_t<Scalar>
fromImage (const Image<Pixel>& image)
{
  constexpr auto channels = static_cast<py::ssize_t> (sizeof (Pixel) / sizeof (Scalar));
  std::vector<py::ssize_t> shape = {image.height, image.width};
  if (channels > 1)
    shape.push_back (channels);
  return py::array_t<Scalar> (shape, reinterpret_cast<const Scalar*> (image.pixels.data ()));
}

/** \brief The settings of the program for a stream of frames. \throws UsageError */
FusionSettings
settingsOf (const std::vector<std::string>& options, const std::string& output)
{
  return settingsOf (parseFusionCommandLine, options, {"frames", output});
}

py::dict
posesOf (const std::map<int, Eigen::Isometry3d>& poses)
{
  py::dict dict;
  for (const auto& [id, T] : poses)
    dict[py::int_ (id)] = toArray (T.matrix ());
  return dict;
}

py::dict
toDict (const FrameReport& report)
{
  using namespace py::literals;
  py::object instances = py::none ();
  if (report.instances && !report.instances->pixels.empty ())
    instances = fromImage<std::uint16_t> (*report.instances);
  return py::dict ("T_world_camera"_a = toArray (report.T_world_camera.matrix ()),
                   "T_world_object"_a = posesOf (report.T_world_object), "instances"_a = instances,
                   "keyframe"_a = report.keyframe);
}

py::tuple
trajectoryOf (const std::vector<StampedPose>& trajectory)
{
  const auto count = static_cast<py::ssize_t> (trajectory.size ());
  py::array_t<double> stamps (count), poses ({count, py::ssize_t (4), py::ssize_t (4)});
  for (py::ssize_t n = 0; n < count; ++n)
  {
    stamps.mutable_at (n) = trajectory[static_cast<std::size_t> (n)].stamp;
    for (py::ssize_t row = 0; row < 4; ++row)
      for (py::ssize_t column = 0; column < 4; ++column)
        poses.mutable_at (n, row, column) = trajectory[static_cast<std::size_t> (n)].pose.matrix () (row, column);
  }
  return py::make_tuple (stamps, poses);
}

/** \brief A result with what it was made with. */
struct FusionResultData
{
  FusionResult result;
  std::vector<std::string> options;
};

using SharedResult = std::shared_ptr<FusionResultData>;

class StreamData
{
public:
  StreamData (std::vector<std::string> options, const std::array<double, 4>& intrinsics, int height, int width,
              bool masks, bool persistent_ids, const std::string& segmentation)
      : options_ (std::move (options))
  {
    const FusionSettings settings = settingsOf (options_, ".");
    FusionOptions fusion = settings.fusion;
    const auto segmenter = segmentation.empty () ? nullptr
                                                 : makeSegmenter (segmentation, fusion.front_end.threads, std::nullopt);
    fusion.front_end.objects = masks || segmenter;
    fusion.front_end.persistent_ids = persistent_ids;
    fusion_.emplace (toCamera (intrinsics, height, width), fusion, segmenter);
  }

  /** \return None, or the poses and instances of the frame */
  py::object add (const DenseArray<float>& depth, const OptionalArray<std::uint8_t>& colour,
                  const OptionalArray<std::uint16_t>& mask, double stamp)
  {
    RgbdFrame frame;
    frame.stamp = stamp;
    frame.depth = toImage<float> (depth);
    for (float& z : frame.depth.pixels)
      if (!(z > 0.0f))
        z = std::numeric_limits<float>::quiet_NaN ();
    if (colour)
      frame.colour = toImage<std::array<std::uint8_t, 3>> (*colour);
    std::optional<Image<std::uint16_t>> instances;
    if (mask)
      instances = toImage<std::uint16_t> (*mask);
    py::object known = py::none ();
    const auto keep = [&known] (const FrameReport& report) {
      const py::gil_scoped_acquire locked;
      known = toDict (report);
    };
    {
      const py::gil_scoped_release unlocked;
      fusion_->add (std::move (frame), instances ? &*instances : nullptr, keep);
    }
    return known;
  }

  SharedResult complete (const py::object& progress)
  {
    PythonRun run (progress);
    return run.run ([this] (const ProgressCallback& go_on) {
      auto data = std::make_shared<FusionResultData> ();
      data->result = fusion_->complete (go_on);
      data->result.timings_s["write"] = 0.0;
      data->result.timings_s["total"] = age_.getTimeSeconds ();
      data->options = options_;
      return data;
    });
  }

private:
  std::vector<std::string> options_;
  std::optional<OnlineFusion> fusion_;
  pcl::StopWatch age_;
};

py::list
objectsOf (const SharedResult& data)
{
  py::list objects;
  for (ObjectResult& object : data->result.scene.objects)
  {
    py::dict dict = objectDict (data, object);
    FusedObject& fused = data->result.objects[object.id];
    dict["seen"] = part (data, fused.tsdf);
    dict["trajectory"] = trajectoryOf (fused.trajectory);
    dict["class"] = fused.best_class
                        ? py::object (py::make_tuple (fused.best_class->class_name, fused.best_class->score))
                        : py::object (py::none ());
    objects.append (dict);
  }
  return objects;
}

std::vector<std::string>
save (FusionResultData& data, const std::string& output)
{
  const py::gil_scoped_release unlocked;
  const FusionSettings settings = settingsOf (data.options, output);
  FusionOutputs outputs (settings);
  outputs.begin ();
  const pcl::StopWatch writing;
  std::vector<std::string> files = outputs.write (data.result);
  data.result.timings_s["write"] = writing.getTimeSeconds ();
  outputs.writeSummary (data.result);
  return files;
}

/** \brief A sequence in a folder, and its masks. */
struct SequenceData
{
  SequenceData (const std::string& folder, const std::string& mask_folder) : images (folder)
  {
    warnings = images.warnings ();
    if (mask_folder.empty ())
      return;
    masks.emplace (mask_folder, images);
    warnings.insert (warnings.end (), masks->warnings ().begin (), masks->warnings ().end ());
  }

  py::tuple read (std::size_t index)
  {
    RgbdFrame frame;
    std::optional<Image<std::uint16_t>> mask;
    {
      const py::gil_scoped_release unlocked;
      frame = images.read (index, warnings);
      if (masks)
        mask = masks->read (frame.stamp);
    }
    return py::make_tuple (frame.stamp, fromImage<float> (frame.depth),
                           frame.colour.pixels.empty () ? py::object (py::none ())
                                                        : py::object (fromImage<std::uint8_t> (frame.colour)),
                           mask ? py::object (fromImage<std::uint16_t> (*mask)) : py::object (py::none ()));
  }

  RgbdSequence images;
  std::optional<MaskSequence> masks;
  std::vector<std::string> warnings;
};

} // namespace

void
bindFusion (py::module_& module)
{
  py::class_<StreamData> (module, "StreamData")
      .def (
          py::init<std::vector<std::string>, const std::array<double, 4>&, int, int, bool, bool, const std::string&> (),
          py::arg ("options"), py::arg ("intrinsics"), py::arg ("height"), py::arg ("width"), py::arg ("masks"),
          py::arg ("persistent_ids"), py::arg ("segmentation"))
      .def ("add", &StreamData::add, py::arg ("depth"), py::arg ("colour"), py::arg ("mask"), py::arg ("stamp"))
      .def ("complete", &StreamData::complete, py::arg ("progress"));
  py::class_<FusionResultData, SharedResult> (module, "FusionResultData")
      .def_property_readonly ("objects", objectsOf)
      .def_property_readonly (
          "background", [] (const SharedResult& data) { return partOrNone (data, data->result.scene.background); })
      .def_property_readonly ("camera", [] (const FusionResultData& data) { return trajectoryOf (data.result.camera); })
      .def_property_readonly ("warnings", [] (const FusionResultData& data) { return inPython (data.result.warnings); })
      .def_property_readonly ("events", [] (const FusionResultData& data) { return data.result.events; })
      .def_property_readonly ("timings_s", [] (const FusionResultData& data) { return data.result.timings_s; })
      .def_property_readonly ("frames", [] (const FusionResultData& data) { return data.result.frames; })
      .def_property_readonly ("frames_left_out",
                              [] (const FusionResultData& data) { return data.result.frames_left_out; })
      .def ("save", save, py::arg ("output"));
  py::class_<SequenceData> (module, "SequenceData")
      .def (py::init<const std::string&, const std::string&> (), py::arg ("folder"), py::arg ("masks"))
      .def ("__len__", [] (const SequenceData& data) { return data.images.size (); })
      .def ("read", &SequenceData::read, py::arg ("index"))
      .def_readonly ("warnings", &SequenceData::warnings)
      .def_property_readonly ("size",
                              [] (const SequenceData& data) {
                                return std::pair (data.images.camera ().height, data.images.camera ().width);
                              })
      .def_property_readonly ("intrinsics", [] (const SequenceData& data) {
        const PinholeCamera& camera = data.images.camera ();
        return std::array<double, 4>{camera.fx, camera.fy, camera.cx, camera.cy};
      });
}
