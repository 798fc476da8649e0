// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/refiner.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "eyeslam/retina/vector_kernel.h"

namespace eyeslam::tracking {

namespace {

constexpr std::size_t kLanes = 8;
constexpr double kSmallestScale = 0.2, kLargestScale = 5.0;
constexpr float kOutside = 1e6F;  // residual of a pixel that left the frame: beyond every cut

// Weighted sums over lanes; an associative order of our own, since the compiler may not choose one for floats.
// Sums: the upper triangle of J'WJ row by row, then J'Wr.
template <int kFreedoms>
[[gnu::always_inline]] inline void accumulateLanes(const float* r, const float* const (&j)[kFreedoms],
                                                   std::size_t blocks, float inverse_cut, float* sums)
{
  for (std::size_t at = 0; at < blocks * kLanes; at += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const float ratio = r[at + k] * inverse_cut;
      const float inside = std::max(0.0F, 1.0F - ratio * ratio);
      const float w = inside * inside;
      float* sum = sums + k;
      for (int a = 0; a < kFreedoms; ++a) {
        const float weighted = w * j[a][at + k];
        for (int b = a; b < kFreedoms; ++b, sum += kLanes) *sum += weighted * j[b][at + k];
      }
      for (int a = 0; a < kFreedoms; ++a, sum += kLanes) *sum += w * j[a][at + k] * r[at + k];
    }
  }
}

EYESLAM_VECTOR_KERNEL void accumulateRigid(const float* r, const float* const (&j)[3], std::size_t blocks,
                                           float inverse_cut, float* sums)
{
  accumulateLanes<3>(r, j, blocks, inverse_cut, sums);
}

EYESLAM_VECTOR_KERNEL void accumulateSimilarity(const float* r, const float* const (&j)[4], std::size_t blocks,
                                                float inverse_cut, float* sums)
{
  accumulateLanes<4>(r, j, blocks, inverse_cut, sums);
}

// Distance that a step moves the pixels at a typical radius.
double length(const Eigen::Vector4d& step, double radius)
{
  return std::max(step.head<2>().norm(), radius * std::hypot(step[2], step[3]));
}

}  // namespace

Refiner::Refiner(const RefinerOptions& options) : options_(options) {}

void Refiner::computeResiduals(const CubicSampler& sample, const cv::Size& size, const AlignmentTemplate& pixels,
                               const retina::Pose2& pose, std::size_t stride)
{
  const std::size_t used = (pixels.size() + stride - 1) / stride;
  const std::size_t padded = (used + kLanes - 1) / kLanes * kLanes;
  for (auto* field : {&residual_, &value_, &jx_, &jy_, &jt_, &js_}) field->resize(padded);
  const Eigen::Matrix2f linear = pose.inverse().linear().cast<float>();
  const auto tx = static_cast<float>(pose.x), ty = static_cast<float>(pose.y);
  const float cx = static_cast<float>(size.width - 1) / 2.0F, cy = static_cast<float>(size.height - 1) / 2.0F;
  constexpr float kMargin = CubicSampler::kMargin;
  const float right = static_cast<float>(size.width - 1) - kMargin - 0.01F;
  const float bottom = static_cast<float>(size.height - 1) - kMargin - 0.01F;
  const auto inverse_scale = static_cast<float>(1.0 / pose.scale);
  for (std::size_t i = 0; i < used; ++i) {
    const std::size_t at = i * stride;
    const float ux = pixels.x[at] - tx, uy = pixels.y[at] - ty;
    const float px = linear(0, 0) * ux + linear(0, 1) * uy + cx;
    const float py = linear(1, 0) * ux + linear(1, 1) * uy + cy;
    const bool inside = px >= kMargin && py >= kMargin && px <= right && py <= bottom;
    const float gx = pixels.gx[at], gy = pixels.gy[at];
    value_[i] = pixels.value[at];
    residual_[i] = inside ? sample(px, py) - value_[i] : kOutside;
    jx_[i] = -gx;
    jy_[i] = -gy;
    jt_[i] = -(gy * ux - gx * uy);
    js_[i] = -(gx * ux + gy * uy) * inverse_scale;
  }
  for (std::size_t i = used; i < padded; ++i) {
    residual_[i] = kOutside;
    value_[i] = jx_[i] = jy_[i] = jt_[i] = js_[i] = 0.0F;
  }
}

