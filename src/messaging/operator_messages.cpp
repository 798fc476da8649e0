// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/operator_messages.h"

#include "eyeslam/messaging/field_copy.h"

namespace eyeslam::messaging {
namespace {

bool goTogether(const WantedFixture& fixture)
{
  return (fixture.kind == FixtureKind::vessel || fixture.vessel == -1) &&
         (fixture.kind == FixtureKind::point || (fixture.kind == FixtureKind::vessel && fixture.vessel == -1) ||
          fixture.point_px.isZero(0.0)) &&
         (fixture.kind == FixtureKind::standoff || fixture.standoff == 0.0);
}

bool goTogether(const OperatorWish& wish)
{
  for (std::size_t i = 0; i < wish.zone.size(); ++i) {
    const bool used = static_cast<int>(i) < wish.zones;
    if (used ? wish.zone[i].corners < 3 : wish.zone[i].corners != 0) return false;
  }
  return wish.plan_approved || wish.plan_hash == Hash{};
}

template <class Copy, class Message, class Fixture>
void listFixture(Copy& copy, Message& message, Fixture& fixture)
{
  copy.choice(message.fixture, fixture.kind, FixtureKind::calibration);
  copy.number(message.vessel, fixture.vessel, {-1.0, kAnyNumber.highest});
  copy.numbers(message.point_px, fixture.point_px, kImage_px);
  copy.number(message.standoff, fixture.standoff, {0.0, 0.02});
  copy.number(message.lambda, fixture.lambda, {0.0, 1.0});
  copy.require(goTogether(fixture));
}

template <class Copy, class Message, class Zones>
void listZones(Copy& copy, Message& message, Zones& zones)
{
  for (std::size_t i = 0; i < zones.size(); ++i) {
    copy.number(message.zone_points[i], zones[i].corners, {0.0, Zone::kMostCorners});
    for (int j = 0; j < Zone::kMostCorners; ++j) {
      copy.number(message.zone_x_px[i][j], zones[i].corner_px(0, j), kImage_px);
      copy.number(message.zone_y_px[i][j], zones[i].corner_px(1, j), kImage_px);
    }
  }
}

}  // namespace

template <>
struct Listing<operator_t> {
  template <class Copy, class Message, class Wish>
  static void list(Copy& copy, Message& message, Wish& wish)
  {
    copy.choice(message.mode, wish.mode, WantedMode::laser);
    copy.flag(message.stop, wish.stop);
    copy.flag(message.arm, wish.arm);
    copy.number(message.rearmed, wish.rearmed, kNotNegative);
    copy.number(message.map_id, wish.map_id, kAnyNumber);
    listFixture(copy, message, wish.fixture);
    copy.flag(message.plan_approved, wish.plan_approved);
    copy.counts(message.plan_hash, wish.plan_hash);
    copy.number(message.zones, wish.zones, {0.0, OperatorWish::kMostZones});
    listZones(copy, message, wish.zone);
    copy.require(goTogether(wish));
  }
};
template struct ListedConversion<operator_t, OperatorWish>;

}  // namespace eyeslam::messaging
