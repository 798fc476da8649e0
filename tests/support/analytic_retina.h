// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <cstdint>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "eyeslam/retina/pose2.h"
#include "eyeslam/tracking/alignment_template.h"
#include "eyeslam/tracking/masked_contrast.h"
#include "eyeslam/tracking/mosaic.h"

namespace eyeslam::support {

/// Contrast and mask of one view, as alignment wants them.
struct AnalyticView {
  cv::Mat_<std::int16_t> contrast;
  cv::Mat_<std::uint8_t> hidden;

  tracking::MaskedContrast picture() const { return {contrast, hidden}; }
  /// Marks cells of 4 px as covered by the instrument.
  void hide(const cv::Rect& cells) { hidden(cells).setTo(tracking::OcclusionMask::kBright); }
  /// White noise, as a fraction of the background.
  void addNoise(double sigma, unsigned seed)
  {
    std::mt19937 random(seed);
    std::normal_distribution<double> unit(0.0, 1.0);  // scaled, because a deviation of 0 is not allowed
    const auto grain = [&](std::mt19937& engine) { return sigma * tracking::Frame::kContrastUnit * unit(engine); };
    for (std::int16_t& value : contrast) value = static_cast<std::int16_t>(std::lround(value + grain(random)));
  }
};

/// A retina by a formula: a sum of plane waves. What a view at any pose shows follows without interpolation, and what a
/// moving view shows follows as well: a wave that is averaged along a motion is the wave times a sinc.
class AnalyticRetina {
 public:
  /// @param shortest_px, longest_px  wave lengths; @param rms  of the contrast, as a fraction of the background
  explicit AnalyticRetina(unsigned seed, double shortest_px = 12.0, double longest_px = 60.0, double rms = 0.06)
  {
    constexpr int kWaves = 24;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (int i = 0; i < kWaves; ++i) {
      const double length = shortest_px * std::pow(longest_px / shortest_px, share(random));
      const double angle = M_PI * (i + share(random)) / kWaves;  // spread, so that every direction is fixed
      const double k = 2.0 * M_PI / length;
      waves_.push_back(
          {{k * std::cos(angle), k * std::sin(angle)}, 2.0 * M_PI * share(random), rms * std::sqrt(2.0 / kWaves)});
    }
  }

  /// Contrast as a fraction of the background, at a point given in centred map px.
  double at(const Eigen::Vector2d& map) const
  {
    double sum = 0.0;
    for (const Wave& wave : waves_) sum += wave.amplitude * std::sin(wave.vector.dot(map) + wave.phase);
    return sum;
  }

  AnalyticView view(const retina::Pose2& map_T_frame, const cv::Size& size) const
  {
    return smeared(map_T_frame, size, Eigen::Vector2d::Zero());
  }

  /// The mean of all views whose poses lie within +-extent / 2 (map px) of this one.
  AnalyticView smeared(const retina::Pose2& map_T_frame, const cv::Size& size, const Eigen::Vector2d& extent) const
  {
    const Eigen::Vector2d right = map_T_frame.linear().col(0);
    const Eigen::Vector2d centre((size.width - 1) / 2.0, (size.height - 1) / 2.0);
    AnalyticView view{cv::Mat_<std::int16_t>(size), visibleCells(size)};
    std::vector<double> row(static_cast<std::size_t>(size.width));
    for (int y = 0; y < size.height; ++y) {
      std::fill(row.begin(), row.end(), 0.0);
      const Eigen::Vector2d begin = map_T_frame * Eigen::Vector2d(-centre.x(), y - centre.y());
      for (const Wave& wave : waves_) {
        const double half = 0.5 * wave.vector.dot(extent);
        const double damping = std::abs(half) > 1e-9 ? std::sin(half) / half : 1.0;
        // From pixel to pixel the phase turns by a constant angle.
        // Not by std::polar alone: a damping may be negative.
        auto turning = wave.amplitude * damping * std::polar(1.0, wave.vector.dot(begin) + wave.phase);
        const auto turn = std::polar(1.0, wave.vector.dot(right));
        for (double& value : row) {
          value += turning.imag();
          turning = {turning.real() * turn.real() - turning.imag() * turn.imag(),
                     turning.real() * turn.imag() + turning.imag() * turn.real()};
        }
      }
      for (int x = 0; x < size.width; ++x) view.contrast(y, x) = units(row[static_cast<std::size_t>(x)]);
    }
    return view;
  }

 private:
  struct Wave {
    Eigen::Vector2d vector;  // rad per px
    double phase, amplitude;
  };

  static std::int16_t units(double contrast)
  {
    return static_cast<std::int16_t>(std::lround(contrast * tracking::Frame::kContrastUnit));
  }
  static cv::Mat_<std::uint8_t> visibleCells(const cv::Size& size)
  {
    constexpr int kCell = tracking::Frame::kCell;
    return cv::Mat_<std::uint8_t>((size.height + kCell - 1) / kCell, (size.width + kCell - 1) / kCell, std::uint8_t{0});
  }

  std::vector<Wave> waves_;
};

/// A retina and the mosaic of one view at the identity.
struct MappedRetina {
  MappedRetina(const AnalyticRetina& seen, const cv::Size& size) : retina(seen)
  {
    mosaic.start(retina.view({}, size).picture());
  }

  tracking::AlignmentTemplate pixelsIn(const AnalyticView& view, const retina::Pose2& map_T_frame) const
  {
    tracking::AlignmentTemplate pixels;
    tracking::collectTemplate(mosaic, view.picture(), map_T_frame, pixels);
    return pixels;
  }

  AnalyticRetina retina;
  tracking::Mosaic mosaic;
};

/// Distance between the places that two poses give the image centre; map px.
inline double distance(const retina::Pose2& a, const retina::Pose2& b)
{
  return (a.translation() - b.translation()).norm();
}

}  // namespace eyeslam::support