double Refiner::robustSigma() const
{
  // The median from a histogram of bins of two contrast units.
  constexpr float kBin = 2.0F;
  histogram_.fill(0);
  int total = 0;
  for (const float r : residual_) {
    if (r >= kOutside) continue;
    ++histogram_[std::min(histogram_.size() - 1, static_cast<std::size_t>(std::abs(r) / kBin))];
    ++total;
  }
  double median = 0.0;
  for (int below = 0, bin = 0; 2 * below < total; ++bin) {
    const int here = histogram_[static_cast<std::size_t>(bin)];
    if (2 * (below + here) >= total) median = kBin * (bin + (0.5 * total - below) / here);
    below += here;
  }
  constexpr double kNormal = 1.4826;  // median absolute deviation of a unit normal
  return std::max(kNormal * median, options_.least_sigma * Frame::kContrastUnit);
}

template <int kFreedoms>
Refiner::NormalEquations Refiner::accumulateColumns(std::size_t begin, std::size_t end, double cut) const
{
  constexpr std::size_t kSums = kFreedoms * (kFreedoms + 1) / 2 + kFreedoms;
  const std::array<const std::vector<float>*, 4> fields{&jx_, &jy_, &jt_, &js_};
  const float* columns[kFreedoms];
  for (std::size_t a = 0; a < kFreedoms; ++a) columns[a] = fields[a]->data() + begin;
  // Whole blocks of lanes, then the rest one by one, so that clusters of any length can be summed.
  std::array<float, kSums * kLanes> sums{};
  const std::size_t blocks = (end - begin) / kLanes;
  const auto inverse_cut = static_cast<float>(1.0 / cut);
  if constexpr (kFreedoms == 3)
    accumulateRigid(residual_.data() + begin, columns, blocks, inverse_cut, sums.data());
  else
    accumulateSimilarity(residual_.data() + begin, columns, blocks, inverse_cut, sums.data());
  std::array<double, kSums> total{};
  for (std::size_t s = 0; s < kSums; ++s) {
    for (std::size_t k = 0; k < kLanes; ++k) total[s] += static_cast<double>(sums[s * kLanes + k]);
  }
  for (std::size_t i = blocks * kLanes; i < end - begin; ++i) {
    const auto r = static_cast<double>(residual_[begin + i]);
    const double inside = std::max(0.0, 1.0 - r * r / (cut * cut));
    const auto weighted = [&](int a) { return inside * inside * static_cast<double>(columns[a][i]); };
    std::size_t s = 0;
    for (int a = 0; a < kFreedoms; ++a) {
      for (int b = a; b < kFreedoms; ++b) total[s++] += weighted(a) * static_cast<double>(columns[b][i]);
    }
    for (int a = 0; a < kFreedoms; ++a) total[s++] += weighted(a) * r;
  }
  NormalEquations result;
  std::size_t s = 0;
  for (int a = 0; a < kFreedoms; ++a) {
    for (int b = a; b < kFreedoms; ++b) result.information(a, b) = result.information(b, a) = total[s++];
  }
  for (int a = 0; a < kFreedoms; ++a) result.gradient[a] = total[s++];
  return result;
}

Refiner::NormalEquations Refiner::accumulate(std::size_t begin, std::size_t end, double cut, Freedom freedom) const
{
  return freedom == Freedom::rigid ? accumulateColumns<3>(begin, end, cut) : accumulateColumns<4>(begin, end, cut);
}

// Over the pixels that the robust deviation explains: streaks of blooms and the instrument would outvote the vessels.
double Refiner::correlation(double cut) const
{
  double n = 0.0, a = 0.0, b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
  for (std::size_t i = 0; i < residual_.size(); ++i) {
    if (std::abs(residual_[i]) >= cut) continue;
    const double u = value_[i];
    const double v = u + static_cast<double>(residual_[i]);
    n += 1.0;
    a += u;
    b += v;
    aa += u * u;
    bb += v * v;
    ab += u * v;
  }
  const double power = (n * aa - a * a) * (n * bb - b * b);
  return power > 0.0 ? (n * ab - a * b) / std::sqrt(power) : 0.0;
}

