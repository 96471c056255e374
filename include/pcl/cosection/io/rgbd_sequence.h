// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/io/trajectory.h>

#include <Eigen/Geometry>

#include <array>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace pcl::cosection {

/** \brief Pixels. */
struct ImageSize
{
  int width = 0;  ///< columns
  int height = 0; ///< rows
};

/** \brief How the files of a sequence are laid out. */
enum class SequenceFormat
{
  Detect,
  CoFusion,    ///< colour|color|rgb/ColorNNNN.* or NNNN.*, depth_noise/ or depth/ with DepthNNNN.exr (metres) or .png
  Tum,         ///< associations.txt, or depth.txt and rgb.txt
  SevenScenes, ///< frame-NNNNNN.color.*, frame-NNNNNN.depth.*, frame-NNNNNN.pose.txt
};

/** \brief How to read a sequence. */
struct PCL_COSECTION_EXPORT SequenceSource
{
  SequenceFormat format = SequenceFormat::Detect;  ///< Detect: by the files that are there
  std::string depth_folder;                        ///< of the Co-Fusion layout; empty: depth_noise, else depth
  double depth_scale = 0.0;                        ///< units of a PNG per metre; 0: 5000 for TUM, 1000 for others
  std::optional<std::array<double, 4>> intrinsics; ///< fx, fy, cx, cy in pixels, instead of calibration.txt

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief Where one frame of a sequence is. */
struct PCL_COSECTION_EXPORT FrameFiles
{
  double stamp = 0.0; ///< seconds, or the number in the file's name where the data has no times
  std::string depth;  ///< path
  std::string colour; ///< path; empty: none
  std::string pose;   ///< path; empty: none
};

/** \brief One frame of a sequence. */
struct PCL_COSECTION_EXPORT RgbdFrame
{
  std::size_t index = 0; ///< in the sequence
  double stamp = 0.0;    ///< seconds, or the number in the file's name where the data has no times
  Image<float> depth;    ///< metres along the optical axis; NaN: no reading
  Picture colour;        ///< of the depth's size; empty if the frame has none
};

/** \brief A sequence of RGB-D frames in a folder.
 *
 * It holds names only; frames are read one by one, so it may be of any length, and several threads may read. In detail:
 * * The numbers of the Co-Fusion and the 7-Scenes layout may start anywhere, have any number of digits, and gaps.
 * * A list of TUM's layout has lines "stamp file", associations.txt "stamp file stamp file" with colour and depth in
 * either order. Without it, a depth image has the colour image nearest in time, up to 0.02 s, and none has two. The
 * stamp of a frame is that of its depth.
 * * Numbers of 16 or 19 digits are times in micro- or nanoseconds. Where the depth images' numbers are not those of the
 * colour images but times, they are associated as in TUM's layout.
 * * The camera is in calibration.txt, "fx fy cx cy [width height]" in pixels, or in cam_K.txt (3 x 3),
 * camera_intrinsic.json (Open3D), scene_camera.json (BOP) or cam_params.json (Replica), which also tell the scale, or
 * in a folder intrinsic (ScanNet). Without a size, that of the first depth image that can be read is taken. One of
 * another resolution is scaled, if sizes tell it: its own, or that of the colour images where its principal point is in
 * the middle of these. 7-Scenes' layout does without: 585 585 320 240 640 480.
 * * Poses are in frame-NNNNNN.pose.txt (7-Scenes), or, in the Co-Fusion layout, in pose/N.txt (ScanNet) or traj.txt
 * (Replica; loadTrajectory ()).
 * * In 7-Scenes' layout a depth of 65535 is no reading.
 *
 * \code
 * const RgbdSequence sequence ("toycars");
 * std::vector<std::string> warnings;
 * for (std::size_t n = 0; n < sequence.size (); ++n)
 *   use (sequence.read (n, warnings).depth, sequence.camera ());
 * \endcode
 * FrameReader reads ahead and skips what is damaged. */
class PCL_COSECTION_EXPORT RgbdSequence
{
public:
  /** \brief List the frames of a folder.
   * \throws IoError if there is no such folder, no layout is recognised, a line of a list cannot be read, there are no
   * frames, calibration.txt is missing or wrong, or no depth image can be read for the size
   * \throws InvalidArgument if an option is outside its domain */
  explicit RgbdSequence (const std::string& folder, const SequenceSource& source = {});

