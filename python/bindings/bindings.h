// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

/** \brief Exceptions of the module, and how those of the library become them. */
void bindErrors (pybind11::module_& module);

/** \brief Meshes, signed distances and what they are made of. */
void bindMeshes (pybind11::module_& module);

/** \brief Views, their completion, and its result. */
void bindCompletion (pybind11::module_& module);

/** \brief Objects in an image by their geometry. */
void bindSegmentation (pybind11::module_& module);

/** \brief Comparison of meshes, and bodies for simulators. */
void bindEvaluation (pybind11::module_& module);

/** \brief Tracking and completion of a stream of frames. */
void bindFusion (pybind11::module_& module);
