// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/field_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <type_traits>

#include "eyeslam/messaging/decoding.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/replay/device_fields.h"
#include "eyeslam/replay/record_fields.h"
#include "eyeslam/replay/servo_fields.h"
#include "eyeslam/replay/vision_fields.h"

namespace eyeslam::replay {
namespace {

using Kind = FieldValue::Kind;
constexpr std::size_t kLongestText = 60;
constexpr std::size_t kMostBytes = 16;

class Values {
 public:
  explicit Values(std::vector<FieldValue>& list) : list_(list) {}

  template <class Value>
  void number(const FieldName& name, Value value)
  {
    if constexpr (std::is_floating_point_v<Value>) {
      list_.push_back({name, Kind::real, 0, static_cast<double>(value), {}});
    } else {
      list_.push_back({name, Kind::integer, static_cast<std::int64_t>(value), 0.0, {}});
    }
  }
  void text(const FieldName& name, std::string_view characters)
  {
    list_.push_back({name, Kind::text, 0, 0.0, std::string(characters)});
  }
  void bytes(const FieldName& name, const std::uint8_t* values, std::size_t count)
  {
    list_.push_back({name, Kind::bytes, 0, 0.0, std::string(values, values + count)});
  }

 private:
  std::vector<FieldValue>& list_;
};

// Of a plan: "x_px" of a target becomes "target_x_px".
void addTargets(const burn_plan_t& plan, std::vector<FieldValue>& list)
{
  for (const burn_target_t& target : plan.target) {
    const std::size_t first = list.size();
    Values values(list);
    visitFields(target, values);
    for (std::size_t i = first; i < list.size(); ++i) {
      FieldName& name = list[i].name;
      name = {"target", name.name, name.unit, name.part, {}};
    }
  }
}

template <class Message>
bool take(const MessageType& type, const files::LogEvent& event, std::vector<FieldValue>& list)
{
  if (type.name != Message::getTypeName()) return false;
  Message message{};
  if (!messaging::decode(event.data, event.size, message)) return true;
  Values values(list);
  visitFields(message, values);
  if constexpr (std::is_same_v<Message, burn_plan_t>) addTargets(message, list);
  return true;
}

template <class... Messages>
void takeAny(const MessageType& type, const files::LogEvent& event, std::vector<FieldValue>& list,
             const std::tuple<Messages...>*)
{
  (take<Messages>(type, event, list) || ...);
}

std::uint64_t bitsOf(double value)
{
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

}  // namespace

std::vector<FieldValue> valuesOf(const files::LogEvent& event)
{
  std::vector<FieldValue> list;
  const JudgedEvent judged = judge(event);
  if (judged.standing == Standing::ours) {
    takeAny(*judged.type, event, list, static_cast<const MessageTypes*>(nullptr));
  }
  return list;
}

bool isSame(const FieldValue& a, const FieldValue& b)
{
  return a.kind == b.kind && a.integer == b.integer && bitsOf(a.real) == bitsOf(b.real) && a.characters == b.characters;
}

double distance(const FieldValue& a, const FieldValue& b)
{
  if (a.kind == Kind::integer) return std::abs(static_cast<double>(a.integer) - static_cast<double>(b.integer));
  if (a.kind != Kind::real) return 0.0;
  const double difference = std::abs(a.real - b.real);
  return std::isfinite(difference) ? difference : std::numeric_limits<double>::infinity();
}

std::string textOf(const FieldValue& value)
{
  switch (value.kind) {
    case Kind::integer:
      return fmt::format("{}", value.integer);
    case Kind::real:
      return fmt::format("{}", value.real);
    case Kind::bytes:
      return textOf(reinterpret_cast<const std::uint8_t*>(value.characters.data()), value.characters.size());
    case Kind::text:
      break;
  }
  return value.characters.size() <= kLongestText ? value.characters : value.characters.substr(0, kLongestText) + "...";
}

std::string textOf(const std::uint8_t* bytes, std::size_t count)
{
  std::string text;
  for (std::size_t i = 0; i < std::min(count, kMostBytes); ++i) {
    fmt::format_to(std::back_inserter(text), "{:02x}", bytes[i]);
  }
  return count <= kMostBytes ? text : fmt::format("{}... ({} bytes)", text, count);
}

}  // namespace eyeslam::replay
