// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/comparison_text.h"

#include <fmt/format.h>

#include "replay/survey_text.h"

namespace eyeslam::apps {
namespace {

using replay::ChannelComparison;
using replay::FieldDifference;
using replay::FirstDifference;

double secondsSince(std::int64_t start, std::int64_t utime) { return 1e-6 * static_cast<double>(utime - start); }

std::string firstText(const FirstDifference& first)
{
  if (first.recorded.empty() && first.field == "message") return "sent now, not recorded";
  if (first.recomputed.empty() && first.field == "message") return "recorded, not sent now";
  return fmt::format("{}: {} was recorded, {} is computed", first.field, first.recorded, first.recomputed);
}

std::string channelLine(const ChannelComparison& channel)
{
  return fmt::format("{:<15} {:>9} {:>9} {:>9} {:>9}", channel.channel, channel.compared, channel.identical,
                     channel.missing, channel.extra);
}

std::string fieldLine(const FieldDifference& field)
{
  if (field.largest == 0.0) return fmt::format("  {:<32} in {} messages\n", field.field, field.messages);
  return fmt::format("  {:<32} in {} messages, by {:.4g} at most, {:.4g} RMS\n", field.field, field.messages,
                     field.largest, field.rms);
}

std::string detailText(const ChannelComparison& channel, std::int64_t start)
{
  std::string text =
      fmt::format("\n{} differs first at {:.3f} s (event {}), {}\n", channel.channel,
                  secondsSince(start, channel.first->utime), channel.first->event, firstText(*channel.first));
  for (const FieldDifference& field : channel.fields) text += fieldLine(field);
  return text;
}

}  // namespace

std::string comparisonText(const replay::Comparison& comparison, std::int64_t start)
{
  std::string text = fmt::format("{:<15} {:>9} {:>9} {:>9} {:>9}  {:>10}  {:>11}\n", "channel", "compared", "identical",
                                 "missing", "extra", "first at s", "differs by");
  for (const ChannelComparison& channel : comparison.channels()) {
    text += channelLine(channel);
    if (channel.first) {
      text += fmt::format("  {:>10.3f}  {:>11.4g}", secondsSince(start, channel.first->utime), channel.largest);
    }
    text += '\n';
  }
  for (const ChannelComparison& channel : comparison.channels()) {
    if (channel.first) text += detailText(channel, start);
  }
  // Texts come from a log: they shall not steer a terminal.
  std::string safe;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    safe += printable(text.substr(begin, end - begin)) + '\n';
    begin = end + 1;
  }
  return safe;
}

std::string differenceText(const replay::Comparison& comparison, std::int64_t start)
{
  std::int64_t differ = 0, all = 0;
  const ChannelComparison* earliest = nullptr;
  for (const ChannelComparison& channel : comparison.channels()) {
    differ += channel.compared - channel.identical + channel.missing + channel.extra;
    all += channel.compared + channel.missing + channel.extra;
    if (channel.first && (!earliest || channel.first->utime < earliest->first->utime)) earliest = &channel;
  }
  std::string text = fmt::format("{} of {} messages differ", differ, all);
  if (earliest) {
    text += fmt::format("; first {}.{} at {:.3f} s", earliest->channel, earliest->first->field,
                        secondsSince(start, earliest->first->utime));
  }
  return text;
}

}  // namespace eyeslam::apps
