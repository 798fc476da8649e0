// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/message_csv.h"

#include <fmt/compile.h>

#include <cstdlib>
#include <iterator>
#include <stdexcept>
#include <type_traits>

#include "eyeslam/messaging/decoding.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/replay/column_name.h"
#include "eyeslam/replay/device_fields.h"
#include "eyeslam/replay/record_fields.h"
#include "eyeslam/replay/servo_fields.h"
#include "eyeslam/replay/vision_fields.h"

namespace eyeslam::replay {
namespace {

// The names of the columns.
class ColumnNames {
 public:
  template <class Value>
  void number(const FieldName& name, Value)
  {
    add(name);
  }
  void text(const FieldName& name, std::string_view) { add(name); }
  void bytes(const FieldName& name, const std::uint8_t*, std::size_t) { add(name); }

  const std::string& line() const { return line_; }

 private:
  void add(const FieldName& name)
  {
    if (!line_.empty()) line_ += ',';
    line_ += columnName(name);
  }

  std::string line_;
};

// The values of a line.
class Cells {
 public:
  explicit Cells(fmt::memory_buffer& line) : line_(line) {}

  template <class Value>
  void number(const FieldName&, Value value)
  {
    separate();
    if constexpr (std::is_floating_point_v<Value>) {
      fmt::format_to(std::back_inserter(line_), FMT_COMPILE("{}"), static_cast<double>(value));
    } else {
      fmt::format_to(std::back_inserter(line_), FMT_COMPILE("{}"), static_cast<std::int64_t>(value));
    }
  }

  void text(const FieldName&, std::string_view characters)
  {
    separate();
    if (characters.find_first_of(",\"\r\n") == std::string_view::npos) {
      line_.append(characters.data(), characters.data() + characters.size());
      return;
    }
    line_.push_back('"');
    for (const char character : characters) {
      if (character == '"') line_.push_back('"');
      line_.push_back(character);
    }
    line_.push_back('"');
  }

  void bytes(const FieldName&, const std::uint8_t* values, std::size_t count)
  {
    constexpr char kDigits[] = "0123456789abcdef";
    separate();
    for (std::size_t i = 0; i < count; ++i) {
      line_.push_back(kDigits[values[i] >> 4U]);
      line_.push_back(kDigits[values[i] & 15U]);
    }
  }

 private:
  void separate()
  {
    if (!first_) line_.push_back(',');
    first_ = false;
  }

  fmt::memory_buffer& line_;
  bool first_ = true;
};

template <class Message>
std::string headerOfType()
{
  ColumnNames names;
  visitFields(Message{}, names);
  return names.line();
}

template <class Message>
bool appendMessage(const files::LogEvent& event, fmt::memory_buffer& line)
{
  Message message{};
  if (!messaging::decode(event.data, event.size, message)) return false;
  Cells cells(line);
  visitFields(message, cells);
  return true;
}

template <class... Messages>
MessageCsv chosen(const MessageType& type, const std::tuple<Messages...>*)
{
  MessageCsv csv;
  const auto take = [&](const char* name, std::string (*header)(), auto appendRow) {
    if (type.name == name) csv = {&type, header(), appendRow};
  };
  (take(Messages::getTypeName(), &headerOfType<Messages>, &appendMessage<Messages>), ...);
  return csv;
}

}  // namespace

MessageCsv csvOf(const MessageType& type) { return chosen(type, static_cast<const MessageTypes*>(nullptr)); }

std::string targetHeader() { return headerOfType<burn_target_t>(); }

void appendTarget(const burn_target_t& target, fmt::memory_buffer& line)
{
  Cells cells(line);
  visitFields(target, cells);
}

void appendPlace(const SortedEvent& event, fmt::memory_buffer& line)
{
  constexpr std::int64_t kSecond = 1'000'000;
  const std::lldiv_t since = std::lldiv(std::llabs(event.since_us), kSecond);
  fmt::format_to(std::back_inserter(line), FMT_COMPILE("{},{}{}.{:06},"), event.event.utime,
                 event.since_us < 0 ? "-" : "", since.quot, since.rem);
}

}  // namespace eyeslam::replay
