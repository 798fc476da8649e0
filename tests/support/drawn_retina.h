// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "eyeslam/tracking/frame.h"
#include "eyeslam/tracking/occlusion_mask.h"

namespace eyeslam::support {

/// A centreline in frame px (half of the picture's), one point every half px.
using Centreline = std::vector<Eigen::Vector2d>;

/// An arc of `length_px` whose middle lies at `middle`, running at `angle` there; curvature in 1 / px, 0 = straight.
inline Centreline arc(const Eigen::Vector2d& middle, double angle, double curvature, double length_px)
{
  const auto walk = [&](double sign) {
    Centreline points;
    Eigen::Vector2d at = middle;
    for (double s = 0.25; s < length_px / 2; s += 0.5) {
      const double direction = angle + sign * s * curvature;
      at += sign * 0.5 * Eigen::Vector2d(std::cos(direction), std::sin(direction));
      points.push_back(at);
    }
    return points;
  };
  Centreline line = walk(-1.0);
  std::reverse(line.begin(), line.end());
  line.push_back(middle);
  const Centreline onwards = walk(1.0);
  line.insert(line.end(), onwards.begin(), onwards.end());
  return line;
}

/// A picture in the colours of a retina on which things are drawn at exact places. Coordinates are frame px.
class DrawnRetina {
 public:
  DrawnRetina(int width, int height) : picture_(2 * height, 2 * width, cv::Vec3f(30.0F, 80.0F, 180.0F)) {}

  /// Darkens by `depth` of the brightness inside, with edges one full px wide.
  void vessel(const Centreline& line, double width_px, double depth)
  {
    cv::Mat_<float> nearest(picture_.size(), 1e6F);
    const double reach = 2.0 * width_px / 2.0 + 2.0;
    for (const Eigen::Vector2d& point : line) {
      const Eigen::Vector2d at = 2.0 * point + Eigen::Vector2d(0.5, 0.5);
      paint(at, reach, [&](int x, int y, double distance) {
        nearest(y, x) = std::min(nearest(y, x), static_cast<float>(distance));
      });
    }
    for (int y = 0; y < picture_.rows; ++y) {
      for (int x = 0; x < picture_.cols; ++x) {
        const double inside = std::clamp(width_px - nearest(y, x) + 0.5, 0.0, 1.0);
        picture_(y, x) *= static_cast<float>(1.0 - depth * inside);
      }
    }
  }

  /// A white disc with a halo.
  void bloom(const Eigen::Vector2d& middle, double radius_px)
  {
    paint(2.0 * middle, 6.0 * radius_px, [&](int x, int y, double distance) {
      const double light = std::exp(-0.5 * std::pow(std::max(0.0, distance / radius_px - 1.5), 2.0));
      picture_(y, x) += static_cast<float>(light) * (cv::Vec3f(255.0F, 255.0F, 255.0F) - picture_(y, x));
    });
  }

  /// A grey shaft from `tip` to the border, with a shadow beside it.
  void shaft(const Eigen::Vector2d& tip, double angle, double width_px)
  {
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    for (int y = 0; y < picture_.rows; ++y) {
      for (int x = 0; x < picture_.cols; ++x) {
        const Eigen::Vector2d from_tip = Eigen::Vector2d(x, y) - 2.0 * tip;
        const double across = along.x() * from_tip.y() - along.y() * from_tip.x();
        if (from_tip.dot(along) < 0.0) continue;
        const double grey = 140.0 + 60.0 * std::cos(across / width_px * 2.0);
        if (std::abs(across) < width_px)
          picture_(y, x) = cv::Vec3f::all(static_cast<float>(grey));
        else if (across > 0.0 && across < 1.6 * width_px)
          picture_(y, x) *= 0.75F;
      }
    }
  }

  /// Darkness outside a circle.
  void rim(const Eigen::Vector2d& middle, double radius_px)
  {
    for (int y = 0; y < picture_.rows; ++y) {
      for (int x = 0; x < picture_.cols; ++x) {
        const double outside = (Eigen::Vector2d(x, y) - 2.0 * middle).norm() - 2.0 * radius_px;
        picture_(y, x) *= static_cast<float>(1.0 / (1.0 + std::exp(outside / 6.0)));
      }
    }
  }

  /// Gaussian noise, grey levels, and rounding: the picture as a camera gives it.
  cv::Mat photograph(double noise, unsigned seed) const
  {
    std::mt19937 random(seed);
    std::normal_distribution<float> grain(0.0F, 1.0F);
    cv::Mat_<cv::Vec3b> photo(picture_.size());
    for (int y = 0; y < photo.rows; ++y) {
      for (int x = 0; x < photo.cols; ++x) {
        for (int c = 0; c < 3; ++c)
          photo(y, x)[c] =
              cv::saturate_cast<std::uint8_t>(picture_(y, x)[c] + static_cast<float>(noise) * grain(random));
      }
    }
    return photo;
  }

 private:
  template <class Paint>
  void paint(const Eigen::Vector2d& at, double reach, Paint&& put)
  {
    for (int y = std::max(0, static_cast<int>(at.y() - reach)); y < std::min(picture_.rows - 0.0, at.y() + reach); ++y)
      for (int x = std::max(0, static_cast<int>(at.x() - reach)); x < std::min(picture_.cols - 0.0, at.x() + reach);
           ++x)
        put(x, y, (Eigen::Vector2d(x, y) - at).norm());
  }

  cv::Mat_<cv::Vec3f> picture_;
};

/// A frame and its mask, made ready as the tracker does.
struct PreparedFrame {
  explicit PreparedFrame(const cv::Mat& photo)
  {
    frame.assign(photo);
    mask.update(frame);
    frame.normalise(mask);
  }

  tracking::Frame frame;
  tracking::OcclusionMask mask;
};

/// Distance to the nearest point of a centreline; frame px.
inline double distanceTo(const Centreline& line, double x, double y)
{
  double nearest = 1e9;
  for (const Eigen::Vector2d& point : line) nearest = std::min(nearest, (point - Eigen::Vector2d(x, y)).norm());
  return nearest;
}

}  // namespace eyeslam::support
