// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "pcl_cosection/io/npy.h"

#include "common/temporary_folder.h"

#include <pcl/cosection/common/error.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <numeric>

using namespace pcl::cosection;

namespace {

const std::string python = "/usr/bin/python3"; // for which python3-numpy is

std::vector<float>
ascending (std::size_t count)
{
  std::vector<float> values (count);
  std::iota (values.begin (), values.end (), 0.5f);
  return values;
}

/** \brief What NumPy says of a file: its element type, order, shape and elements, or of what it fails on. */
std::string
asNumpyReadsIt (const std::string& path, const test::TemporaryFolder& folder)
{
  const std::string script = "import numpy, sys\n"
                             "a = numpy.load (sys.argv[1])\n"
                             "print (a.dtype.str, a.flags.c_contiguous, list (a.shape), a.ravel ().tolist ())\n";
  test::writeFile (folder.file ("read.py"), script);
  const std::string command = python + " '" + folder.file ("read.py") + "' '" + path + "' > '" + folder.file ("said") +
                              "' 2>&1";
  EXPECT_EQ (std::system (command.c_str ()), 0) << test::readFile (folder.file ("said"));
  return test::readFile (folder.file ("said"));
}

} // namespace

TEST (Npy, HasAnAlignedHeaderAndTheValues)
{
  for (const std::vector<std::size_t>& shape :
       std::vector<std::vector<std::size_t>>{{6}, {2, 3}, {1, 1, 6}, {1, 6, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}})
  {
    const std::vector<float> values = ascending (6);
    const std::string bytes = encodeNpy (values, shape);
    ASSERT_GT (bytes.size (), 10u);
    EXPECT_EQ (bytes.substr (0, 8), std::string ("\x93NUMPY\x01\x00", 8));
    const std::size_t header = static_cast<unsigned char> (bytes[8]) + 256u * static_cast<unsigned char> (bytes[9]);
    EXPECT_EQ ((10 + header) % 64, 0u);
    ASSERT_EQ (bytes.size (), 10 + header + 6 * sizeof (float));
    EXPECT_EQ (bytes[10 + header - 1], '\n');
    EXPECT_EQ (std::memcmp (bytes.data () + 10 + header, values.data (), 6 * sizeof (float)), 0);
  }
  EXPECT_NE (encodeNpy (ascending (6), {2, 3}).find ("'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, ), "),
             std::string::npos);
}

TEST (Npy, IsReadByNumpy)
{
  if (std::system ((python + " -c 'import numpy' > /dev/null 2>&1").c_str ()) != 0)
    GTEST_SKIP () << python << " has no NumPy";
  const test::TemporaryFolder folder;
  const std::string path = folder.file ("a.npy");
  test::writeFile (path, encodeNpy (ascending (6), {1, 2, 3}));
  EXPECT_EQ (asNumpyReadsIt (path, folder), "<f4 True [1, 2, 3] [0.5, 1.5, 2.5, 3.5, 4.5, 5.5]\n");
  test::writeFile (path, encodeNpy (ascending (2), {2}));
  EXPECT_EQ (asNumpyReadsIt (path, folder), "<f4 True [2] [0.5, 1.5]\n");
  test::writeFile (path, encodeNpy ({}, {0, 4}));
  EXPECT_EQ (asNumpyReadsIt (path, folder), "<f4 True [0, 4] []\n");
}

TEST (Npy, MustBeFilled)
{
  EXPECT_THROW (encodeNpy (ascending (5), {2, 3}), InvalidArgument);
  EXPECT_THROW (encodeNpy (ascending (7), {2, 3}), InvalidArgument);
}
