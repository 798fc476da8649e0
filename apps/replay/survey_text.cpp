// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/survey_text.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <vector>

#include "command_line/progress.h"

#include "eyeslam/servo/loop_time.h"

namespace eyeslam::apps {
namespace {

using replay::ChannelFindings;
using replay::LogSurvey;
using servo::seconds;

const char* const kKinds[] = {"start", "stop", "note"};  // as in mark_t

double milliseconds(std::int64_t us) { return 1e-3 * static_cast<double>(us); }

std::string dateText(std::int64_t utime)
{
  const std::time_t time = static_cast<std::time_t>(utime / 1'000'000);
  std::tm parts{};
  if (gmtime_r(&time, &parts) == nullptr) return "an unknown date";
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", parts);
}

std::string headText(const LogSurvey& survey, const std::string& path)
{
  return fmt::format("{}: {:.3f} s from {}, {} events on {} channels, {:.1f} MB\n", path,
                     seconds(survey.end - survey.start), dateText(survey.start), survey.events, survey.channels.size(),
                     1e-6 * static_cast<double>(survey.file_bytes));
}

std::string damageText(const LogSurvey& survey)
{
  const files::LogDamage& damage = survey.damage;
  if (damage.gaps == 0 && !damage.cut_off) return "  damage     none\n";
  return fmt::format("  damage     {} bytes skipped at {} places, the first at byte {}{}\n", damage.skipped_bytes,
                     damage.gaps, damage.first_offset, damage.cut_off ? "; the file ends within an event" : "");
}

std::string timesText(const LogSurvey& survey)
{
  const replay::SortFindings& times = survey.times;
  std::string text =
      fmt::format("  order      {}",
                  survey.damage.out_of_order == 0
                      ? std::string("by time")
                      : fmt::format("{} events before the one in front of them, sorted", survey.damage.out_of_order));
  if (times.late > 0) text += fmt::format("; {} too far to sort, up to {:.3f} s", times.late, seconds(times.latest_us));
  if (times.strays > 0) text += fmt::format("; {} with an impossible time", times.strays);
  if (times.steps_back > 0) text += fmt::format("; time steps back at {} places (joined logs)", times.steps_back);
  return text + fmt::format("\n  silence    {:.1f} ms at most, at {:.3f} s\n", milliseconds(survey.gap.us),
                            seconds(survey.gap.since_us));
}

std::string typeText(const ChannelFindings& channel)
{
  if (channel.changed_type > 0) return channel.type + " (refused)";
  return channel.type.empty() ? "not ours" : channel.type;
}

std::string channelsText(const std::vector<ChannelFindings>& channels)
{
  std::size_t width = 7;
  for (const ChannelFindings& channel : channels) width = std::max(width, channel.channel.size());
  std::string text = fmt::format("\n{:<{}}  {:<20} {:>9} {:>9} {:>10} {:>9} {:>6} {:>6} {:>9} {:>8} {:>8} {:>8}\n",
                                 "channel", width, "type", "events", "1/s", "gap ms", "at s", "lost", "again",
                                 "overtaken", "sessions", "age ms", "at most");
  for (const ChannelFindings& channel : channels) {
    text += fmt::format("{:<{}}  {:<20} {:>9} {:>9.2f} {:>10.1f} {:>9.3f}", printable(channel.channel), width,
                        typeText(channel), channel.events, channel.rate, milliseconds(channel.gap.us),
                        seconds(channel.gap.since_us));
    if (channel.sessions > 0) {
      text +=
          fmt::format(" {:>6} {:>6} {:>9} {:>8} {:>8.1f} {:>8.1f}", channel.lost, channel.repeated, channel.overtaken,
                      channel.sessions, 1e-3 * channel.age.quantile(0.5), milliseconds(channel.age.highest()));
    }
    text += '\n';
  }
  return text;
}

// What is wrong with one channel, a line each.
std::string complaintsOf(const ChannelFindings& channel)
{
  const std::string name = printable(channel.channel);
  std::string text;
  const auto say = [&text, &name](std::int64_t count, const std::string& what) {
    if (count > 0) text += fmt::format("  {}: {} {}\n", name, count, what);
  };
  if (channel.changed_type > 0) {
    say(channel.changed_type,
        fmt::format("refused: not today's {} (fingerprint {:016x}); {}", channel.type,
                    static_cast<std::uint64_t>(channel.fingerprint.value_or(0)), replay::migrationOf(channel.type)));
  }
  say(channel.undecodable, fmt::format("refused: no whole {}", channel.type));
  say(channel.utime_missing, "without utime or utime_sent");
  say(channel.utime_backwards, "with a utime before that of the message before");
  say(channel.from_future, "with a utime after utime_sent");
  say(channel.sent_later, fmt::format("sent after the log received them, by up to {:.1f} ms: two clocks",
                                      milliseconds(-channel.transport.lowest())));
  return text;
}

std::string marksText(const LogSurvey& survey)
{
  std::string text;
  for (const replay::LoggedMark& logged : survey.marks) {
    const mark_t& mark = logged.mark;
    const bool known = mark.kind >= 0 && mark.kind < 3;
    text += fmt::format("  {:10.3f} s  {:<5}  {} {}", seconds(logged.since_us), known ? kKinds[mark.kind] : "?",
                        printable(mark.sender), printable(mark.version));
    if (!mark.configuration_hash.empty()) {
      text += fmt::format("  configuration {}", printable(mark.configuration_hash.substr(0, 12)));
    }
    text += mark.note.empty() ? "\n" : fmt::format("  {}\n", printable(mark.note));
  }
  if (survey.marks_left_out > 0) text += fmt::format("  and {} more\n", survey.marks_left_out);
  return text.empty() ? "\nno MARK says who sent this\n" : "\nmarks\n" + text;
}

}  // namespace

std::string printable(std::string text)
{
  const auto steers = [](char letter) { return static_cast<unsigned char>(letter) < 32 || letter == 127; };
  std::replace_if(text.begin(), text.end(), steers, '?');
  return text;
}

std::string surveyText(const LogSurvey& survey, const std::string& path)
{
  std::string text = headText(survey, path) + damageText(survey) + timesText(survey) + channelsText(survey.channels);
  if (survey.left_out > 0) text += fmt::format("and {} events on more channels\n", survey.left_out);
  std::string complaints;
  for (const ChannelFindings& channel : survey.channels) complaints += complaintsOf(channel);
  if (!complaints.empty()) text += "\nto be looked at\n" + complaints;
  return text + marksText(survey);
}

}  // namespace eyeslam::apps
