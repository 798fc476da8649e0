// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/aiming_spot.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace eyeslam::tracking {
namespace {

using Eigen::Vector2d;

constexpr double kViewWidth_px = 800.0;  // of the view that lengths are given for
constexpr float kSaturated = 250.0F;     // redder cannot be told
constexpr float kPaleShare = 0.4F;       // paler than that share of the red is no retina
constexpr double kRingSigmas = 3.0;      // where the spot's light has ended
constexpr double kMostRise = 1000.0;     // a saturated spot's top is guessed from its flanks
constexpr double kLeastNoise = 2.0;      // grey levels
constexpr double kLeastSpotSigma_px = 0.25;
constexpr double kSettled_px = 0.03;  // a tenth of the error that is left

struct Colour {
  float red, pale;
};

template <class T>
Colour colourAt(const cv::Mat& image, int x, int y, float gain)
{
  const T* const pixel = image.ptr<T>(y) + 3 * x;
  return {gain * static_cast<float>(pixel[2]),
          0.5F * gain * (static_cast<float>(pixel[0]) + static_cast<float>(pixel[1]))};
}

// Outside the picture: black.
Colour colourAt(const cv::Mat& image, const Vector2d& at, float gain)
{
  const int x = static_cast<int>(std::lround(at.x())), y = static_cast<int>(std::lround(at.y()));
  if (x < 0 || y < 0 || x >= image.cols || y >= image.rows) return {0.0F, 0.0F};
  return image.depth() == CV_8U ? colourAt<std::uint8_t>(image, x, y, gain)
                                : colourAt<std::uint16_t>(image, x, y, gain);
}

bool isRetina(const Colour& colour) { return colour.red > 25.0F && colour.pale < kPaleShare * colour.red; }

Vector2d directionOf(const ToolTip& tip) { return {std::cos(tip.shaft_angle), std::sin(tip.shaft_angle)}; }

}  // namespace

AimingSpotFinder::AimingSpotFinder(const AimingSpotOptions& options) : options_(options) {}

const AimingSpot& AimingSpotFinder::update(const cv::Mat& image, double white, const ToolTip& tip)
{
  spot_ = {};
  if (!tip.present || image.channels() != 3) return spot_;
  gain_ = static_cast<float>(255.0 / white);
  unit_ = image.cols / kViewWidth_px;
  const std::optional<Vector2d> place = reddestPlaceAhead(image, tip);
  if (!place) return spot_;
  gather(image, tip, *place);
  const std::optional<Spot> found = fit(*place);
  if (!found) return spot_;
  const Equations equations = equationsAt(*found, *place);
  if (!isCertain(*found, *place, equations.squares)) return spot_;
  report(*found, equations);
  return spot_;
}

// Redder than both sides: one of them may lie in the instrument's shadow.
std::optional<Vector2d> AimingSpotFinder::reddestPlaceAhead(const cv::Mat& image, const ToolTip& tip) const
{
  const Vector2d ahead = directionOf(tip), aside(-ahead.y(), ahead.x());
  const Vector2d start(tip.x_px, tip.y_px);
  const double sigma = unit_ * options_.sigma_px;
  float reddest = static_cast<float>(0.5 * options_.least_rise);
  std::optional<Vector2d> best;
  for (double along = -sigma; along <= options_.reach * image.cols; along += sigma / 3.0) {
    const Vector2d at = start + along * ahead;
    float core = 0.0F;
    for (const double offset : {-0.5, 0.0, 0.5}) core += colourAt(image, at + offset * sigma * aside, gain_).red / 3.0F;
    const auto sideOf = [&](double sign) {
      const Vector2d side = at + sign * kRingSigmas * sigma * aside;
      return 0.5F * (colourAt(image, side - 0.5 * sigma * ahead, gain_).red +
                     colourAt(image, side + 0.5 * sigma * ahead, gain_).red);
    };
    const float rise = core - std::max(sideOf(-1.0), sideOf(1.0));
    if (rise <= reddest) continue;
    reddest = rise;
    best = at;
  }
  return best;
}

// What is retina around a place, and not where the instrument is known to be.
void AimingSpotFinder::gather(const cv::Mat& image, const ToolTip& tip, const Vector2d& place)
{
  const Vector2d ahead = directionOf(tip);
  const double sigma = unit_ * options_.sigma_px;
  const int half = 7;
  const double step = 3.6 * sigma / half;
  const double half_width = 0.5 * tip.shaft_width_px + sigma / 3.0;
  count_ = 0;
  for (int v = -half; v <= half; ++v) {
    for (int u = -half; u <= half; ++u) {
      const Vector2d at(std::round(place.x() + u * step), std::round(place.y() + v * step));
      const Vector2d from_tip = at - Vector2d(tip.x_px, tip.y_px);
      const double along = from_tip.dot(ahead), across = from_tip.x() * ahead.y() - from_tip.y() * ahead.x();
      if (along < 0.0 && std::abs(across) < std::min(half_width, sigma / 2.0 - 0.5 * along)) continue;
      const Colour colour = colourAt(image, at, gain_);
      if (!isRetina(colour)) continue;
      samples_[count_++] = {static_cast<float>(at.x()), static_cast<float>(at.y()), colour.red, colour.pale};
    }
  }
}

