// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/pixel_size.h"

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/whole_file.h"

namespace eyeslam::files {
namespace {

namespace fs = std::filesystem;

const char* const kKey = "um_per_px";

double checkedValue(const nlohmann::json& meta, const std::string& path)
{
  const auto& value = meta.at(kKey);
  if (!value.is_number() || !std::isfinite(value.get<double>()) || value.get<double>() <= 0.0) {
    throw FileError(path + ": um_per_px is no positive number; correct it or give --um-per-px");
  }
  return value.get<double>();
}

PixelSize readMeta(const std::string& path)
{
  const auto bytes = readWholeFile(path);
  const auto meta = nlohmann::json::parse(bytes.begin(), bytes.end(), nullptr, false);
  if (meta.is_discarded()) throw FileError(path + ": is no JSON; correct it or give --um-per-px");
  if (!meta.is_object() || !meta.contains(kKey) || meta.at(kKey).is_null()) return {std::nullopt, "unknown"};
  return {checkedValue(meta, path), path};
}

}  // namespace

PixelSize pixelSizeOf(const std::string& input, std::optional<double> given_um_per_px)
{
  if (given_um_per_px) return {given_um_per_px, "--um-per-px"};
  for (const char* live : {"camera:", "shm:"}) {
    if (input.rfind(live, 0) == 0) return {std::nullopt, "unknown"};  // nothing lies beside them
  }
  std::error_code error;
  const fs::path folder = fs::is_directory(input, error) ? fs::path(input) : fs::path(input).parent_path();
  const fs::path meta = folder / "meta.json";
  if (!fs::is_regular_file(meta, error)) return {std::nullopt, "unknown"};
  return readMeta(meta.string());
}

}  // namespace eyeslam::files
