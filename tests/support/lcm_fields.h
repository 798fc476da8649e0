// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <fstream>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

namespace eyeslam::support {

/// A field as a .lcm file declares it.
struct LcmField {
  std::string type, name;
  std::int64_t values = 1;  ///< of a fixed array all of its elements
  std::string count;        ///< the field that says how many, of an array of variable length; or empty
};

/// The fields of a .lcm file in their order, which is that of the encoded bytes.
inline std::vector<LcmField> lcmFields(const std::string& path)
{
  static const std::regex kField(
      R"(^\s*(double|float|int64_t|int32_t|int16_t|byte|boolean|string|\w+_t)\s+(\w+)((?:\[\w+\])*)\s*;)");
  static const std::regex kDimension(R"(\[(\w+)\])");
  std::ifstream stream(path);
  if (!stream) throw std::runtime_error(path + " is missing");
  std::vector<LcmField> fields;
  for (std::string line; std::getline(stream, line);) {
    std::smatch found;
    if (!std::regex_search(line, found, kField)) continue;
    LcmField field{found[1], found[2], 1, ""};
    const std::string dimensions = found[3];
    for (std::sregex_iterator at(dimensions.begin(), dimensions.end(), kDimension), end; at != end; ++at) {
      const std::string size = (*at)[1];
      if (std::isdigit(static_cast<unsigned char>(size[0])) != 0) {
        field.values *= std::stoll(size);
      } else {
        field.count = size;
      }
    }
    fields.push_back(field);
  }
  return fields;
}

}  // namespace eyeslam::support
