// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pcl::cosection
{

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
  std::string name;
  std::vector<int> shape;
  std::vector<float> values;
};

/** \brief Where an image lies in a network's input: stretched over all of it, or in its middle with margins
 * (letterbox). */
struct PCL_COSECTION_EXPORT ImagePlacement
{
  int image_width = 0;
  int image_height = 0;
  int input_width = 0;
  int input_height = 0;
  int left = 0;   ///< first column of the input that shows the image
  int top = 0;    ///< first row of it
  int width = 0;  ///< columns of the input that show the image
  int height = 0; ///< rows of it

  /** \throws InvalidArgument if a size is not positive */
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

  /** \brief \throws InvalidArgument naming the first parameter outside its domain. */
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
   * boxes, or of the input if they have its size. Mask R-CNN of torchvision. Outputs whose names do not tell come in
   * this order. */
  BoxList,
  /** [1, 4 + C + K, A]: centre x, y, width and height in pixels of the input, C scores, K coefficients, for each of A
   * candidates; and [1, K, h, w]: prototypes, the weighted sums of which are the masks' logits (after D. Bolya et al.,
   * "YOLACT", ICCV 2019). YOLOv8, YOLO11. [1, A, 5 + C + K], with a score of any object before those of the classes:
   * YOLOv5. Of D and A, A is the larger one. */
  Prototypes
};

/** \brief Which form outputs have. \throws InvalidArgument saying what they are and what they should be, if none */
PCL_COSECTION_EXPORT NetworkOutputForm outputForm (const std::vector<NetworkOutput>& outputs);

/** \brief The instances that the outputs of a network tell, in the image, highest score first. Also for networks that
 * are run by other means than InstanceDetector.
 *
 * What is not finite or not in the image is left out, whatever the numbers are.
 * \throws InvalidArgument if the outputs are of no known form, do not fit the class names, or an option is outside its
 * domain */
PCL_COSECTION_EXPORT std::vector<DetectedInstance> decodeInstances (const std::vector<NetworkOutput>& outputs,
                                                                    const ImagePlacement& placement,
                                                                    const InstanceDecodingOptions& options = {});

} // namespace pcl::cosection
