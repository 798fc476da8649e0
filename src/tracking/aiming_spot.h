// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <opencv2/core.hpp>
#include <optional>

#include "eyeslam/retina/options.h"
#include "eyeslam/tracking/track_result.h"

namespace eyeslam::tracking {

struct AimingSpotOptions {
  double least_rise = 22.0;
  double most_white = 0.6;
  double least_explained = 0.5;
  double reach = 0.22;
  double sigma_px = 6.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("least_rise", self.least_rise, Range{4.0, 255.0}, "of 255",
                  "by which the spot is redder than the retina around it; source: rendered sequences (100)");
    visitor.field("most_white", self.most_white, Range{0.1, 1.0}, "of the rise of red",
                  "with more green and blue it is a bloom or a burn; source: rendered spots 0.28, white light 1");
    visitor.field("least_explained", self.least_explained, Range{0.0, 1.0}, "of the variance around it",
                  "with less the fitted spot is chance; source: rendered sequences without a beam");
    visitor.field("reach", self.reach, Range{0.01, 1.0}, "of the picture's width",
                  "how far ahead of the tip the beam may land; source: 1 mm above the retina at 35 deg is 0.15");
    visitor.field("sigma_px", self.sigma_px, Range{1.0, 50.0}, "px of a view 800 px wide",
                  "size of the spot, from a third to twice of it; source: rendered sequences");
  }
};

/// Finds the red spot of the aiming beam. The beam leaves the instrument along its shaft, so the spot lies ahead of the
/// tip on the shaft's line: the reddest place there is where a round spot is fitted, on the retina alone, for the
/// instrument may hide a half of it. No memory of earlier frames; colour pictures only.
class AimingSpotFinder {
 public:
  explicit AimingSpotFinder(const AimingSpotOptions& options = {});

  /// @param image  8 or 16 bit, whole
  /// @param white  its brightest grey level
  /// @param tip    of the instrument in the same picture, full px
  /// @return the spot in full px, valid until the next call; `present == false` without a tip, without a spot, while a
  ///         pulse outshines it, and where the place is doubtful
  /// 40 us on a busy computer, 15 us without a spot. Never throws or allocates.
  const AimingSpot& update(const cv::Mat& image, double white, const ToolTip& tip);
  /// How far its light reaches, full px; 0 without a spot.
  double reach() const { return spot_.present ? reach_ : 0.0; }

 private:
  /// Light of a round spot on a tilted plane.
  struct Spot {
    static constexpr int kNumbers = 7;
    double rise = 0.0;  // of red, of 255
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    double sigma = 1.0;
    Eigen::Vector3d plane = Eigen::Vector3d::Zero();  // level, slopes per px about `start`
  };
  struct Sample {
    float x, y, red, pale;  // pale = mean of green and blue
  };
  using Numbers = Eigen::Matrix<double, Spot::kNumbers, 1>;
  using Matrix = Eigen::Matrix<double, Spot::kNumbers, Spot::kNumbers>;
  struct Equations {
    Matrix normal = Matrix::Zero();
    Numbers gradient = Numbers::Zero();
    double squares = 0.0;
  };

  std::optional<Eigen::Vector2d> reddestPlaceAhead(const cv::Mat& image, const ToolTip& tip) const;
  void gather(const cv::Mat& image, const ToolTip& tip, const Eigen::Vector2d& place);
  Equations equationsAt(const Spot& spot, const Eigen::Vector2d& place) const;
  std::optional<Spot> fit(const Eigen::Vector2d& place) const;
  double meanRed() const;
  bool isCertain(const Spot& spot, const Eigen::Vector2d& place, double squares) const;
  void report(const Spot& spot, const Equations& equations);

  AimingSpotOptions options_;
  float gain_ = 1.0F;  // of a grey level, to 255
  double unit_ = 1.0;  // px of this picture per px of a view 800 px wide
  std::array<Sample, 225> samples_{};
  std::size_t count_ = 0;
  AimingSpot spot_;
  double reach_ = 0.0;
};

}  // namespace eyeslam::tracking
