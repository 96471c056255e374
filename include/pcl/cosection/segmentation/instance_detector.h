// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief One thing that a network has found in an image. */
struct PCL_COSECTION_EXPORT DetectedInstance
{
  int class_id = 0;         ///< as the network counts
  std::string class_name;   ///< its number where there are no names
  float score = 0.0f;       ///< in [0, 1]
  int left = 0;             ///< first column of the mask in the image
  int top = 0;              ///< first row of the mask in the image
  Image<std::uint8_t> mask; ///< 1: the pixel shows it; the detected box, as far as it is in the image
};

/** \brief An array that a network gives, the last dimension running fastest. */
struct PCL_COSECTION_EXPORT NetworkOutput
{
  std::string name;          ///< as the network calls it
  std::vector<int> shape;    ///< number of values along each dimension
  std::vector<float> values; ///< as many as the product of the shape
};

/** \brief Where an image lies in a network's input: stretched over all of it, or in its middle with margins
 * (letterbox). */
struct PCL_COSECTION_EXPORT ImagePlacement
{
  int image_width = 0;  ///< pixels of the image
  int image_height = 0; ///< pixels of the image
  int input_width = 0;  ///< pixels of the input
  int input_height = 0; ///< pixels of the input
  int left = 0;         ///< first column of the input that shows the image
  int top = 0;          ///< first row of it
  int width = 0;        ///< columns of the input that show the image
  int height = 0;       ///< rows of it

  /** \brief Place the image. \throws InvalidArgument if a size is not positive */
  ImagePlacement (int image_width, int image_height, int input_width, int input_height, bool letterbox);
};

/** \brief Parameters of decodeInstances (). */
struct PCL_COSECTION_EXPORT InstanceDecodingOptions
{
  double score_threshold = 0.5;    ///< what has a lower score is not there
  double mask_threshold = 0.5;     ///< a pixel is in the mask from this probability on
  double overlap_threshold = 0.45; ///< one-stage networks: of boxes of a class with more intersection over union, one
                                   ///< stays
  int max_instances = 100;         ///< those of the highest scores
  std::vector<std::string> class_names; ///< by class_id; empty: not known

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief The arrays that an instance segmentation network may give. */
enum class NetworkOutputForm
{
  /** [1, 1, N, 7]: image, class, score, left, top, right, bottom in [0, 1] of the input; and [N, C, h, w]: masks of the
   * boxes, for each class or for all (C = 1). Mask R-CNN of TensorFlow's Object Detection API in OpenCV:
   * detection_out_final, detection_masks. */
  DetectionOut,
  /** Boxes [N, 4]: left, top, right, bottom in pixels of the input; labels [N]; scores [N]; masks [N, 1, h, w], of the
   * boxes, or of the input if they have its size. Mask R-CNN of torchvision. Outputs without such names come in
   * this order. */
  BoxList,
  /** [1, 4 + C + K, A]: centre x, y, width and height in pixels of the input, C scores, K coefficients, for each of A
   * candidates; and [1, K, h, w]: prototypes, the weighted sums of which are the masks' logits (after D. Bolya et al.,
   * "YOLACT", ICCV 2019). YOLOv8, YOLO11. [1, A, 5 + C + K], with a score of any object before those of the classes:
   * YOLOv5. A is the larger of the two dimensions. */
  Prototypes
};

/** \brief Which form outputs have. \throws InvalidArgument saying what they are and what they should be, if none */
PCL_COSECTION_EXPORT NetworkOutputForm outputForm (const std::vector<NetworkOutput>& outputs);

/** \brief The instances in the outputs of a network, placed in the image, highest score first. Also for networks that
 * are run by other means than InstanceDetector.
 *
 * What is not finite or not in the image is left out, whatever the numbers are.
 * \throws InvalidArgument if the outputs are of no known form, do not fit the class names, or an option is outside its
 * domain */
PCL_COSECTION_EXPORT std::vector<DetectedInstance> decodeInstances (const std::vector<NetworkOutput>& outputs,
                                                                    const ImagePlacement& placement,
                                                                    const InstanceDecodingOptions& options = {});

/** \brief Read the names of a network's classes: a line for each, in the network's order. Spaces around a name are
 * taken off; an empty line is a class without a name.
 * \throws IoError naming the file, if it cannot be read or is no such list */
PCL_COSECTION_EXPORT std::vector<std::string> loadClassNames (const std::string& path);

/** \brief What becomes of a network's classes. A class is given by its name or its number. */
struct PCL_COSECTION_EXPORT ClassRoles
{
  std::vector<std::string> objects; ///< become objects; empty: all that are not below
  std::vector<std::string> statics; ///< belong to the background: tables, screens
  std::vector<std::string> ignored; ///< are neither objects nor background: people

