// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/message_tables.h"

#include <cctype>
#include <fstream>
#include <iterator>
#include <utility>

#include "eyeslam/files/file_error.h"
#include "eyeslam/messaging/decoding.h"
#include "eyeslam/messaging/record_messages.h"

namespace eyeslam::replay {
namespace {

constexpr const char* kOthers = "...";
const std::string kTargetsEnding = ".targets.csv";

std::string stemOf(std::string_view channel)
{
  std::string stem;
  for (const char character : channel) {
    const auto byte = static_cast<unsigned char>(character);
    const bool plain = std::isalnum(byte) != 0 || character == '_' || character == '-' || character == '.';
    stem += plain && byte < 128 ? std::string(1, character) : fmt::format("%{:02X}", byte);
  }
  return stem;
}

bool isPlan(const MessageType& type) { return type.name == burn_plan_t::getTypeName(); }

}  // namespace

// A file of lines, written in blocks.
class MessageTables::CsvFile {
 public:
  CsvFile(const std::string& path, std::string name, const std::string& header)
      : stream_(path, std::ios::binary), name_(std::move(name))
  {
    const std::string line = header + "\n";
    block_.append(line.data(), line.data() + line.size());
    flush();
  }

  void add(const fmt::memory_buffer& line)
  {
    block_.append(line.data(), line.data() + line.size());
    block_.push_back('\n');
    if (block_.size() >= kBlock) flush();
  }

  void flush()
  {
    stream_.write(block_.data(), static_cast<std::streamsize>(block_.size()));
    stream_.flush();
    block_.clear();
    if (!stream_) throw files::FileError(name_ + ": cannot be written; is the disk full?");
  }

 private:
  static constexpr std::size_t kBlock = std::size_t{1} << 16;

  std::ofstream stream_;
  std::string name_;
  fmt::memory_buffer block_;
};

std::string tableFileOf(std::string_view channel) { return stemOf(channel) + ".csv"; }

MessageTables::MessageTables(std::function<std::string(const std::string&)> path_of) : path_of_(std::move(path_of)) {}
MessageTables::~MessageTables() = default;

std::vector<std::string> MessageTables::usualFiles()
{
  std::vector<std::string> names;
  for (const MessageType& type : messageTypes()) {
    names.push_back(tableFileOf(type.channel));
    if (isPlan(type)) names.push_back(type.channel + kTargetsEnding);
  }
  return names;
}

MessageTables::Channel& MessageTables::channelOf(std::string_view name)
{
  if (const auto found = channels_.find(name); found != channels_.end()) return found->second;
  const std::string own(channels_.size() < kMostChannels || typeOfChannel(name) ? name : kOthers);
  Channel& channel = channels_[own];
  channel.counts.channel = own;
  return channel;
}

void MessageTables::add(const SortedEvent& event)
{
  const JudgedEvent judged = judge(event.event);
  Channel& channel = channelOf(event.event.channel);
  TableCounts& counts = channel.counts;
  const bool other = channel.csv.type && judged.type && channel.csv.type != judged.type;
  if (counts.channel == kOthers || judged.standing == Standing::foreign) {
    ++counts.foreign;
  } else if (other || judged.standing == Standing::changed_type) {
    ++counts.changed_type;
  } else if (judged.standing == Standing::wrong_length) {
    ++counts.undecodable;
  } else {
    if (!channel.file) open(channel, *judged.type);
    write(channel, event);
  }
}

void MessageTables::open(Channel& channel, const MessageType& type)
{
  channel.csv = csvOf(type);
  const std::string name = tableFileOf(channel.counts.channel);
  channel.file = std::make_unique<CsvFile>(path_of_(name), name, kPlaceColumns + channel.csv.header);
  channel.counts.file = name;
  if (!isPlan(type)) return;
  const std::string targets = stemOf(channel.counts.channel) + kTargetsEnding;
  channel.targets =
      std::make_unique<CsvFile>(path_of_(targets), targets, kPlaceColumns + ("seq,session," + targetHeader()));
}

void MessageTables::write(Channel& channel, const SortedEvent& event)
{
  line_.clear();
  appendPlace(event, line_);
  if (!channel.csv.appendRow(event.event, line_)) {
    ++channel.counts.undecodable;
    return;
  }
  channel.file->add(line_);
  ++channel.counts.rows;
  if (channel.targets) writeTargets(channel, event);
}

void MessageTables::writeTargets(Channel& channel, const SortedEvent& event)
{
  burn_plan_t plan{};
  if (!messaging::decode(event.event.data, event.event.size, plan)) return;
  for (const burn_target_t& target : plan.target) {
    line_.clear();
    appendPlace(event, line_);
    fmt::format_to(std::back_inserter(line_), "{},{},", plan.seq, plan.session);
    appendTarget(target, line_);
    channel.targets->add(line_);
  }
}

void MessageTables::finish()
{
  for (auto& [name, channel] : channels_) {
    if (channel.file) channel.file->flush();
    if (channel.targets) channel.targets->flush();
  }
}

std::vector<TableCounts> MessageTables::counts() const
{
  std::vector<TableCounts> all;
  for (const auto& [name, channel] : channels_) all.push_back(channel.counts);
  return all;
}

}  // namespace eyeslam::replay
