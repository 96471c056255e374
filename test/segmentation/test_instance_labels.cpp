// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/segmentation/instance_detector.h>

#include "common/temporary_folder.h"

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

using namespace pcl::cosection;

namespace {

constexpr int labels_width = 20, labels_height = 10;

DetectedInstance
block (int class_id, const std::string& name, float score, int left, int top, int columns, int rows)
{
  return {class_id, name, score, left, top, Image<std::uint8_t> (columns, rows, 1)};
}

const std::vector<DetectedInstance> table_scene = {
    block (60, "table", 0.95f, 0, 0, labels_width, labels_height), // covers everything
    block (41, "cup", 0.7f, 2, 2, 4, 4),
    block (39, "bottle", 0.8f, 4, 2, 6, 6), // in front of the cup
    block (0, "person", 0.75f, 8, 0, 6, 10),
};

std::size_t
count (const InstanceLabels& labelled, std::uint16_t label)
{
  return (
      static_cast<std::size_t> (std::count (labelled.labels.pixels.begin (), labelled.labels.pixels.end (), label)));
}

class ClassNames : public testing::Test
{
protected:
  std::string write (const std::string& text) const
  {
    std::ofstream (folder_.file ("names"), std::ios::binary) << text;
    return (folder_.file ("names"));
  }

  const test::TemporaryFolder folder_;
};

} // namespace

TEST (InstanceLabels, TheHigherScoreHasAPixel)
{
  ClassRoles roles;
  roles.statics = {"table"};
  const InstanceLabels labelled = labelInstances (table_scene, labels_width, labels_height, roles);
  EXPECT_EQ (labelled.instances, (std::vector<std::size_t>{3, 2, 1})); // by pixels: 48, 36, 8
  EXPECT_EQ (labelled.labels.at (8, 4), 2);
  EXPECT_EQ (labelled.labels.at (4, 4), 2);
  EXPECT_EQ (labelled.labels.at (3, 4), 3);
  EXPECT_EQ (labelled.labels.at (10, 4), 1);
  EXPECT_EQ (labelled.labels.at (0, 0), 0);
  EXPECT_EQ (count (labelled, 1), 48u);
  EXPECT_EQ (count (labelled, 2), 36u);
  EXPECT_EQ (count (labelled, 3), 8u);
}

TEST (InstanceLabels, RolesOfClasses)
{
  ClassRoles roles;
  roles.objects = {"cup", "39"}; // by name and by number
  roles.ignored = {"person"};
  const InstanceLabels labelled = labelInstances (table_scene, labels_width, labels_height, roles);
  EXPECT_EQ (labelled.instances, (std::vector<std::size_t>{2, 1}));
  EXPECT_EQ (labelled.labels.at (10, 4), ignored_label);
  EXPECT_EQ (labelled.labels.at (9, 4), 1); // the bottle is more certain than the person
  EXPECT_EQ (count (labelled, ignored_label), 48u);
  EXPECT_EQ (labelInstances (table_scene, labels_width, labels_height).instances,
             std::vector<std::size_t>{0}); // the table has everything
}

TEST (InstanceLabels, WhatIsHiddenHasNoLabel)
{
  const std::vector<DetectedInstance> instances = {block (1, "a", 0.6f, 2, 2, 3, 3), block (2, "b", 0.9f, 1, 1, 5, 5)};
  const InstanceLabels labelled = labelInstances (instances, labels_width, labels_height);
  EXPECT_EQ (labelled.instances, std::vector<std::size_t>{1});
  EXPECT_EQ (count (labelled, 1), 25u);
}

TEST (InstanceLabels, PixelsWithoutReadingsHaveNone)
{
  Image<std::uint8_t> readings (labels_width, labels_height, 1);
  for (int v = 0; v < labels_height; ++v)
    for (int u = 0; u < 6; ++u)
      readings.at (u, v) = 0;
  ClassRoles roles;
  roles.statics = {"table"};
  roles.ignored = {"person"};
  const InstanceLabels labelled = labelInstances (table_scene, labels_width, labels_height, roles, readings);
  EXPECT_EQ (labelled.instances, std::vector<std::size_t>{2}); // nothing is left of the cup
  EXPECT_EQ (count (labelled, 1), 24u);
  EXPECT_THROW (labelInstances (table_scene, labels_width, labels_height, roles, Image<std::uint8_t> (labels_width, 1)),
                InvalidArgument);
}

TEST (InstanceLabels, MasksMayReachBeyondTheImage)
{
  const InstanceLabels labelled = labelInstances (
      {block (1, "a", 0.6f, -3, -2, 5, 5), block (1, "a", 0.6f, 18, 8, 50, 50)}, labels_width, labels_height);
  EXPECT_EQ (count (labelled, 1), 6u);
  EXPECT_EQ (count (labelled, 2), 4u);
  EXPECT_TRUE (labelInstances ({}, labels_width, labels_height).instances.empty ());
}

TEST_F (ClassNames, AreRead)
{
  EXPECT_EQ (loadClassNames (write ("person\n  traffic light \r\n\n\xc3\xa9tui\n\n\n")),
             (std::vector<std::string>{"person", "traffic light", "", "\xc3\xa9tui"}));
  EXPECT_EQ (loadClassNames (write ("cup")), std::vector<std::string>{"cup"});
}

TEST_F (ClassNames, OfNoListAreAnError)
{
  EXPECT_THROW (loadClassNames (folder_.file ("absent")), IoError);
  EXPECT_THROW (loadClassNames (write ("")), IoError);
  EXPECT_THROW (loadClassNames (write ("\n \r\n")), IoError);
  EXPECT_THROW (loadClassNames (write (std::string ("cup\n\0\0", 6))), IoError);
  EXPECT_THROW (loadClassNames (write (std::string (1000, 'a'))), IoError);
}

TEST (InstanceLabels, ImagesOfWrongSizesAreRefused)
{
  std::vector<DetectedInstance> cut = table_scene;
  cut[1].mask.pixels.resize (3);
  Image<std::uint8_t> readings (labels_width, labels_height, 1);
  EXPECT_NO_THROW (labelInstances (table_scene, labels_width, labels_height, {}, readings));
  EXPECT_THROW (labelInstances (cut, labels_width, labels_height, {}, readings), InvalidArgument);
  EXPECT_THROW (labelInstances (table_scene, -labels_width, -labels_height, {}, {}), InvalidArgument);
  readings.pixels.resize (3);
  EXPECT_THROW (labelInstances (table_scene, labels_width, labels_height, {}, readings), InvalidArgument);
}

TEST (ClassRoles, AreChecked)
{
  const std::vector<std::string> names = {"person", "cup", ""};
  const auto message = [&] (const ClassRoles& roles, const std::vector<std::string>& class_names) -> std::string {
    try
    {
      roles.validate (class_names);
    }
    catch (const InvalidArgument& error)
    {
      return (error.what ());
    }
    return {};
  };
  EXPECT_EQ (message ({{"cup"}, {"2"}, {"person"}}, names), "");
  EXPECT_EQ (message ({{"41"}, {}, {}}, {}), "");
  EXPECT_NE (message ({{"cups"}, {}, {}}, names).find ("\"cups\""), std::string::npos);
  EXPECT_NE (message ({{"3"}, {}, {}}, names), "");
  EXPECT_NE (message ({{""}, {}, {}}, names), "");
  EXPECT_NE (message ({{"cup"}, {}, {}}, {}).find ("names are not given"), std::string::npos);
  EXPECT_NE (message ({{"cup"}, {}, {"cup"}}, names), "");
}