  /** \brief Number of frames. */
  std::size_t size () const { return files_.size (); }

  /** \brief By ascending stamps. */
  const FrameFiles& files (std::size_t index) const { return files_[index]; }

  /** \brief Stamp of a frame. */
  double stamp (std::size_t index) const { return files_[index].stamp; }

  /** \brief Stamps of all frames, ascending. */
  std::vector<double> stamps () const;

  /** \brief Median time from one frame to the next; 1 for a single frame. */
  double period () const { return period_; }

  /** \brief The camera of the depth images. */
  const PinholeCamera& camera () const { return camera_; }

  /** \brief What was asked for or detected. */
  SequenceFormat format () const { return format_; }

  /** \brief Units of a PNG per metre. */
  double depthScale () const { return depth_scale_; }

  /** \brief Lines about what is odd: depth without colour, stamps twice, missing numbers. */
  const std::vector<std::string>& warnings () const { return warnings_; }

  /** \brief Read a frame. A colour image that is missing, damaged or of another aspect than the depth leaves colour
   * empty and adds a line to \a warnings; one of the same aspect is brought to the depth's size. Depths that seem to
   * have the wrong unit do so, too.
   * \throws IoError naming the file, if its depth is missing or damaged, or has another size than the camera
   * \throws InvalidArgument if there is no such frame */
  RgbdFrame read (std::size_t index, std::vector<std::string>& warnings) const;

  /** \brief T_world_camera of a frame as 7-Scenes' pose file gives it; nothing if there is none. One that is not finite
   * or not rigid (the tracking was lost) counts as missing and adds a line to \a warnings. \throws InvalidArgument if
   * there is no such frame */
  std::optional<Eigen::Isometry3d> givenPose (std::size_t index, std::vector<std::string>& warnings) const;

  /** \brief T_world_camera of all frames that have one, by ascending stamps. */
  std::vector<StampedPose> givenTrajectory (std::vector<std::string>& warnings) const;

private:
  void setCamera (const std::string& folder, const SequenceSource& source);

  /** \brief Bring the camera to the size of the depth images, where it tells another, or its principal point is that of
   * the colour images. \param[in] name of where the camera is from \param[in] is_given by the user */
  void fitCameraToDepth (const std::string& folder, const std::string& name, bool is_given);

  /** \brief The sizes of the first depth images that can be read, or of one. */
  std::vector<ImageSize> depthSizes (const std::string& folder, bool may_fail);

  std::optional<ImageSize> colourSize () const;

  SequenceFormat format_ = SequenceFormat::Detect;
  double depth_scale_ = 1000.0;
  bool scale_is_assumed_ = false; // that of the TUM benchmark, though another camera may have written the images
  double period_ = 1.0;
  PinholeCamera camera_;
  std::string size_source_; // for messages
  std::vector<FrameFiles> files_;
  std::string trajectory_; // path of the frames' poses; empty: none
  std::vector<std::string> warnings_;
};

/** \brief Which frames FrameReader reads. */
struct PCL_COSECTION_EXPORT FrameRange
{
  std::size_t first = 0;                                       ///< index
  std::size_t last = std::numeric_limits<std::size_t>::max (); ///< index of the frame behind the last; larger: the
                                                               ///< sequence's end
};

/** \brief Reads the frames of a sequence ahead, in a thread of its own.
 *
 * Frames come in their order. One that cannot be read is skipped; warnings () names it. The same files give the same
 * frames and warnings, however the threads run.
 *
 * \code
 * FrameReader reader (sequence);
 * while (const std::optional<RgbdFrame> frame = reader.next ())
 *   use (*frame);
 * \endcode */
class PCL_COSECTION_EXPORT FrameReader
{
public:
  /** \brief Start to read. The reader has a copy of the sequence, which is names only.
   * \param[in] sequence the frames
   * \param[in] range which of them
   * \param[in] ahead frames that are held at most until they are asked for
   * \throws InvalidArgument if the range has no frame of the sequence, or \a ahead is 0 */
  explicit FrameReader (const RgbdSequence& sequence, const FrameRange& range = {}, std::size_t ahead = 4);