// Neighbouring pixels err alike (compression, texture): as if every fourth counted. Never below the model's own error.
void AimingSpotFinder::report(const Spot& spot, const Equations& equations)
{
  const double variance = std::max(kLeastNoise * kLeastNoise, equations.squares / static_cast<double>(count_));
  const Eigen::Matrix2d formal = equations.normal.inverse().block<2, 2>(1, 1);
  const double floor = kLeastSpotSigma_px * unit_;
  reach_ = kRingSigmas * spot.sigma;
  spot_.present = true;
  spot_.x_px = spot.centre.x();
  spot_.y_px = spot.centre.y();
  spot_.covariance = 4.0 * variance * formal + floor * floor * Eigen::Matrix2d::Identity();
}

// A saturated pixel pulls only where the model is darker than it.
AimingSpotFinder::Equations AimingSpotFinder::equationsAt(const Spot& spot, const Vector2d& place) const
{
  Equations equations;
  const double inverse = 1.0 / (spot.sigma * spot.sigma);
  for (std::size_t i = 0; i < count_; ++i) {
    const Sample& sample = samples_[i];
    const double x = sample.x - place.x(), y = sample.y - place.y();
    const double dx = sample.x - spot.centre.x(), dy = sample.y - spot.centre.y();
    const double q = (dx * dx + dy * dy) * inverse;
    const double light = std::exp(-0.5 * q);
    const double plane = spot.plane[0] + spot.plane[1] * x + spot.plane[2] * y;
    const double residual = sample.red - (spot.rise * light + plane);
    if (sample.red >= kSaturated && residual < 0.0) continue;
    const double slope = spot.rise * light * inverse;
    Numbers row;
    row << light, slope * dx, slope * dy, spot.rise * light * q, 1.0, x, y;
    equations.normal += row.lazyProduct(row.transpose());
    equations.gradient += residual * row;
    equations.squares += residual * residual;
  }
  return equations;
}

// Gauss-Newton, a little damped.
std::optional<AimingSpotFinder::Spot> AimingSpotFinder::fit(const Vector2d& place) const
{
  constexpr int kSteps = 5;
  constexpr std::size_t kLeast = 60;
  if (count_ < kLeast) return {};
  const double usual = unit_ * options_.sigma_px;
  Spot spot{2.0 * options_.least_rise, place, usual, {meanRed(), 0.0, 0.0}};
  for (int step = 0; step < kSteps; ++step) {
    Equations equations = equationsAt(spot, place);
    equations.normal.diagonal() *= 1.0 + 1e-3;
    const Numbers change = equations.normal.ldlt().solve(equations.gradient);
    if (!change.allFinite()) return {};
    spot.rise += change[0];
    spot.centre += change.segment<2>(1).cwiseMax(-usual).cwiseMin(usual);
    spot.sigma *= std::exp(std::clamp(change[3], -0.5, 0.5));
    spot.plane += change.tail<3>();
    const bool possible = spot.rise > 0.0 && spot.rise < kMostRise && (spot.centre - place).norm() < 2.5 * usual &&
                          spot.sigma > usual / 3.0 && spot.sigma < 2.0 * usual;
    if (!possible) return {};
    if (change.segment<2>(1).norm() < kSettled_px * unit_) break;
  }
  return spot;
}

double AimingSpotFinder::meanRed() const
{
  double sum = 0.0;
  for (std::size_t i = 0; i < count_; ++i) sum += samples_[i].red;
  return sum / static_cast<double>(count_);
}

// The spot must be most of what is to be seen there, and red: white light lifts green and blue as much.
bool AimingSpotFinder::isCertain(const Spot& spot, const Vector2d& place, double squares) const
{
  double light_sum = 0.0, light_squares = 0.0, pale = 0.0, pale_light = 0.0, variance = 0.0;
  const auto n = static_cast<double>(count_);
  const double mean = meanRed();
  for (std::size_t i = 0; i < count_; ++i) {
    const Sample& sample = samples_[i];
    const double dx = sample.x - spot.centre.x(), dy = sample.y - spot.centre.y();
    const double light = std::exp(-0.5 * (dx * dx + dy * dy) / (spot.sigma * spot.sigma));
    const double tilt = spot.plane[1] * (sample.x - place.x()) + spot.plane[2] * (sample.y - place.y());
    light_sum += light;
    light_squares += light * light;
    pale += sample.pale;
    pale_light += sample.pale * light;
    variance += (sample.red - tilt - mean) * (sample.red - tilt - mean);
  }
  const double spread = light_squares - light_sum * light_sum / n;
  const double pale_rise = (pale_light - pale * light_sum / n) / std::max(1e-6, spread);
  const double explained = 1.0 - squares / std::max(1e-6, variance);
  return spot.rise >= options_.least_rise && explained >= options_.least_explained &&
         pale_rise <= options_.most_white * spot.rise;
}

}  // namespace eyeslam::tracking
