// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkCommand.h>
#include <vtkObject.h>
#include <vtkSmartPointer.h>

#include <string>

namespace pcl::cosection {

/** \brief Takes the errors and warnings of a VTK object, which VTK would print otherwise. */
class VtkErrors : public vtkCommand
{
public:
  vtkTypeMacro (VtkErrors, vtkCommand);

  static VtkErrors* New () { return new VtkErrors; }

  static vtkSmartPointer<VtkErrors> observe (vtkObject& object)
  {
    const auto errors = vtkSmartPointer<VtkErrors>::New ();
    object.AddObserver (vtkCommand::ErrorEvent, errors);
    object.AddObserver (vtkCommand::WarningEvent, errors);
    return errors;
  }

  void Execute (vtkObject*, unsigned long event, void*) override
  {
    failed_ = failed_ || event == vtkCommand::ErrorEvent;
  }

  bool failed () const { return failed_; }

private:
  bool failed_ = false;
};

} // namespace pcl::cosection
