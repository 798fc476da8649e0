// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/thinning.h"

#include <array>
#include <cstddef>
#include <vector>

namespace eyeslam::files {
namespace {

// The eight neighbours, clockwise from the one above: P2 to P9 of the paper.
constexpr std::array<int, 8> kColumn = {0, 1, 1, 1, 0, -1, -1, -1};
constexpr std::array<int, 8> kRow = {-1, -1, 0, 1, 1, 1, 0, -1};

/// For each of the 256 neighbourhoods: whether the first (second) pass of a round removes the px.
struct Rules {
  std::array<bool, 256> first{}, second{};

  Rules()
  {
    for (unsigned code = 0; code < 256; ++code) {
      const auto p = [code](unsigned i) { return (code >> (i % 8)) & 1U; };
      unsigned count = 0, starts = 0;
      for (unsigned i = 0; i < 8; ++i) {
        count += p(i);
        starts += !p(i) && p(i + 1) ? 1U : 0U;
      }
      const bool edge = count >= 2 && count <= 6 && starts == 1;
      first[code] = edge && !(p(0) && p(2) && p(4)) && !(p(2) && p(4) && p(6));
      second[code] = edge && !(p(0) && p(2) && p(6)) && !(p(0) && p(4) && p(6));
    }
  }
};

unsigned neighbours(const cv::Mat_<std::uint8_t>& picture, cv::Point at)
{
  unsigned code = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    if (picture(at.y + kRow[i], at.x + kColumn[i])) code |= 1U << i;
  }
  return code;
}

// All decisions of a pass are made before the first px goes: the order of the px must not matter.
bool removeOnce(cv::Mat_<std::uint8_t>& picture, std::vector<cv::Point>& alive, const std::array<bool, 256>& rule)
{
  std::vector<cv::Point> kept, removed;
  for (const cv::Point at : alive) (rule[neighbours(picture, at)] ? removed : kept).push_back(at);
  for (const cv::Point at : removed) picture(at) = 0;
  alive.swap(kept);
  return !removed.empty();
}

// Of a staircase only the diagonal steps are needed: a corner between two neighbours that touch each other goes.
void removeCorners(cv::Mat_<std::uint8_t>& picture, const std::vector<cv::Point>& alive)
{
  for (const cv::Point at : alive) {
    const unsigned code = neighbours(picture, at);
    const auto p = [code](unsigned i) { return (code >> (i % 8)) & 1U; };
    for (unsigned i = 0; i < 8; i += 2) {
      if (p(i) && p(i + 2) && !p(i + 4) && !p(i + 5) && !p(i + 6)) picture(at) = 0;
    }
  }
}

}  // namespace

cv::Mat_<std::uint8_t> thinned(const cv::Mat_<std::uint8_t>& regions)
{
  static const Rules rules;
  cv::Mat_<std::uint8_t> padded(regions.rows + 2, regions.cols + 2, std::uint8_t{0});
  std::vector<cv::Point> alive;
  for (int row = 0; row < regions.rows; ++row) {
    for (int column = 0; column < regions.cols; ++column) {
      if (!regions(row, column)) continue;
      padded(row + 1, column + 1) = 255;
      alive.emplace_back(column + 1, row + 1);
    }
  }
  for (bool changed = true; changed;) {
    changed = removeOnce(padded, alive, rules.first);
    changed = removeOnce(padded, alive, rules.second) || changed;
  }
  removeCorners(padded, alive);
  return padded(cv::Rect(1, 1, regions.cols, regions.rows)).clone();
}

}  // namespace eyeslam::files
