// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Fields that say to which object a point belongs.

#include "pcd_view_fixture.h"

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

TEST_F (PcdView, LabelsMayHaveOtherNames)
{
  const auto file = [this] (const std::string& name, const std::string& values = "3 4") {
    return write (header (2, 1, "ascii", "x y z " + name, "4 4 4 4", "F F F F") + "1 2 3 " + values.substr (0, 1) +
                  "\n4 5 6 " + values.substr (2) + "\n");
  };
  for (const char* name : {"Classification", "scalar_label", "CLASS", "scalar_Classification", "Label"})
  {
    SCOPED_TRACE (name);
    const LabelledView view = readPcdView (file (name));
    EXPECT_TRUE (view.has_labels);
    EXPECT_EQ (view.objects.count (3) + view.objects.count (4), 2u);
    ASSERT_FALSE (view.warnings.empty ());
    EXPECT_NE (view.warnings[0].find (name + std::string (" is taken")), std::string::npos);
  }
  PcdViewOptions options;
  options.label_field = "part";
  EXPECT_EQ (readPcdView (file ("part"), options).objects.count (4), 1u);
  EXPECT_NE (failure<IoError> (file ("piece"), options).find ("has no field part; its fields are x y z piece"),
             std::string::npos);
  const LabelledView unread = readPcdView (file ("piece"));
  EXPECT_FALSE (unread.has_labels);
  ASSERT_FALSE (unread.warnings.empty ());
  EXPECT_NE (unread.warnings[0].find ("piece, give --label-field NAME"), std::string::npos);
  EXPECT_FALSE (readPcdView (file ("class", "3 4.5")).has_labels);
  for (const std::string& warning : readPcdView (file ("height", "3 4.5")).warnings)
    EXPECT_EQ (warning.find ("--label-field"), std::string::npos) << warning;
}

TEST_F (PcdView, TheFirstOfTwoFieldsWithLabelsIsUsed)
{
  const LabelledView view = readPcdView (
      write (header (2, 1, "ascii", "x y z label label", "4 4 4 4 4", "F F F U U") + "1 2 3 4 0\n4 5 6 4 0\n"));
  EXPECT_EQ (view.objects.count (4), 1u);
  ASSERT_FALSE (view.warnings.empty ());
  EXPECT_NE (view.warnings[0].find ("has 2 fields label"), std::string::npos) << view.warnings[0];
}

TEST_F (PcdView, LabelsOfAnyTypeAndDoubles)
{
  const auto read = [this] (const std::string& label, const std::string& size, const std::string& type) {
    return (readPcdView (write (header (2, 1, "ascii", "label x y z", size + " 8 8 8", type + " F F F") + label +
                                " 1 2 3\n-0 4 5 6\n")));
  };
  EXPECT_EQ (read ("200", "1", "U").objects.count (200), 1u);
  EXPECT_EQ (read ("100", "1", "I").objects.count (100), 1u);
  EXPECT_EQ (read ("40000", "2", "U").objects.count (40000), 1u);
  EXPECT_EQ (read ("3000000", "4", "I").objects.count (3000000), 1u);
  EXPECT_EQ (read ("3000000", "8", "U").objects.count (3000000), 1u);
  EXPECT_EQ (read ("12", "4", "F").objects.count (12), 1u);
  EXPECT_EQ (read ("1.2e1", "8", "F").objects.count (12), 1u);
  EXPECT_EQ (read ("nan", "4", "F").objects.size (), 1u);
  EXPECT_EQ (read ("-inf", "8", "F").objects.size (), 1u);
  const LabelledView negative = read ("-1", "4", "I");
  EXPECT_EQ (negative.objects.size (), 1u);
  ASSERT_FALSE (negative.warnings.empty ());
  EXPECT_NE (negative.warnings[0].find ("negative label"), std::string::npos);
  const LabelledView ignored = read ("65535", "2", "U");
  EXPECT_EQ (ignored.objects.size (), 1u);
  EXPECT_EQ (ignored.objects.count (65535), 0u);
  EXPECT_FALSE (ignored.warnings.empty ());
}
