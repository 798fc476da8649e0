// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/guidance.h"

#include <algorithm>
#include <limits>

#include "eyeslam/retina/units.h"

namespace eyeslam::servo {

using fixtures::CurveFixture;
using fixtures::PlaneFixture;
using fixtures::PlaneSide;
using fixtures::PointFixture;
using messaging::FixtureKind;
using messaging::OperatorWish;
using messaging::WantedFixture;
using retina::Reason;

namespace {

bool same(const WantedFixture& a, const WantedFixture& b)
{
  return a.kind == b.kind && a.vessel == b.vessel && a.point_px == b.point_px && a.standoff == b.standoff &&
         a.lambda == b.lambda;
}

bool same(const messaging::Zone& a, const messaging::Zone& b)
{
  return a.corners == b.corners && a.corner_px == b.corner_px;
}

// Ids of the graph are ints.
int idOf(const WantedFixture& fixture)
{
  return fixture.vessel <= std::numeric_limits<int>::max() ? static_cast<int>(fixture.vessel)
                                                           : std::numeric_limits<int>::max();
}

fixtures::KeepOutZone zoneOf(const messaging::Zone& drawn, double m_per_px)
{
  fixtures::KeepOutZone zone;
  zone.count = static_cast<std::size_t>(drawn.corners);
  for (int i = 0; i < drawn.corners; ++i)
    zone.corners[static_cast<std::size_t>(i)] = m_per_px * drawn.corner_px.col(i).cast<double>();
  return zone;
}

}  // namespace

GuidanceOptions::GuidanceOptions() { vessel.keeps_to = "vessel"; }

Guidance::Guidance(const GuidanceOptions& options) : options_(options), fixtures_(options.fixtures) {}

std::shared_ptr<const fixtures::CenterlineIndex> Guidance::vesselsOfMap() const noexcept
{
  const bool fits = preparation_ && preparation_->map_id == frame_.map_id &&
                    preparation_->um_per_px == frame_.um_per_px && preparation_->vessels;
  return fits ? preparation_->vessels : nullptr;
}

void Guidance::adopt(const Preparation* preparation) noexcept
{
  preparation_ = preparation;
  if (served_.map_id == frame_.map_id) fixtures_.adopt(vesselsOfMap(), static_cast<std::uint64_t>(served_.map_id));
}

bool Guidance::speaksOfMap(const OperatorWish& wish) const noexcept
{
  const FixtureKind kind = wish.fixture.kind;
  return kind == FixtureKind::point || kind == FixtureKind::vessel || wish.zones > 0;
}

bool Guidance::isInForce(const WantedFixture& fixture) const noexcept
{
  return in_force_ && same(fixture, served_.fixture) && served_.map_id == frame_.map_id &&
         served_.um_per_px == frame_.um_per_px;
}

// One that is followed may lose its id in a newer map; the curve then knows how to go on.
Reason Guidance::whyNotVessel(const WantedFixture& fixture) const noexcept
{
  const auto vessels = vesselsOfMap();
  if (!vessels || vessels->empty()) return Reason::no_vessel;
  const bool follows = isInForce(fixture) && output_.curve != nullptr;
  return follows || vessels->find(vesselId(fixture)) >= 0 ? Reason::none : Reason::vessel_unknown;
}

// Without an id it is the one that the human points at.
int Guidance::vesselId(const WantedFixture& fixture) const noexcept
{
  const auto vessels = vesselsOfMap();
  if (fixture.vessel >= 0 || !vessels) return idOf(fixture);
  const auto place = vessels->nearest(kMicro * frame_.um_per_px * fixture.point_px, 1e-6 * options_.vessel.capture_um);
  return place ? vessels->id(place->vessel) : std::numeric_limits<int>::max();
}

Reason Guidance::whyNot(const OperatorWish& wish) const noexcept
{
  if (!needs_retina_) return Reason::none;
  if (!(frame_.um_per_px > 0.0)) return Reason::scale_unknown;
  if (speaksOfMap(wish) && wish.map_id != frame_.map_id) return Reason::map_changed;
  if (zones_reason_ != Reason::none) return zones_reason_;
  return wish.fixture.kind == FixtureKind::vessel ? whyNotVessel(wish.fixture) : Reason::none;
}

Reason Guidance::drawZones(const OperatorWish& wish) noexcept
{
  const auto count = static_cast<std::ptrdiff_t>(wish.zones);
  const bool unchanged = wish.zones == zones_ && frame_.um_per_px == zones_um_per_px_ &&
                         std::equal(zone_.begin(), zone_.begin() + count, wish.zone.begin(),
                                    [](const messaging::Zone& a, const messaging::Zone& b) { return same(a, b); });
  if (unchanged) return zones_reason_;
  zones_ = wish.zones;
  zone_ = wish.zone;
  zones_um_per_px_ = frame_.um_per_px;
  fixtures_.keepOut().clearZones();
  bool good = true;
  for (int i = 0; i < zones_; ++i)
    good = fixtures_.keepOut().add(zoneOf(zone_[static_cast<std::size_t>(i)], kMicro * zones_um_per_px_)) && good;
  return good ? Reason::none : Reason::zone_invalid;
}

Reason Guidance::serve(const OperatorWish& wish, const RetinaFrame& frame) noexcept
{
  if (frame.view != frame_.view) fixtures_.forget();
  frame_ = frame;
  wanted_ = wish.fixture;
  const bool free = wanted_.kind == FixtureKind::none && wish.zones == 0;
  guides_ = !free;
  needs_retina_ = !free && wanted_.kind != FixtureKind::calibration;
  if (frame_.um_per_px > 0.0) zones_reason_ = drawZones(wish);
  const Reason reason = whyNot(wish);
  // What cannot be served lets go only by the supervisor's hand-over: the last fixture stands until that is done.
  if (engaged_ && reason == Reason::none && needs_retina_ && !isInForce(wanted_)) put(wanted_);
  return reason;
}

void Guidance::engage(Engaged engaged) noexcept
{
  engaged_ = engaged == Engaged::yes;
  if (engaged_ || !in_force_) return;
  fixtures_.assign({});
  fixtures_.scale({});
  in_force_ = false;
}

void Guidance::put(const WantedFixture& fixture) noexcept
{
  const bool same_frame = served_.map_id == frame_.map_id && served_.um_per_px == frame_.um_per_px;
  if (!same_frame) fixtures_.adopt(vesselsOfMap(), static_cast<std::uint64_t>(frame_.map_id));
  // A point that moves is travelled to, where another fixture is handed over to.
  const bool point_moves = in_force_ && same_frame && fixture.kind == FixtureKind::point &&
                           served_.fixture.kind == FixtureKind::point && fixture.lambda == served_.fixture.lambda;
  auto* point = point_moves ? std::get_if<PointFixture>(fixtures_.fixture(0)) : nullptr;
  if (point) {
    point->moveTo(kMicro * frame_.um_per_px * fixture.point_px);
  } else {
    assign(fixture);
  }
  served_ = {fixture, frame_.map_id, frame_.um_per_px};
  in_force_ = true;
}

fixtures::ComplianceOptions Guidance::soft(fixtures::ComplianceOptions options, double lambda) const noexcept
{
  options.lambda = lambda;
  return options;
}

void Guidance::assign(const WantedFixture& fixture) noexcept
{
  fixtures::MotionScalingOptions scaling = options_.fixtures.scaling;
  scaling.least = fixture.kind == FixtureKind::scaling ? options_.scaling_least : 1.0;
  fixtures_.scale(scaling);
  fixtures::PointFixtureOptions point = options_.point;
  point.compliance = soft(point.compliance, fixture.lambda);
  fixtures::CurveFixtureOptions vessel = options_.vessel;
  vessel.compliance = soft(vessel.compliance, fixture.lambda);
  const PlaneSide side = options_.standoff_side == "floor" ? PlaneSide::floor : PlaneSide::hold;
  switch (fixture.kind) {
    case FixtureKind::point:
      return fixtures_.assign({PointFixture(kMicro * frame_.um_per_px * fixture.point_px, point)});
    case FixtureKind::vessel:
      return fixtures_.assign({CurveFixture(vessel, vesselId(fixture))});
    case FixtureKind::standoff:
      return fixtures_.assign({PlaneFixture::standoff(fixture.standoff, side, soft({}, fixture.lambda))});
    case FixtureKind::none:
    case FixtureKind::filter:
    case FixtureKind::scaling:
    case FixtureKind::calibration:
      return fixtures_.assign({});
  }
}

Eigen::Vector3d Guidance::goal(const Outlook& outlook) noexcept
{
  fixtures::FixtureInput input;
  input.null_tip = outlook.null_retina;
  input.dt = outlook.step_s;
  input.tracked = outlook.reason == Reason::none;
  // In force: of the map that it was made for. Else whatever map there is will do.
  if (!in_force_ && served_.map_id != frame_.map_id) {
    fixtures_.adopt(vesselsOfMap(), static_cast<std::uint64_t>(frame_.map_id));
    served_.map_id = frame_.map_id;
  }
  input.map_id = static_cast<std::uint64_t>(frame_.map_id);
  output_ = fixtures_.evaluate(input);
  return output_.known ? output_.goal : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace eyeslam::servo
