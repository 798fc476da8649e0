// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/video_offset.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "eyeslam/messaging/decoding.h"
#include "eyeslam/messaging/micron_messages.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/replay/message_types.h"

namespace eyeslam::replay {
namespace {

constexpr double kFarthest_s = 10.0;   // offset
constexpr double kLongest_s = 120.0;   // of the log
constexpr double kStates_s = 0.004;    // between states that are kept: four a frame at 60 Hz
constexpr double kLongestGap_s = 0.2;  // of a path, over which a place is still interpolated
constexpr double kOwnWidth_s = 0.25;   // of the peak: motion of eyes is alike for as long
constexpr std::int64_t kFewest = 40;   // steps
constexpr double kUsualRate = 30.0;
constexpr double kWild = 8.0;  // medians: a step beyond was not measured but guessed
constexpr std::int64_t kAhead = 300;

double rateOf(double frames_per_second) { return frames_per_second > 0.0 ? frames_per_second : kUsualRate; }

Eigen::Vector3d vector(const double (&values)[3]) { return {values[0], values[1], values[2]}; }

/// Where the path was; `hint` walks along with rising times.
template <class Places>
std::optional<Eigen::Vector3d> placeAt(const Places& places, double t_s, std::size_t& hint)
{
  while (hint + 1 < places.size() && places[hint + 1].t_s <= t_s) ++hint;
  if (hint + 1 >= places.size()) return std::nullopt;
  const auto& a = places[hint];
  const auto& b = places[hint + 1];
  if (t_s < a.t_s || b.t_s - a.t_s > kLongestGap_s) return std::nullopt;
  const double share = (t_s - a.t_s) / (b.t_s - a.t_s);
  return Eigen::Vector3d(a.at + share * (b.at - a.at));
}

/// Top of the parabola through three neighbouring values, from the middle one, and how sharply it is bent there.
struct Top {
  double at = 0.0, bend = 0.0;
};
Top topOf(double before, double peak, double after)
{
  const double bend = 2.0 * peak - before - after;
  if (!(bend > 0.0)) return {0.0, 0.0};
  return {std::clamp(0.5 * (after - before) / bend, -0.5, 0.5), bend};
}

double fisher(double correlation) { return std::atanh(std::min(correlation, 1.0 - 1e-12)); }

}  // namespace

bool OffsetEstimate::isCertain() const
{
  constexpr double kErrors = 3.0, kLeast = 0.3;
  const double apart = (fisher(correlation) - fisher(second)) * std::sqrt(static_cast<double>(steps) / 2.0);
  return correlation >= kLeast && apart >= kErrors && kErrors * sigma_s <= frame_s;
}

VideoOffset::VideoOffset(double frames_per_second, std::int64_t shift)
    : period_s_(1.0 / rateOf(frames_per_second)), shift_(shift)
{}

void VideoOffset::addPicture(std::int64_t number, const cv::Mat& image)
{
  if (!wantsPictures()) return;
  // Pictures long before the log's first pose: the log was cut.
  if (!stamps_.empty() && number + shift_ + kAhead < stamps_.front().pose) return;
  if (const auto moved = motion_.add(image)) steps_.push_back({number, {moved->x, moved->y}});
}

void VideoOffset::take(const SortedEvent& event)
{
  if (start_ == 0) start_ = event.utime - event.since_us;
  if (1e-6 * static_cast<double>(event.since_us) > kLongest_s) return;
  if (event.event.channel == "RETINA_POSE") takePose(event);
  if (event.event.channel == "MICRON_STATE") takeState(event);
}

void VideoOffset::takePose(const SortedEvent& event)
{
  retina_pose_t pose{};
  if (!messaging::decode(event.event.data, event.event.size, pose)) return;
  if (session_ == 0) session_ = pose.session;
  const double t_s = 1e-6 * static_cast<double>(pose.utime - start_);
  const bool goes_on = stamps_.empty() || (pose.seq > stamps_.back().pose && t_s > stamps_.back().t_s);
  if (pose.session != session_ || pose.utime <= 0 || !goes_on) return;
  stamps_.push_back({pose.seq, t_s});
  if (pose.tracked != 0) poses_.places.push_back({t_s, {pose.x_px, pose.y_px, 0.0}});
}

void VideoOffset::takeState(const SortedEvent& event)
{
  micron_state_t state{};
  const double t_s = 1e-6 * static_cast<double>(event.since_us);
  if (!tip_.places.empty() && t_s < tip_.places.back().t_s + kStates_s) return;
  if (!messaging::decode(event.event.data, event.event.size, state)) return;
  const Eigen::Vector3d tip = vector(state.tip_position), port = vector(state.port_displacement);
  if (!tip.allFinite() || !port.allFinite()) return;
  tip_.places.push_back({t_s, tip});
  if (state.port_measured != 0) port_.places.push_back({t_s, port});
}

const VideoOffset::Path* VideoOffset::path() const
{
  for (const Path* path : {&poses_, &port_, &tip_})
    if (path->places.size() > static_cast<std::size_t>(kFewest)) return path;
  return nullptr;
}

// Between poses that are known by their numbers, beyond them by the period.
double VideoOffset::timeOf(std::int64_t picture) const
{
  if (stamps_.size() < 2) return static_cast<double>(picture) * period_s_;
  const std::int64_t pose = picture + shift_;
  const auto after =
      std::lower_bound(stamps_.begin(), stamps_.end(), pose, [](const Stamp& s, std::int64_t p) { return s.pose < p; });
  if (after == stamps_.end()) return stamps_.back().t_s + period_s_ * static_cast<double>(pose - stamps_.back().pose);
  if (after->pose == pose || after == stamps_.begin())
    return after->t_s - period_s_ * static_cast<double>(after->pose - pose);
  const Stamp& before = *std::prev(after);
  const double share = static_cast<double>(pose - before.pose) / static_cast<double>(after->pose - before.pose);
  return before.t_s + share * (after->t_s - before.t_s);
}

std::vector<VideoOffset::Timed> VideoOffset::timedSteps() const
{
  std::vector<Timed> timed;
  std::vector<double> lengths;
  for (const Step& step : steps_) lengths.push_back(step.moved_px.norm());
  if (lengths.empty()) return timed;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  for (const Step& step : steps_) {
    const double begin = timeOf(step.picture - 1), end = timeOf(step.picture);
    if (step.moved_px.norm() > kWild * *middle + 1.0 || !(end > begin)) continue;
    timed.push_back({begin, end, step.moved_px});
  }
  return timed;
}

// The multiple correlation of the picture's motion with a linear map of the log's.
VideoOffset::Fit VideoOffset::fit(const std::vector<Timed>& steps, const Path& path, double offset_s)
{
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> products = Eigen::Matrix<double, 3, 2>::Zero();
  double all = 0.0;
  Fit result;
  std::size_t begin_hint = 0, end_hint = 0;
  for (const Timed& step : steps) {
    const auto begin = placeAt(path.places, step.begin_s + offset_s, begin_hint);
    const auto end = placeAt(path.places, step.end_s + offset_s, end_hint);
    if (!begin || !end) continue;
    const Eigen::Vector3d logged = *end - *begin;
    squares += logged * logged.transpose();
    products += logged * step.moved_px.transpose();
    all += step.moved_px.squaredNorm();
    ++result.steps;
  }
  const double size = squares.trace();
  if (result.steps < kFewest || !(all > 0.0) || !(size > 0.0)) return result;
  squares.diagonal().array() += 1e-9 * size;  // of what does not move in one direction
  const double explained = (products.transpose() * squares.ldlt().solve(products)).trace();
  result.correlation = std::sqrt(std::clamp(explained / all, 0.0, 1.0));
  return result;
}

std::optional<OffsetEstimate> VideoOffset::estimate() const
{
  const Path* const moved = path();
  const std::vector<Timed> steps = timedSteps();
  if (moved == nullptr || static_cast<std::int64_t>(steps.size()) < kFewest) return std::nullopt;
  const int farthest = static_cast<int>(kFarthest_s / period_s_);
  const auto at = [&](double frames) { return fit(steps, *moved, frames * period_s_); };
  const auto enough = static_cast<std::int64_t>(steps.size()) / 3;
  std::vector<double> found(static_cast<std::size_t>(2 * farthest + 1), 0.0);
  for (int lag = -farthest; lag <= farthest; ++lag) {
    const Fit tried = at(lag);
    if (tried.steps >= enough) found[static_cast<std::size_t>(lag + farthest)] = tried.correlation;
  }
  double best = static_cast<double>(std::max_element(found.begin(), found.end()) - found.begin()) - farthest;
  const double whole = best;
  // Places that are denser than frames tell where between two frames the best offset is.
  for (int tenth = -9; moved != &poses_ && tenth <= 9; ++tenth)
    if (at(whole + 0.1 * tenth).correlation > at(best).correlation) best = whole + 0.1 * tenth;
  const Fit peak = at(best);
  if (peak.correlation <= 0.0) return std::nullopt;
  const Top top = topOf(at(best - 1).correlation, peak.correlation, at(best + 1).correlation);
  OffsetEstimate result{
      (best + top.at) * period_s_, period_s_, kFarthest_s, peak.correlation, 0.0, peak.steps, moved->name};
  if (top.bend > 0.0) {
    const double left = 1.0 - peak.correlation * peak.correlation;
    result.sigma_s = period_s_ * std::sqrt(left / (static_cast<double>(peak.steps) * peak.correlation * top.bend));
  }
  const double own = std::max(2.0, kOwnWidth_s / period_s_);
  for (int lag = -farthest; lag <= farthest; ++lag)
    if (std::abs(lag - best) > own)
      result.second = std::max(result.second, found[static_cast<std::size_t>(lag + farthest)]);
  return result;
}

}  // namespace eyeslam::replay