  /** \brief Stops as soon as the frame that is being read is done. */
  ~FrameReader ();

  FrameReader (const FrameReader&) = delete;
  FrameReader& operator= (const FrameReader&) = delete;

  /** \brief The next frame that can be read; waits for it. Nothing at the end, again and again.
   * \throws std::bad_alloc if memory ran out even for a message about a frame */
  std::optional<RgbdFrame> next ();

  /** \brief Lines about the frames up to the last that next () returned, in their order: the first twenty, then how
   * many more. From any thread. */
  std::vector<std::string> warnings () const;

  /** \brief How many frames were skipped up to the last that next () returned. From any thread. */
  std::size_t skipped () const;

private:
  struct Result
  {
    std::optional<RgbdFrame> frame; // nothing: skipped
    std::vector<std::string> warnings;
  };

  void run (std::size_t first, std::size_t last) noexcept;

  void readFrames (std::size_t first, std::size_t last);

  Result readFrame (std::size_t index) const;

  const RgbdSequence sequence_;
  const std::size_t ahead_;

  mutable std::mutex mutex_; // of what follows
  std::condition_variable changed_;
  std::deque<Result> results_;
  bool done_ = false;
  bool stop_ = false;
  std::exception_ptr failure_;
  std::vector<std::string> kept_warnings_;
  std::size_t more_warnings_ = 0;
  std::size_t skipped_ = 0;

  std::thread thread_; // last: it uses the rest
};

/** \brief A file of masks. */
struct MaskFile
{
  std::string path;           ///< of a PNG
  std::uint16_t instance = 0; ///< 0: the pixels tell
};

/** \brief Masks of instances for the frames of a sequence: a folder of PNGs of one channel of 8 or 16 bits (or several
 * equal ones, or a palette), a file per frame that has one, or one per instance of it. A pixel is the number of an
 * instance, 0 none. A name ends in the frame's number or stamp: Mask0003.png, 0.033333.png; or in that and the
 * instance's, from 0, as the BOP benchmark has it: 000003_000001.png, whose pixels that are not 0 are instance 2.
 * Pixels of several instances have none. Masks of one object each may also be named OBJECT_FRAME: 2_0003.png is object
 * 2, can_0003.png has a number by the order of the alphabet. Masks of another resolution and the same shape are brought
 * to the depth's. Where the first mask has 255 only in a narrow band beside all instances, as PASCAL VOC has it, 255 is
 * left out, as 65535 is. Several threads may read.
 *
 * \code
 * const MaskSequence masks ("toycars/mask", sequence);
 * if (const auto mask = masks.read (sequence.stamp (0)))
 *   use (*mask);
 * \endcode */
class PCL_COSECTION_EXPORT MaskSequence
{
public:
  /** \brief List the masks for a sequence.
   * \throws IoError if there is no such folder, it has no masks, or none of them matches a frame */
  MaskSequence (const std::string& folder, const RgbdSequence& sequence);

  /** \brief How many frames have masks. */
  std::size_t size () const { return files_.size (); }

  /** \brief The first file for a frame: that of the nearest stamp if it is less than half a frame period away; else
   * nothing. */
  std::optional<std::string> file (double stamp) const;

  /** \brief Read the mask for a frame; nothing if there is none.
   * \throws IoError naming the file, if it is damaged, is no mask, or has another size than the depth */
  std::optional<Image<std::uint16_t>> read (double stamp) const;

  /** \brief Whether there is a file for each instance. */
  bool isPerInstance () const { return per_instance_; }

  /** \brief Lines about what is odd: files that match no frame, or whose names have no number; two of one number; a
   * first mask of many specks. */
  const std::vector<std::string>& warnings () const { return warnings_; }

private:
  Image<std::uint16_t> readFile (const std::string& path) const;

  /** \brief Warn of a first mask that is blurred, or whose background is an instance; find out whether 255 is one. */
  void judgeFirst ();

  double half_period_;
  int width_;
  int height_;
  bool per_instance_ = false;
  bool has_void_ = false;                    // 255 is no instance
  std::vector<double> stamps_;               // ascending
  std::vector<std::vector<MaskFile>> files_; // of each stamp: one, or one per instance
  std::vector<std::string> warnings_;
};

} // namespace pcl::cosection
