// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "network_process.h"

#include "opencv_network.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <memory>

namespace pcl::cosection {
namespace {

constexpr double most_import_s = 60.0; ///< processor time; large networks take a second
constexpr double most_run_s = 600.0;   ///< processor time of each thread

// What is spoilt may send any number before it crashes.
constexpr std::uint64_t most_text = 1 << 16, most_outputs = 1 << 12, most_dimensions = 64;
constexpr std::uint64_t most_values = 1 << 28; ///< of all outputs

/** \brief What an answer begins with. */
enum : std::uint64_t
{
  is_done,
  is_error
};

/** \brief The other process is gone, or sends what it cannot mean. */
class NoAnswer : public std::exception
{};

// --- What both processes say
// ---------------------------------------------------------------------------------------------------------------

/** \brief Sends numbers, texts and arrays; throws NoAnswer if nobody reads them. */
class Writer
{
public:
  explicit Writer (const Channel& channel) : channel_ (channel) {}

  void bytes (const void* data, std::size_t size) const
  {
    if (!channel_.send (data, size))
      throw NoAnswer ();
  }

  void number (std::uint64_t value) const { bytes (&value, sizeof (value)); }

  void text (const std::string& value) const
  {
    number (value.size ());
    bytes (value.data (), value.size ());
  }

private:
  const Channel& channel_;
};

/** \brief Receives what a Writer sends; throws NoAnswer if nothing comes, or a number that is too large. */
class Reader
{
public:
  explicit Reader (const Channel& channel) : channel_ (channel) {}

  void bytes (void* data, std::size_t size) const
  {
    if (!channel_.receive (data, size))
      throw NoAnswer ();
  }

  std::uint64_t number (std::uint64_t most) const
  {
    std::uint64_t value = 0;
    bytes (&value, sizeof (value));
    if (value > most)
      throw NoAnswer ();
    return (value);
  }

