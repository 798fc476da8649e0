// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as a configuration file: either a ConfigurationError, or options that survive being written and read again.
#include <cstdlib>

#include "eyeslam/configuration/assignment.h"
#include "eyeslam/configuration/listing.h"
#include "eyeslam/tracking/tracker_options.h"
#include "temporary_file.h"

using namespace eyeslam;

namespace {

tracking::TrackerOptions optionsIn(const std::uint8_t* bytes, std::size_t size)
{
  const fuzz::TemporaryFile file(bytes, size);
  return configuration::applied(tracking::TrackerOptions(), configuration::readYaml(file.path()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  try {
    const std::string setting(bytes, bytes + size);
    configuration::applied(tracking::TrackerOptions(), {configuration::parseSetting(setting)});
  } catch (const configuration::ConfigurationError&) {
  }
  try {
    const tracking::TrackerOptions options = optionsIn(bytes, size);
    const std::string written = configuration::yamlOf(options);
    const auto again = optionsIn(reinterpret_cast<const std::uint8_t*>(written.data()), written.size());
    if (configuration::hashOf(again) != configuration::hashOf(options)) std::abort();
  } catch (const configuration::ConfigurationError&) {
  }
  return 0;
}