  /** \brief Check all values. \throws InvalidArgument if a class is not among the names, in two roles, or given by a
   * name where there are none */
  void validate (const std::vector<std::string>& class_names) const;
};

/** \brief Instances as an image of labels. */
struct PCL_COSECTION_EXPORT InstanceLabels
{
  Image<std::uint16_t> labels;        ///< 0 none, 1 ... objects, the one with the most pixels first; ignored_label
  std::vector<std::size_t> instances; ///< label n is instances[n - 1] of those that were given
};

/** \brief Share the pixels of an image out among instances: where several overlap, the one of the highest score has it.
 * Classes that are no objects leave it to the others; ignored ones take part.
 * \param[in] instances in the image
 * \param[in] width, height of the image, pixels
 * \param[in] roles what becomes of their classes
 * \param[in] readings 0 where a pixel belongs to nothing, as there is no reading; empty: all pixels may
 * \throws InvalidArgument if \a readings have another size */
PCL_COSECTION_EXPORT InstanceLabels labelInstances (const std::vector<DetectedInstance>& instances, int width,
                                                    int height, const ClassRoles& roles = {},
                                                    const Image<std::uint8_t>& readings = {});

/** \brief A network, and what it expects. What is not given follows from the form of its outputs:
 *
 * | | Mask R-CNN of TensorFlow | Mask R-CNN of torchvision | YOLO |
 * |---|---|---|---|
 * | input size | the image's | the image's | 640 x 640, letterbox |
 * | values | 0 to 255 | 0 to 1 | 0 to 1 |
 *
 * The first has layers detection_out_final and detection_masks, the second four outputs. */
struct PCL_COSECTION_EXPORT InstanceDetectorOptions
{
  std::string model;                 ///< file: .onnx, or a frozen graph of TensorFlow, .pb
  std::string config;                ///< file: the text graph (.pbtxt) that goes with a graph of TensorFlow
  int input_width = 0;               ///< pixels; 0: as above
  int input_height = 0;              ///< pixels; 0: as above
  std::optional<bool> letterbox;     ///< keep the image's proportions, with grey margins, instead of stretching it
  std::optional<double> scale;       ///< multiplies values from 0 to 255, once the mean is subtracted
  std::array<double, 3> mean{};      ///< subtracted from red, green and blue
  bool blue_first = false;           ///< the network takes blue, green, red
  int threads = 1;                   ///< of the network; with more, its last digits depend on how many
  InstanceDecodingOptions detection; ///< how outputs become instances

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief Finds things in colour images with an instance segmentation network of the user's, by OpenCV's DNN module on
 * the CPU. NetworkOutputForm says which networks. Those with operators that OpenCV does not have cannot be read;
 * decodeInstances () decodes what other runtimes give for them.
 *
 * OpenCV runs in a child process, as damaged networks crash it. The process lives as long as the detector, has a copy
 * of the memory that this one has changed since, and prints nothing; SIGCHLD comes when it ends.
 *
 * \code
 * pcl::cosection::InstanceDetectorOptions options;
 * options.model = "yolov5s-seg.onnx";
 * options.detection.class_names = pcl::cosection::loadClassNames ("coco.names");
 * pcl::cosection::InstanceDetector detector (options);
 * const auto instances = detector.detect (picture);
 * const auto labels = pcl::cosection::labelInstances (instances, picture.width, picture.height).labels;
 * \endcode */
class PCL_COSECTION_EXPORT InstanceDetector
{
public:
  /** \brief Read the network.
   * \throws InvalidArgument if an option is outside its domain \throws IoError naming the file, if it cannot be read as
   * a network */
  explicit InstanceDetector (const InstanceDetectorOptions& options);
  /** \brief Takes over what the other one has. */
  InstanceDetector (InstanceDetector&&) noexcept;
  /** \brief Takes over what the other one has. */
  InstanceDetector& operator= (InstanceDetector&&) noexcept;
  ~InstanceDetector ();

  /** \brief What \a picture shows, highest score first; empty if there is nothing.
   * \throws InvalidArgument if the picture has no pixels \throws IoError naming the model, if it cannot be run on such
   * an input, or is of no known form */
  std::vector<DetectedInstance> detect (const Picture& picture);

  /** \brief The options of the constructor. */
  const InstanceDetectorOptions& options () const;

private:
  struct Network;
  std::unique_ptr<Network> network_;
};

} // namespace pcl::cosection
