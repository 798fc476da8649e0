// SPDX-License-Identifier: GPL-3.0-or-later
#include "servo/registration_file.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/partial_file.h"
#include "eyeslam/files/whole_file.h"

namespace eyeslam::apps {
namespace {

using files::FileError;
using nlohmann::ordered_json;

constexpr int kVersion = 1;

// Row by row, as in the message.
template <class Matrix>
std::vector<double> listOf(const Matrix& matrix)
{
  std::vector<double> list;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) list.push_back(matrix(row, column));
  }
  return list;
}

class Reader {
 public:
  Reader(const ordered_json& json, std::string path) : json_(json), path_(std::move(path)) {}

  double number(const char* name) const
  {
    const auto field = json_.find(name);
    if (field == json_.end() || !field->is_number()) fail(name, "a number is wanted");
    const double value = field->get<double>();
    if (!std::isfinite(value)) fail(name, "a finite number is wanted");
    return value;
  }
  template <class Matrix>
  void list(const char* name, Matrix& matrix) const
  {
    const auto field = json_.find(name);
    if (field == json_.end() || !field->is_array() || static_cast<Eigen::Index>(field->size()) != matrix.size()) {
      fail(name, fmt::format("a list of {} numbers is wanted", matrix.size()).c_str());
    }
    for (Eigen::Index i = 0; i < matrix.size(); ++i) {
      const ordered_json& entry = (*field)[static_cast<std::size_t>(i)];
      if (!entry.is_number() || !std::isfinite(entry.get<double>())) fail(name, "finite numbers are wanted");
      matrix(i / matrix.cols(), i % matrix.cols()) = entry.get<double>();
    }
  }
  [[noreturn]] void fail(const char* name, const char* wanted) const
  {
    throw FileError(fmt::format("{}: {}: {}", path_, name, wanted));
  }

 private:
  const ordered_json& json_;
  std::string path_;
};

}  // namespace

messaging::PublishedRegistration readRegistration(const std::string& path)
{
  const std::vector<std::uint8_t> bytes = files::readWholeFile(path);
  const ordered_json json = ordered_json::parse(bytes.begin(), bytes.end(), nullptr, false);
  if (!json.is_object()) throw FileError(path + ": no registration; what eyeslam-servo wrote is wanted");
  const Reader reader(json, path);
  if (reader.number("version") != kVersion) reader.fail("version", "1 is wanted");
  messaging::PublishedRegistration registration;
  registration.valid = true;
  registration.samples = static_cast<std::int64_t>(reader.number("samples"));
  reader.list("image_T_manipulator", registration.image_T_manipulator);
  reader.list("row_covariance", registration.row_covariance);
  registration.residual_px = reader.number("residual_px");
  registration.condition = reader.number("condition");
  registration.um_per_px = reader.number("um_per_px");
  registration.plane.known = true;
  reader.list("plane_normal", registration.plane.normal);
  registration.plane.offset = reader.number("plane_offset_m");
  registration.plane.residual = reader.number("plane_residual_m");
  if (registration.samples < 4) reader.fail("samples", "4 or more are wanted");
  if (!(registration.um_per_px > 0.0)) reader.fail("um_per_px", "a positive number is wanted");
  if (std::abs(registration.plane.normal.norm() - 1.0) > 1e-6) reader.fail("plane_normal", "a unit vector is wanted");
  return registration;
}

void writeRegistration(const messaging::PublishedRegistration& registration, const std::string& path)
{
  ordered_json json;
  json["version"] = kVersion;
  json["samples"] = registration.samples;
  json["image_T_manipulator"] = listOf(registration.image_T_manipulator);
  json["row_covariance"] = listOf(registration.row_covariance);
  json["residual_px"] = registration.residual_px;
  json["condition"] = registration.condition;
  json["um_per_px"] = registration.um_per_px;
  json["plane_normal"] = listOf(registration.plane.normal);
  json["plane_offset_m"] = registration.plane.offset;
  json["plane_residual_m"] = registration.plane.residual;
  files::PartialFile file(path);
  files::writeWholeFile(file.partialPath(), json.dump(1) + "\n");
  file.publish();
}

}  // namespace eyeslam::apps
