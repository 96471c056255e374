// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/error.h>

#include <pybind11/pybind11.h>

#include <exception>
#include <string>

/** \brief Work of the library without the interpreter's lock, of which Python hears now and then: Ctrl-C and a callback
 * may end it.
 *
 * What Python raises meanwhile is kept, as the library is to see a cancellation, and raised when the work has ended. */
class PythonRun
{
public:
  /** \param[in] progress None, or called with a stage and a fraction; False cancels */
  explicit PythonRun (pybind11::object progress) : progress_ (std::move (progress)) {}

  /** \brief Call something that has a ProgressCallback, without the lock. */
  template <typename Work> auto run (const Work& work)
  {
    try
    {
      const pybind11::gil_scoped_release unlocked;
      return work ([this] (const std::string& stage, double fraction) { return goOn (stage, fraction); });
    }
    catch (const pcl::cosection::Cancelled&)
    {
      if (raised_)
        std::rethrow_exception (raised_);
      throw;
    }
  }

  /** \brief Run Python code with the lock; what it raises ends the work. \return whether to go on */
  template <typename Call> bool call (const Call& python)
  {
    const pybind11::gil_scoped_acquire locked;
    try
    {
      if (PyErr_CheckSignals () != 0)
        throw pybind11::error_already_set ();
      return python ();
    }
    catch (...)
    {
      raised_ = std::current_exception ();
      return false;
    }
  }

private:
  bool goOn (const std::string& stage, double fraction)
  {
    return call ([&] {
      if (progress_.is_none ())
        return true;
      const pybind11::object answer = progress_ (stage, fraction);
      return answer.is_none () || answer.cast<bool> ();
    });
  }

  pybind11::object progress_;
  std::exception_ptr raised_;
};
