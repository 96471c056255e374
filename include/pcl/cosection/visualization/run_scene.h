// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/evaluation/run_evaluation.h>
#include <pcl/cosection/io/rgbd_sequence.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief Which surface of an object is shown. */
enum class SurfaceMode
{
  Completed, ///< the completed mesh
  Tsdf,      ///< what was seen of it; of the background, its mesh
  Points,    ///< the readings of one frame, for all objects and the background together
};

/** \brief How far the vertices of an object's surfaces are from the truth, metres; empty: not known. */
struct PCL_COSECTION_EXPORT VertexErrors
{
  std::vector<double> completed; ///< of the completed mesh
  std::vector<double> tsdf;      ///< of what was seen
};

/** \brief What there is to show of a run: where everything was at each frame, and its surfaces. */
struct PCL_COSECTION_EXPORT RunScene
{
  /** \brief Where the vertex errors of the background are. */
  static constexpr int background = PairPenetration::background;

  std::string folder;                 ///< that was read
  SceneRecord run;                    ///< poses and completed meshes; intrinsics if the summary has them
  std::map<int, TriangleMesh> tsdf;   ///< what was seen, by object; object frame
  std::map<int, VertexErrors> errors; ///< by object; see measureErrors ()
  double error_max_m = 0.01;          ///< at the red end of their colours
  std::map<int, std::string> classes; ///< what objects are, by object, as far as the summary names them
  std::string dataset;                ///< that the run has read, as its summary names it; may be empty
  SequenceSource source;              ///< how it was read
  bool of_views = false;              ///< what pcl_cosection made of views, which has no images
  std::optional<Eigen::Vector3d> up;  ///< normal of what the objects stand on, as the summary has it; unit

  /** \brief The camera's stamps, ascending: the frames of the run. */
  std::vector<double> stamps () const;

  /** \brief T_world_camera of the frame nearest to \a stamp, at most half a frame away. */
  std::optional<Eigen::Isometry3d> cameraAt (double stamp) const;

  /** \brief T_world_object likewise; nothing where the object is not known, which is not shown then.
   * \param[in] object of run.objects
   * \param[in] stamp seconds, or the number of a frame */
  std::optional<Eigen::Isometry3d> poseAt (const SceneRecord::Object& object, double stamp) const;

  /** \brief The mesh of an object, or of the \a background; empty: there is none, or the mode is Points. */
  const TriangleMesh& surface (int id, SurfaceMode mode) const;

  /** \brief The errors of the vertices of surface (); empty: not known. */
  const std::vector<double>& surfaceErrors (int id, SurfaceMode mode) const;

  /** \brief The camera of the images, or one of 640 x 480 pixels if it is not known. */
  PinholeCamera camera () const;
};

/** \brief How much of a run to load. */
struct PCL_COSECTION_EXPORT RunSceneOptions
{
  std::size_t triangles = 0; ///< decimate the background to so many, and each object to half as many, to draw them
                             ///< faster; 0: none
};

/** \brief Read what a run wrote: as readRun (), and mesh/object_ID_tsdf.ply, and of summary.json the camera, the
 * dataset, the planes and the objects' classes. What pcl_cosection made of views is read too: each INPUT with a
 * viewpoint is a frame, whose stamp is its number, and coordinates are relative to the origin_m of its summary. Nothing
 * is written.
 * \param[in] folder of the run
 * \param[out] notes what is missing or cannot be read
 * \param[in] options how much of it
 * \throws IoError naming the folder: it is not there, is a dataset or something else, or the run failed or did not come
 * to its end */
PCL_COSECTION_EXPORT RunScene loadRunScene (const std::string& folder, ReadingNotes& notes,
                                            const RunSceneOptions& options = {});

/** \brief Set the distance of every vertex to the truth: errors, and error_max_m, 95 % of them rounded up. What matches
 * nothing true has no errors.
 * \param[in,out] scene the run
 * \param[in] truth of the scene
 * \param[in] evaluation of scene.run with that truth, as evaluateRun () returns it
 * \param[in] threads 0: all */
PCL_COSECTION_EXPORT void measureErrors (RunScene& scene, const SceneRecord& truth, const RunEvaluation& evaluation,
                                         int threads = 0);

/** \brief Evaluate the run as quickly as can be, and set the distance of every vertex to the truth. \return its
 * warnings \throws DegenerateInput as evaluateRun () */
PCL_COSECTION_EXPORT std::vector<std::string> measureErrors (RunScene& scene, const SceneRecord& truth,
                                                             int threads = 0);

} // namespace pcl::cosection