  /** \brief In one line. */
  std::string text () const
  {
    std::string value (number (most_text), '\0');
    bytes (value.data (), value.size ());
    std::replace_if (
        value.begin (), value.end (), [] (unsigned char c) { return (c < ' '); }, ' ');
    return (value);
  }

private:
  const Channel& channel_;
};

// --- The process that runs the network
// ---------------------------------------------------------------------------------------------------------------

void
sendOutputs (const Writer& writer, const std::vector<NetworkOutput>& outputs)
{
  std::uint64_t values = 0;
  for (const NetworkOutput& output : outputs)
    values += output.values.size ();
  if (values > most_values)
    throw IoError ("its outputs have " + std::to_string (values) + " values");
  if (outputs.size () > most_outputs)
    throw IoError ("it has " + std::to_string (outputs.size ()) + " outputs");
  writer.number (is_done);
  writer.number (outputs.size ()); // may be others than the file names, as an importer leaves some out
  for (const NetworkOutput& output : outputs)
  {
    writer.text (output.name);
    writer.number (output.shape.size ());
    for (const int size : output.shape)
      writer.number (static_cast<std::uint64_t> (size));
    writer.number (output.values.size ());
    writer.bytes (output.values.data (), sizeof (float) * output.values.size ());
  }
}

/** \brief What \a work gives, without using more than some processor time, or going on if nobody waits for it. */
template <typename Work>
auto
watched (const Channel& to_parent, double most_s, const Work& work)
{
  struct Watch
  {
    explicit Watch (const Channel& channel) : channel (channel) { channel.endIfClosed (true); }
    ~Watch () { channel.endIfClosed (false); }
    const Channel& channel;
  };
  limitProcessorTime (most_s);
  const Watch watch (to_parent);
  return (work ());
}

cv::Mat
receiveInput (const Reader& reader)
{
  const auto channels = static_cast<int> (reader.number (most_values));
  const auto height = static_cast<int> (reader.number (most_values));
  const auto width = static_cast<int> (reader.number (most_values));
  cv::Mat input ({1, channels, height, width}, CV_32F);
  reader.bytes (input.data, input.total () * input.elemSize ());
  return (input);
}

/** \brief Send what \a work sends, or the error that it throws instead. \return whether there was no error */
template <typename Work>
bool
answer (const Writer& writer, const Work& work)
{
  try
  {
    work ();
    return (true);
  }
  catch (const IoError& error)
  {
    writer.number (is_error);
    writer.text (error.what ());
  }
  return (false);
}

/** \brief Read the network, then run it for each input that comes. */
void
serve (const Channel& to_parent, const InstanceDetectorOptions& options, const std::string& model,
       const std::string& config)
{
  const Writer writer (to_parent);
  const Reader reader (to_parent);
  std::unique_ptr<OpenCvNetwork> network;
  limitMemory ();
  if (options.threads > 1)
    cv::setNumThreads (options.threads);
  const bool is_read = answer (writer, [&] {
    network = watched (to_parent, most_import_s,
                       [&] { return (std::make_unique<OpenCvNetwork> (options, model, config)); });
    if (network->outputNames ().size () > most_outputs)
      throw IoError ("it has " + std::to_string (network->outputNames ().size ()) + " outputs");
    writer.number (is_done);
    writer.number (network->outputNames ().size ());
    for (const std::string& name : network->outputNames ())
      writer.text (name);
  });
  while (is_read) // until nothing comes
  {
    const cv::Mat input = receiveInput (reader);
    answer (writer, [&] {
      sendOutputs (writer, watched (to_parent, most_run_s * options.threads, [&] { return (network->run (input)); }));
    });
  }
}

// --- The process that asks
// ---------------------------------------------------------------------------------------------------------------

/** \brief What \a receive makes of the answer to what \a ask sends. \throws IoError what went wrong there */
template <typename Ask, typename Receive>
auto
answered (ChildProcess& process, const Ask& ask, const Receive& receive)
{
  try
  {
    ask (Writer (process.channel ()));
    const Reader reader (process.channel ());
    if (reader.number (is_error) == is_error)
      throw IoError (reader.text ());
    return (receive (reader));
  }
  catch (const NoAnswer&)
  {
    throw IoError (causeOfEnd (process.waitForEnd (), "OpenCV"));
  }
}

NetworkOutput
receiveOutput (const Reader& reader)
{
  NetworkOutput output;
  output.name = reader.text ();
  output.shape.resize (reader.number (most_dimensions));
  std::uint64_t values = output.shape.empty () ? 0 : 1;
  for (int& size : output.shape)
  {
    size = static_cast<int> (reader.number (most_values));
    values = std::min (values * static_cast<std::uint64_t> (size), 2 * most_values);
  }
  if (reader.number (most_values) != values)
    throw NoAnswer ();
  output.values.resize (values);
  reader.bytes (output.values.data (), sizeof (float) * values);
  return (output);
}

} // namespace

NetworkProcess::NetworkProcess (const InstanceDetectorOptions& options, const std::string& model,
                                const std::string& config)
    : process_ ([&] (Channel& to_parent) { serve (to_parent, options, model, config); })
{
  output_names_ = answered (
      process_, [] (const Writer&) {},
      [] (const Reader& reader) {
        std::vector<std::string> names (reader.number (most_outputs));
        for (std::string& name : names)
          name = reader.text ();
        return (names);
      });
}

std::vector<NetworkOutput>
NetworkProcess::run (const cv::Mat& input)
{
  const auto send = [&] (const Writer& writer) {
    writer.number (static_cast<std::uint64_t> (input.size[1]));
    writer.number (static_cast<std::uint64_t> (input.size[2]));
    writer.number (static_cast<std::uint64_t> (input.size[3]));
    writer.bytes (input.data, input.total () * input.elemSize ());
  };
  return (answered (process_, send, [&] (const Reader& reader) {
    std::vector<NetworkOutput> outputs (reader.number (most_outputs));
    for (NetworkOutput& output : outputs)
      output = receiveOutput (reader);
    return (outputs);
  }));
}

} // namespace pcl::cosection
