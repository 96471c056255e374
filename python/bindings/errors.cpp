// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "bindings.h"

#include "python_text.h"

#include "arguments.h"

#include <pcl/cosection/common/error.h>

#include <exception>

namespace py = pybind11;
using namespace pcl::cosection;

namespace {

/** \brief Python's class of each exception of the library, for as long as the interpreter is there. */
struct ErrorClasses
{
  PyObject *base, *invalid, *io, *degenerate, *memory, *cancelled;
} classes;

/** \brief A class of pcl_cosection, of two parents: the base, and the one of Python's that people expect. */
PyObject*
makeClass (py::module_& module, const char* name, const char* doc, PyObject* parent)
{
  const py::object bases = classes.base == nullptr
                               ? py::reinterpret_borrow<py::object> (parent)
                               : py::object (py::make_tuple (py::handle (classes.base), py::handle (parent)));
  const std::string full = std::string ("pcl_cosection.") + name;
  PyObject* made = PyErr_NewExceptionWithDoc (full.c_str (), doc, bases.ptr (), nullptr);
  if (made == nullptr)
    throw py::error_already_set ();
  module.add_object (name, py::reinterpret_borrow<py::object> (made));
  return made;
}

void
translate (std::exception_ptr thrown)
{
  const auto set = [] (PyObject* type, const std::exception& error) {
    PyErr_SetString (type, inPython (error.what ()).c_str ());
  };
  try
  {
    if (thrown)
      std::rethrow_exception (thrown);
  }
  catch (const UsageError& error)
  {
    set (classes.invalid, error);
  }
  catch (const InvalidArgument& error)
  {
    set (classes.invalid, error);
  }
  catch (const IoError& error)
  {
    set (classes.io, error);
  }
  catch (const DegenerateInput& error)
  {
    set (classes.degenerate, error);
  }
  catch (const MemoryLimitExceeded& error)
  {
    set (classes.memory, error);
  }
  catch (const Cancelled& error)
  {
    set (classes.cancelled, error);
  }
  catch (const Error& error)
  {
    set (classes.base, error);
  }
}

} // namespace

void
bindErrors (py::module_& module)
{
  classes.base = nullptr;
  classes.base = makeClass (module, "Error", "Base of what pcl_cosection raises; its text is one line.",
                            PyExc_Exception);
  classes.invalid = makeClass (module, "InvalidArgument",
                               "An argument has the wrong type, shape or value; the text names it.", PyExc_ValueError);
  classes.io = makeClass (module, "IoError", "A file cannot be read or written, or does not hold what it should.",
                          PyExc_OSError);
  classes.degenerate = makeClass (module, "DegenerateInput",
                                  "The input determines no surface: too few points, for example.", PyExc_ValueError);
  classes.memory = makeClass (module, "MemoryLimitExceeded", "The work would need more memory than is allowed.",
                              PyExc_MemoryError);
  classes.cancelled = makeClass (module, "Cancelled", "The progress callback returned False.", PyExc_RuntimeError);
  py::register_exception_translator (translate);
}