// The sandwich estimate: residuals of one cluster may be alike (compressed blocks, texture that moved), so each
// cluster counts as one observation; the usual (J'WJ)^-1 is 2 to 4 times too small (tracker study, 2.10).
Eigen::Matrix4d Refiner::covarianceOf(const AlignmentTemplate& pixels, const NormalEquations& all, double cut,
                                      Freedom freedom) const
{
  const int n = freedom == Freedom::rigid ? 3 : 4;
  Eigen::Matrix4d scatter = Eigen::Matrix4d::Zero();
  const std::size_t clusters = pixels.cluster_begins.size();
  for (std::size_t c = 0; c < clusters; ++c) {
    const Eigen::Vector4d g = accumulate(pixels.cluster_begins[c], pixels.clusterEnd(c), cut, freedom).gradient;
    scatter += g * g.transpose();
  }
  const double freedoms = std::max(1.0, static_cast<double>(clusters) - n);
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  const Eigen::MatrixXd::Index size = n;
  const Eigen::LDLT<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>> solver(
      all.information.topLeftCorner(size, size));
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4> inverse =
      solver.solve(Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>::Identity(size, size));
  covariance.topLeftCorner(size, size) =
      inverse * scatter.topLeftCorner(size, size) * inverse * (static_cast<double>(clusters) / freedoms);
  return covariance;
}

// One Gauss-Newton step from weighted sums; nothing when they do not fix the pose.
std::optional<Eigen::Vector4d> Refiner::solve(NormalEquations normal, Freedom freedom, double scale_weight,
                                              double scale_offset)
{
  if (freedom == Freedom::similarity) {
    normal.information(3, 3) += scale_weight;
    normal.gradient[3] += scale_weight * scale_offset;
  } else {
    normal.information(3, 3) = 1.0;  // nothing was summed for the scale: it stays
  }
  const Eigen::LDLT<Eigen::Matrix4d> solver(normal.information);
  const Eigen::Vector4d move = -solver.solve(normal.gradient);
  // Without information the solver answers zero and counts the matrix as positive: that would pass for a perfect fit.
  const bool fixed = solver.vectorD().minCoeff() > 0.0;
  if (solver.info() != Eigen::Success || !fixed || !move.allFinite()) return std::nullopt;
  return move;
}

Refinement Refiner::refine(const cv::Mat_<std::int16_t>& contrast, const AlignmentTemplate& pixels,
                           const retina::Pose2& start, Freedom freedom, double scale_sigma)
{
  Refinement result;
  result.map_T_frame = start;
  result.pixels = static_cast<int>(pixels.size());
  if (result.pixels < options_.least_pixels) return result;
  const CubicSampler sample(contrast);
  const double radius = 0.25 * (contrast.cols + contrast.rows);
  retina::Pose2& pose = result.map_T_frame;
  int coarse_left = options_.coarse_steps;
  double moved = 0.0;
  bool all_pixels = false;  // whether the residuals at hand are of every pixel
  for (int step = 0; step < options_.most_steps; ++step) {
    const bool coarse = coarse_left > 0;
    const int stride = coarse ? options_.coarse_stride : 1;
    all_pixels = stride == 1;
    computeResiduals(sample, contrast.size(), pixels, pose, static_cast<std::size_t>(stride));
    const double sigma = robustSigma();
    const double cut = (step == 0 ? options_.first_cut_sigmas : options_.cut_sigmas) * sigma;
    const double scale_weight = sigma * sigma / (scale_sigma * scale_sigma);
    const auto move =
        solve(accumulate(0, residual_.size(), cut, freedom), freedom, scale_weight, pose.scale - start.scale);
    if (!move) return result;
    pose = {pose.x + (*move)[0], pose.y + (*move)[1], pose.theta + (*move)[2], pose.scale + (*move)[3]};
    if (!(pose.scale > kSmallestScale && pose.scale < kLargestScale)) return result;
    moved = length(*move, radius);
    if (coarse) coarse_left = moved < options_.coarse_step_px ? 0 : coarse_left - 1;
    if (!coarse && moved < options_.last_step_px) break;
  }
  // After a small step the residuals at hand serve for what follows.
  if (!all_pixels || moved >= options_.last_step_px) computeResiduals(sample, contrast.size(), pixels, pose, 1);
  result.settled = moved < options_.settled_px;
  judge(pixels, freedom, result);
  return result;
}

void Refiner::judge(const AlignmentTemplate& pixels, Freedom freedom, Refinement& result)
{
  result.sigma = robustSigma();
  const double cut = options_.cut_sigmas * result.sigma;
  result.ncc = correlation(options_.ncc_sigmas * result.sigma);
  result.covariance = covarianceOf(pixels, accumulate(0, residual_.size(), cut, freedom), cut, freedom);
  result.valid = result.covariance.allFinite();
}

}  // namespace eyeslam::tracking
