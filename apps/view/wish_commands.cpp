// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/wish_commands.h"

#include <fmt/format.h>

#include <functional>

namespace eyeslam::apps {
namespace {

using messaging::FixtureKind;
using messaging::OperatorWish;
using messaging::WantedFixture;
using messaging::WantedMode;

constexpr double kFarthest_px = 1e5;
constexpr double kHighestStandoff_um = 20e3;

std::int64_t mapOf(const Sight& sight, const CommandWords& words)
{
  if (sight.map_id == 0) throw CommandError(words.name() + ": there is no map yet; vision has said no RETINA_POSE");
  return sight.map_id;
}

Eigen::Vector2d pointOf(const CommandWords& words, const Sight& sight)
{
  if (words.text(1, "X or 'here'") != "here") {
    return {words.number(1, "X", -kFarthest_px, kFarthest_px), words.number(2, "Y", -kFarthest_px, kFarthest_px)};
  }
  words.expectAtMost(2);
  if (!sight.tip_px) throw CommandError("fixture " + words.text(0, "") + " here: no tip is seen in a tracked frame");
  return *sight.tip_px;
}

FixtureKind plainKind(const CommandWords& words, const std::string& kind)
{
  words.expectAtMost(1);
  if (kind == "none") return FixtureKind::none;
  if (kind == "filter") return FixtureKind::filter;
  if (kind == "scaling") return FixtureKind::scaling;
  throw CommandError("fixture " + kind + ": none, filter, scaling, point, vessel or standoff is wanted");
}

WantedFixture fixtureOf(const CommandWords& words, const Sight& sight)
{
  WantedFixture fixture;
  const std::string& kind = words.text(0, "none, filter, scaling, point, vessel or standoff");
  if (kind == "point") {
    fixture.kind = FixtureKind::point;
    fixture.point_px = pointOf(words, sight);
    return fixture;
  }
  if (kind == "vessel") {
    fixture.kind = FixtureKind::vessel;
    const bool by_place = words.arguments() > 2 || words.text(1, "ID, X Y or 'here'") == "here";
    if (by_place) {
      fixture.point_px = pointOf(words, sight);
      return fixture;
    }
    fixture.vessel = words.wholeNumber(1, "ID", 0, 1'000'000'000);
  } else if (kind == "standoff") {
    fixture.kind = FixtureKind::standoff;
    fixture.standoff = 1e-6 * words.number(1, "UM", 0.0, kHighestStandoff_um);
  } else {
    fixture.kind = plainKind(words, kind);
  }
  words.expectAtMost(2);
  return fixture;
}

std::string textOf(const WantedFixture& fixture, const std::string& kind)
{
  switch (fixture.kind) {
    case FixtureKind::point:
      return fmt::format("fixture: point at {:.1f} {:.1f} px of the map", fixture.point_px.x(), fixture.point_px.y());
    case FixtureKind::vessel:
      if (fixture.vessel >= 0) return fmt::format("fixture: vessel {}", fixture.vessel);
      return fmt::format("fixture: vessel at {:.1f} {:.1f} px of the map", fixture.point_px.x(), fixture.point_px.y());
    case FixtureKind::standoff:
      return fmt::format("fixture: standoff of {:.0f} um", 1e6 * fixture.standoff);
    default:
      return "fixture: " + kind;
  }
}

// `lambda` stays as it was: it is the human's, not the fixture's.
std::string setFixture(const CommandWords& words, const Sight& sight, OperatorWish& wish)
{
  WantedFixture fixture = fixtureOf(words, sight);
  fixture.lambda = wish.fixture.lambda;
  if (fixture.kind == FixtureKind::point || fixture.kind == FixtureKind::vessel) wish.map_id = mapOf(sight, words);
  wish.fixture = fixture;
  return textOf(fixture, words.text(0, ""));
}

std::string removeZones(OperatorWish& wish)
{
  wish.zones = 0;
  wish.zone = {};
  return "no zones";
}

messaging::Zone zoneOf(const CommandWords& words, std::size_t corners)
{
  messaging::Zone zone;
  zone.corners = static_cast<int>(corners);
  for (std::size_t i = 0; i < corners; ++i) {
    const auto corner = static_cast<Eigen::Index>(i);
    zone.corner_px(0, corner) = static_cast<float>(words.number(2 * i, "X", -kFarthest_px, kFarthest_px));
    zone.corner_px(1, corner) = static_cast<float>(words.number(2 * i + 1, "Y", -kFarthest_px, kFarthest_px));
  }
  return zone;
}

std::string addZone(const CommandWords& words, const Sight& sight, OperatorWish& wish)
{
  if (words.arguments() == 1 && words.text(0, "") == "none") return removeZones(wish);
  const std::size_t corners = words.arguments() / 2;
  if (words.arguments() % 2 != 0 || corners < 3 || corners > messaging::Zone::kMostCorners) {
    throw CommandError("zone: 3 to 16 corners X Y in order are wanted, or 'none'");
  }
  if (wish.zones == OperatorWish::kMostZones) throw CommandError("zone: there are 8 already; 'zone none' removes all");
  wish.map_id = mapOf(sight, words);
  wish.zone[static_cast<std::size_t>(wish.zones++)] = zoneOf(words, corners);
  return fmt::format("zone {} of {} corners: tip and laser keep out", wish.zones, corners);
}

// Nothing guides again, and nothing fires, because a stop was lifted: both are asked for anew.
std::string stop(OperatorWish& wish)
{
  wish.stop = true;
  wish.arm = false;
  if (wish.mode != WantedMode::standby) wish.mode = WantedMode::ready;
  return "stop; 'rearm' lifts it";
}

std::string rearm(OperatorWish& wish)
{
  wish.stop = false;
  ++wish.rearmed;
  return fmt::format("re-armed ({} in this session)", wish.rearmed);
}

std::string want(OperatorWish& wish, WantedMode mode, const char* said)
{
  wish.mode = mode;
  if (mode != WantedMode::laser) wish.arm = false;
  return said;
}

std::string calibrate(OperatorWish& wish)
{
  const double lambda = wish.fixture.lambda;
  wish.fixture = {};
  wish.fixture.lambda = lambda;
  wish.fixture.kind = FixtureKind::calibration;
  return want(wish, WantedMode::assist, "calibration: hold the hand still in the middle of the view");
}

std::string arm(OperatorWish& wish)
{
  if (wish.mode != WantedMode::laser) throw CommandError("arm: only in the mode 'laser'");
  if (!wish.plan_approved) throw CommandError("arm: no plan is approved");
  wish.arm = true;
  return "armed: the foot switch fires";
}

struct WishCommand {
  CommandHelp help;
  const char* name;
  std::size_t most_arguments;
  std::function<std::string(const CommandWords&, const Sight&, OperatorWish&)> obey;
};

constexpr std::size_t kAny = 64;

const std::vector<WishCommand>& table()
{
  using W = const CommandWords&;
  using S = const Sight&;
  using O = OperatorWish&;
  static const std::vector<WishCommand> kTable = {
      {{"standby", "nothing is commanded"},
       "standby",
       0,
       [](W, S, O wish) { return want(wish, WantedMode::standby, "wanted: standby"); }},
      {{"ready", "tremor is cancelled, nothing guides"},
       "ready",
       0,
       [](W, S, O wish) { return want(wish, WantedMode::ready, "wanted: ready"); }},
      {{"assist", "the fixture guides"},
       "assist",
       0,
       [](W, S, O wish) { return want(wish, WantedMode::assist, "wanted: assist"); }},
      {{"laser", "the approved plan is executed"},
       "laser",
       0,
       [](W, S, O wish) { return want(wish, WantedMode::laser, "wanted: laser"); }},
      {{"calibrate", "drive the tip over a safe pattern, to register the camera"},
       "calibrate",
       0,
       [](W, S, O wish) { return calibrate(wish); }},
      {{"fixture none|filter|scaling", "what guides in the mode 'assist'"}, "fixture", 3, setFixture},
      {{"fixture point X Y|here", "hold a point of the map, px, or where the tip is seen"}, "fixture", 3, setFixture},
      {{"fixture vessel ID|X Y|here", "follow a vessel: of this id, or the one nearest to a place"},
       "fixture",
       3,
       setFixture},
      {{"fixture standoff UM", "keep a height above the retina"}, "fixture", 3, setFixture},
      {{"lambda L", "share of the hand's departure that passes: 0 hard, 1 no fixture"},
       "lambda",
       1,
       [](W words, S, O wish) {
         wish.fixture.lambda = words.number(0, "L", 0.0, 1.0);
         return fmt::format("lambda: {}", wish.fixture.lambda);
       }},
      {{"zone X Y X Y X Y ...|none", "keep tip and laser out of a polygon of the map, px"}, "zone", kAny, addZone},
      {{"arm", "pulses are allowed, as far as everything else allows them"},
       "arm",
       0,
       [](W, S, O wish) { return arm(wish); }},
      {{"disarm", "no pulses"},
       "disarm",
       0,
       [](W, S, O wish) {
         wish.arm = false;
         return std::string("disarmed");
       }},
      {{"stop", "stop now; nothing moves again before 'rearm'"}, "stop", 0, [](W, S, O wish) { return stop(wish); }},
      {{"rearm", "leave Hold or Fault, lift a stop"}, "rearm", 0, [](W, S, O wish) { return rearm(wish); }},
  };
  return kTable;
}

}  // namespace

const std::vector<CommandHelp>& wishCommands()
{
  static const std::vector<CommandHelp> kHelp = [] {
    std::vector<CommandHelp> help;
    for (const WishCommand& command : table()) help.push_back(command.help);
    return help;
  }();
  return kHelp;
}

std::optional<std::string> obeyWish(const CommandWords& words, const Sight& sight, OperatorWish& wish)
{
  for (const WishCommand& command : table()) {
    if (words.name() != command.name) continue;
    words.expectAtMost(command.most_arguments);
    OperatorWish changed = wish;
    std::string said = command.obey(words, sight, changed);
    wish = changed;
    return said;
  }
  return std::nullopt;
}

}  // namespace eyeslam::apps
