// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/comparison.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "eyeslam/replay/column_name.h"
#include "eyeslam/replay/field_values.h"

namespace eyeslam::replay {
namespace {

constexpr const char* kWhole = "message";
constexpr const char* kBytes = "bytes";

bool sameBytes(const files::LogEvent& a, const files::LogEvent& b)
{
  return a.size == b.size && std::memcmp(a.data, b.data, a.size) == 0;
}

std::string bytesText(const files::LogEvent& event) { return textOf(event.data, event.size); }

void noteFirst(ChannelComparison& channel, const files::LogEvent& event, std::string field, std::string recorded,
               std::string recomputed)
{
  if (channel.first) return;
  channel.first = {event.utime, event.number, std::move(field), std::move(recorded), std::move(recomputed)};
}

FieldDifference& fieldOf(ChannelComparison& channel, const std::string& name)
{
  const auto found = std::find_if(channel.fields.begin(), channel.fields.end(),
                                  [&name](const FieldDifference& field) { return field.field == name; });
  if (found != channel.fields.end()) return *found;
  channel.fields.push_back({name});
  return channel.fields.back();
}

void add(ChannelComparison& channel, const std::string& field, double difference)
{
  FieldDifference& sum = fieldOf(channel, field);
  ++sum.messages;
  const double share = 1.0 / static_cast<double>(sum.messages);
  sum.rms = std::sqrt(sum.rms * sum.rms * (1.0 - share) + difference * difference * share);
  sum.largest = std::max(sum.largest, difference);
  channel.largest = std::max(channel.largest, difference);
}

}  // namespace

void Comparison::compare(const files::LogEvent& recorded, const files::LogEvent& recomputed)
{
  if (!counts(recorded)) return;
  ChannelComparison& channel = of(recorded.channel);
  ++channel.compared;
  if (sameBytes(recorded, recomputed)) {
    ++channel.identical;
    return;
  }
  const std::vector<FieldValue> was = valuesOf(recorded), is = valuesOf(recomputed);
  bool told = false;
  for (std::size_t i = 0; i < std::min(was.size(), is.size()); ++i) {
    if (isSame(was[i], is[i])) continue;
    const std::string name = columnName(was[i].name);
    add(channel, name, distance(was[i], is[i]));
    noteFirst(channel, recorded, name, textOf(was[i]), textOf(is[i]));
    told = true;
  }
  if (told) return;
  add(channel, kBytes, 0.0);
  noteFirst(channel, recorded, kBytes, bytesText(recorded), bytesText(recomputed));
}

void Comparison::missing(const files::LogEvent& recorded)
{
  if (!counts(recorded)) return;
  ChannelComparison& channel = of(recorded.channel);
  ++channel.missing;
  noteFirst(channel, recorded, kWhole, bytesText(recorded), "");
}

void Comparison::extra(const files::LogEvent& recomputed)
{
  if (!counts(recomputed)) return;
  ChannelComparison& channel = of(recomputed.channel);
  ++channel.extra;
  noteFirst(channel, recomputed, kWhole, "", bytesText(recomputed));
}

void Comparison::restrictTo(std::int64_t from_utime, std::int64_t to_utime)
{
  from_ = from_utime;
  to_ = to_utime;
}

bool Comparison::isIdentical() const
{
  return std::all_of(channels_.begin(), channels_.end(), [](const ChannelComparison& c) { return c.isIdentical(); });
}

ChannelComparison& Comparison::of(std::string_view channel)
{
  const auto place =
      std::lower_bound(channels_.begin(), channels_.end(), channel,
                       [](const ChannelComparison& known, std::string_view name) { return known.channel < name; });
  if (place != channels_.end() && place->channel == channel) return *place;
  ChannelComparison& fresh = *channels_.emplace(place);
  fresh.channel = channel;
  return fresh;
}

}  // namespace eyeslam::replay
