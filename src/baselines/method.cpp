// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/baselines/method.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <stdexcept>
#include <utility>

#include "eyeslam/baselines/eyeslam_method.h"
#include "eyeslam/baselines/feature_method.h"
#include "eyeslam/baselines/klt_method.h"
#include "eyeslam/baselines/paper_method.h"

namespace eyeslam::baselines {
namespace {

using tracking::TrackerOptions;
using Maker = std::function<std::unique_ptr<Method>(const TrackerOptions&)>;

// A new rival is a line here. The order is that of `--help`; the first is the default.
const std::vector<std::pair<std::string, Maker>>& makers()
{
  static const std::vector<std::pair<std::string, Maker>> kMakers = {
      {"eyeslam", [](const TrackerOptions& options) { return std::make_unique<EyeSlamMethod>(options); }},
      {"paper", [](const TrackerOptions& options) { return std::make_unique<PaperMethod>(options); }},
      {"sift",
       [](const TrackerOptions& options) {
         return std::make_unique<FeatureMethod>(options, cv::SIFT::create(800, 3, 0.01), cv::NORM_L2);
       }},
      {"orb",
       [](const TrackerOptions& options) {
         return std::make_unique<FeatureMethod>(
             options, cv::ORB::create(1500, 1.2F, 4, 15, 0, 2, cv::ORB::HARRIS_SCORE, 31, 5), cv::NORM_HAMMING);
       }},
      {"klt", [](const TrackerOptions& options) { return std::make_unique<KltMethod>(options); }},
  };
  return kMakers;
}

}  // namespace

std::vector<std::string> methodNames()
{
  std::vector<std::string> names;
  for (const auto& [name, make] : makers()) names.push_back(name);
  return names;
}

std::unique_ptr<Method> makeMethod(const std::string& name, const TrackerOptions& options)
{
  for (const auto& [known, make] : makers()) {
    if (known == name) return make(options);
  }
  throw std::invalid_argument(fmt::format("method '{}' is unknown; one of: {}", name, fmt::join(methodNames(), ", ")));
}

}  // namespace eyeslam::baselines
