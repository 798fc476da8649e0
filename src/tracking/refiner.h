// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "eyeslam/retina/options.h"
#include "eyeslam/retina/pose2.h"
#include "eyeslam/tracking/alignment_template.h"
#include "eyeslam/tracking/cubic_sampler.h"

namespace eyeslam::tracking {

struct RefinerOptions {
  int coarse_stride = 4;
  int coarse_steps = 3;
  double coarse_step_px = 0.1;
  int most_steps = 8;
  double last_step_px = 0.02;
  double settled_px = 0.2;
  double cut_sigmas = 3.0;
  double first_cut_sigmas = 6.0;
  double ncc_sigmas = 4.0;
  double least_sigma = 0.002;
  int least_pixels = 60;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("coarse_stride", self.coarse_stride, Range{1, 32}, "pixels",
                  "the first steps use every so manieth; source: tracker study 2.9");
    visitor.field("coarse_steps", self.coarse_steps, Range{0, 32}, "steps", "on those; source: tracker study 2.9");
    visitor.field("coarse_step_px", self.coarse_step_px, Range{0.0, 10.0}, "px",
                  "a smaller step ends the coarse ones; source: tracker study 2.9");
    visitor.field("most_steps", self.most_steps, Range{1, 64}, "steps", "in all; source: tracker study 2.9");
    visitor.field("last_step_px", self.last_step_px, Range{1e-6, 1.0}, "px",
                  "a smaller step is the last; source: the next one is a tenth of it");
    visitor.field("settled_px", self.settled_px, Range{1e-6, 10.0}, "px",
                  "a larger last step means that the start was too far off; source: jerks of the rendered sequences");
    visitor.field("cut_sigmas", self.cut_sigmas, Range{1.0, 100.0}, "robust sigmas",
                  "Tukey weights reach zero here; source: tracker study 2.9 (2 or 4 within 7 %)");
    visitor.field("first_cut_sigmas", self.first_cut_sigmas, Range{1.0, 100.0}, "robust sigmas",
                  "the same in the first step; source: tracker study 2.9");
    visitor.field("ncc_sigmas", self.ncc_sigmas, Range{1.0, 1000.0}, "robust sigmas",
                  "pixels farther off do not count in the correlation; source: saccades of the rendered sequences");
    visitor.field("least_sigma", self.least_sigma, Range{1e-6, 1.0}, "of the background",
                  "robust deviation is never taken smaller; source: tracker study 2.9");
    visitor.field("least_pixels", self.least_pixels, Range{8, 100000}, "pixels",
                  "fewer give no refinement; source: our choice, a view has some 3000");
  }
};

/// Which numbers of the pose are free: x, y, theta; or the scale as well.
enum class Freedom { rigid, similarity };

struct Refinement {
  bool valid = false;    ///< false: too few pixels, or the pixels do not fix the pose
  bool settled = false;  ///< the last step was small; false: the start was too far off
  retina::Pose2 map_T_frame;
  double ncc = 0.0;    ///< normalised correlation of frame and template
  double sigma = 0.0;  ///< robust deviation of frame and template, contrast units
  int pixels = 0;
  Eigen::Matrix4d covariance =
      Eigen::Matrix4d::Zero();  ///< of (x, y, theta, scale); px, rad; robust to alike neighbours
};

/// Aligns a frame to a template below a pixel: Gauss-Newton on the difference of contrast with Tukey weights (tracker
/// study, 2.9). The gradient is the template's, so it is taken once.
class Refiner {
 public:
  explicit Refiner(const RefinerOptions& options = {});

  /// @param contrast  the frame's contrast plane
  /// @param start     where to begin; within about 4 px of the truth
  /// @param scale_sigma  prior deviation of the scale from start's; of use with Freedom::similarity only
  /// Never throws; allocates only when the template is larger than any before.
  Refinement refine(const cv::Mat_<std::int16_t>& contrast, const AlignmentTemplate& pixels, const retina::Pose2& start,
                    Freedom freedom, double scale_sigma = 1.0);

 private:
  struct NormalEquations {
    Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
    Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
  };

  void computeResiduals(const CubicSampler& sample, const cv::Size& size, const AlignmentTemplate& pixels,
                        const retina::Pose2& pose, std::size_t stride);
  double robustSigma() const;
  NormalEquations accumulate(std::size_t begin, std::size_t end, double cut, Freedom freedom) const;
  template <int kFreedoms>
  NormalEquations accumulateColumns(std::size_t begin, std::size_t end, double cut) const;
  static std::optional<Eigen::Vector4d> solve(NormalEquations normal, Freedom freedom, double scale_weight,
                                              double scale_offset);
  void judge(const AlignmentTemplate& pixels, Freedom freedom, Refinement& result);
  double correlation(double cut) const;
  Eigen::Matrix4d covarianceOf(const AlignmentTemplate& pixels, const NormalEquations& all, double cut,
                               Freedom freedom) const;

  RefinerOptions options_;
  // Of the pixels used: residual (frame - template), template value, and the Jacobian's columns.
  std::vector<float> residual_, value_, jx_, jy_, jt_, js_;
  mutable std::array<int, 1024> histogram_{};
};

}  // namespace eyeslam::tracking
