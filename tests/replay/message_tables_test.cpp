// SPDX-License-Identifier: GPL-3.0-or-later
// Tables against the bytes of the messages, read by the declarations in lcmtypes/ alone.
#include "eyeslam/replay/message_tables.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <random>
#include <set>

#include "eyeslam/files/file_error.h"
#include "support/lcm_fields.h"
#include "support/written_log.h"

namespace eyeslam::replay {
namespace {

using support::Bytes;
using support::headed;
using support::kLogStart;
using support::LcmField;

using Line = std::vector<std::string>;

// Lines of cells, by RFC 4180.
std::vector<Line> parsed(const std::string& text)
{
  std::vector<Line> lines(1, Line(1));
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string& cell = lines.back().back();
    if (quoted) {
      if (text[i] != '"') {
        cell += text[i];
      } else if (i + 1 < text.size() && text[i + 1] == '"') {
        cell += text[++i];
      } else {
        quoted = false;
      }
    } else if (text[i] == '"') {
      quoted = true;
    } else if (text[i] == ',') {
      lines.back().emplace_back();
    } else if (text[i] == '\n') {
      lines.emplace_back(1);
    } else {
      cell += text[i];
    }
  }
  lines.pop_back();  // each line ends in a newline
  return lines;
}

class Tables : public ::testing::Test {
 protected:
  void write()
  {
    SortedLog log(log_.finish());
    MessageTables tables([this](const std::string& name) { return log_.path(name); });
    while (const auto event = log.next()) tables.add(*event);
    tables.finish();
    for (const TableCounts& counts : tables.counts()) counts_[counts.channel] = counts;
  }

  std::vector<Line> read(const std::string& name) const
  {
    const Bytes bytes = files::readWholeFile(log_.path(name));
    return parsed({bytes.begin(), bytes.end()});
  }

  support::WrittenLog log_;
  std::map<std::string, TableCounts> counts_;
};

// The values of an encoded message, one after another.
class EncodedValues {
 public:
  explicit EncodedValues(const Bytes& bytes) : bytes_(bytes), at_(8) {}  // behind the fingerprint

  std::int64_t whole(std::size_t size)
  {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8U | bytes_.at(at_++);
    const unsigned unused = 64U - 8U * static_cast<unsigned>(size);
    return static_cast<std::int64_t>(value << unused) >> unused;
  }
  double real()
  {
    const std::int64_t bits = whole(8);
    double value = 0.0;
    std::memcpy(&value, &bits, 8);
    return value;
  }
  double halfReal()
  {
    const auto bits = static_cast<std::int32_t>(whole(4));
    float value = 0.0F;
    std::memcpy(&value, &bits, 4);
    return static_cast<double>(value);
  }
  std::string text(std::size_t size)
  {
    const std::string characters(bytes_.begin() + static_cast<std::ptrdiff_t>(at_),
                                 bytes_.begin() + static_cast<std::ptrdiff_t>(at_ + size));
    at_ += size;
    return characters;
  }
  bool isAtEnd() const { return at_ == bytes_.size(); }

 private:
  const Bytes& bytes_;
  std::size_t at_;
};

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

std::string hexadecimal(const std::string& bytes)
{
  std::string digits;
  for (const char byte : bytes) digits += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return digits;
}

// Compares a line with the bytes that it was made of, field by field as declared.
class LineCheck {
 public:
  LineCheck(const Line& names, const Line& cells, const Bytes& bytes) : names_(names), cells_(cells), values_(bytes) {}

  void expect(const std::vector<LcmField>& fields)
  {
    ASSERT_EQ(names_.size(), cells_.size());
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (fields[i].type == "burn_target_t") return;  // a table of its own
      expectField(fields[i]);
      skipWords(fields, i);
    }
    EXPECT_TRUE(values_.isAtEnd());
    EXPECT_EQ(at_, cells_.size());
  }

 private:
  void expectField(const LcmField& field)
  {
    const std::int64_t count = field.count.empty() ? field.values : counts_.at(field.count);
    if (field.type == "byte") return expectText(field.name, hexadecimal(values_.text(static_cast<std::size_t>(count))));
    if (field.type == "string") {
      const auto size = static_cast<std::size_t>(values_.whole(4));
      const std::string text = values_.text(size);
      return expectText(field.name, text.substr(0, size - 1));
    }
    for (std::int64_t i = 0; i < count; ++i) expectNumber(field);
  }

  void expectText(const std::string& name, const std::string& text)
  {
    ASSERT_LT(at_, cells_.size());
    EXPECT_EQ(names_[at_], name);
    EXPECT_EQ(cells_[at_++], text);
  }

  void expectNumber(const LcmField& field)
  {
    ASSERT_LT(at_, cells_.size()) << field.name;
    EXPECT_EQ(names_[at_].compare(0, field.name.size(), field.name), 0) << names_[at_] << " for " << field.name;
    const std::string& cell = cells_[at_++];
    if (field.type == "double" || field.type == "float") {
      const double value = field.type == "double" ? values_.real() : values_.halfReal();
      EXPECT_TRUE(same(std::strtod(cell.c_str(), nullptr), value)) << field.name << " " << cell << " is not " << value;
      return;
    }
    static const std::map<std::string, std::size_t> kBytes = {
        {"int64_t", 8}, {"int32_t", 4}, {"int16_t", 2}, {"boolean", 1}};
    const std::int64_t value = values_.whole(kBytes.at(field.type));
    counts_[field.name] = value;
    EXPECT_EQ(cell, std::to_string(value)) << field.name;
  }

  // Words and bits of what stands before them; they belong to no field that is yet to come.
  void skipWords(const std::vector<LcmField>& fields, std::size_t done)
  {
    const auto isOf = [this](const LcmField& field) {
      return names_[at_].compare(0, field.name.size(), field.name) == 0;
    };
    while (at_ < names_.size() && isOf(fields[done]) &&
           std::none_of(fields.begin() + static_cast<std::ptrdiff_t>(done) + 1, fields.end(), isOf)) {
      ++at_;
    }
  }

  const Line& names_;
  const Line& cells_;
  EncodedValues values_;
  std::size_t at_ = 2;  // behind the place
  std::map<std::string, std::int64_t> counts_;
};

template <class Message>
Bytes filledAtRandom(std::mt19937& random)
{
  Bytes bytes = support::encodedMessage(Message{});
  for (std::size_t i = 8; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(random());
  return bytes;
}

template <>
Bytes filledAtRandom<mark_t>(std::mt19937& random)
{
  mark_t mark = headed<mark_t>(kLogStart, static_cast<std::int64_t>(random()));
  for (std::string* text : {&mark.sender, &mark.version, &mark.configuration, &mark.configuration_hash, &mark.note}) {
    const std::size_t size = random() % 40;
    for (std::size_t i = 0; i < size; ++i) *text += "ab,\"\n 'x;"[random() % 9];
  }
  return support::encodedMessage(mark);
}

template <>
Bytes filledAtRandom<vessel_map_t>(std::mt19937& random)
{
  vessel_map_t tile = headed<vessel_map_t>(kLogStart, static_cast<std::int64_t>(random()));
  tile.cells = 1 + static_cast<std::int32_t>(random() % 400);
  for (auto* cells : {&tile.probability, &tile.calibre_px, &tile.seen}) {
    cells->resize(static_cast<std::size_t>(tile.cells));
    for (std::uint8_t& cell : *cells) cell = static_cast<std::uint8_t>(random());
  }
  return support::encodedMessage(tile);
}

template <>
Bytes filledAtRandom<burn_plan_t>(std::mt19937& random)
{
  burn_plan_t plan = headed<burn_plan_t>(kLogStart, static_cast<std::int64_t>(random()));
  plan.targets = static_cast<std::int32_t>(random() % 3);
  plan.target.resize(static_cast<std::size_t>(plan.targets));
  plan.margin_um = 0.1 * static_cast<double>(random() % 1000);
  return support::encodedMessage(plan);
}

template <class Message>
class TableOf : public Tables {};

template <class Tuple>
struct TypesOf;
template <class... Messages>
struct TypesOf<std::tuple<Messages...>> {
  using Types = ::testing::Types<Messages...>;
};
TYPED_TEST_SUITE(TableOf, TypesOf<MessageTypes>::Types, );

// Any bits that a message can carry: also numbers that are none, and the smallest.
TYPED_TEST(TableOf, HoldsEveryFieldOfTheDeclarationExactly)
{
  const std::string channel = messaging::channelOf<TypeParam>();
  std::mt19937 random(3);
  std::vector<Bytes> messages;
  for (int i = 0; i < 50; ++i) {
    messages.push_back(filledAtRandom<TypeParam>(random));
    this->log_.add(channel, messages.back(), kLogStart + 1500 * i);
  }
  this->write();
  const std::vector<Line> lines = this->read(channel + ".csv");
  ASSERT_EQ(lines.size(), messages.size() + 1);
  EXPECT_EQ(this->counts_[channel].rows, 50);
  const auto fields = support::lcmFields(std::string(EYESLAM_LCMTYPES) + "/" + TypeParam::getTypeName() + ".lcm");
  for (std::size_t i = 0; i < messages.size() && !this->HasFailure(); ++i) {
    LineCheck(lines[0], lines[i + 1], messages[i]).expect(fields);
    EXPECT_EQ(lines[i + 1][0], std::to_string(kLogStart + 1500 * static_cast<std::int64_t>(i)));
    EXPECT_EQ(lines[i + 1][1], fmt::format("{:.6f}", 0.0015 * static_cast<double>(i)));
  }
  EXPECT_EQ(std::set<std::string>(lines[0].begin(), lines[0].end()).size(), lines[0].size()) << "a name twice";
}

TEST(MessageTypes, AreAllThatLcmtypesDeclares)
{
  std::set<std::string> declared, listed = {burn_target_t::getTypeName()};  // of burn_plan_t, never sent alone
  for (const auto& entry : std::filesystem::directory_iterator(EYESLAM_LCMTYPES)) {
    if (entry.path().extension() == ".lcm") declared.insert(entry.path().stem().string());
  }
  for (const MessageType& type : messageTypes()) listed.insert(type.name);
  EXPECT_EQ(listed, declared);
}

TEST_F(Tables, NameUnitsThatTheFieldsThemselvesDoNot)
{
  log_.add(headed<retina_pose_t>(kLogStart, 0), kLogStart);
  log_.add(headed<micron_state_t>(kLogStart, 0), kLogStart);
  write();
  const auto names = [this](const char* file) {
    const Line line = read(file).front();
    return std::set<std::string>(line.begin(), line.end());
  };
  for (const char* name : {"utime_us", "x_px", "theta_rad", "velocity_x_px_per_s", "covariance_x_x_px2",
                           "covariance_x_y_px2", "covariance_y_theta_px_rad", "covariance_theta_theta_rad2"}) {
    EXPECT_EQ(names("RETINA_POSE.csv").count(name), 1U) << name;
  }
  for (const char* name : {"null_position_z_m", "tip_orientation_w", "lead_s", "acceleration_limit_m_per_s2",
                           "reason_word", "flags_powered", "limits_pivot", "commands_refused_expired"}) {
    EXPECT_EQ(names("MICRON_STATE.csv").count(name), 1U) << name;
  }
}

TEST_F(Tables, GiveEachTargetOfAPlanALine)
{
  burn_plan_t plan = headed<burn_plan_t>(kLogStart, 4);
  plan.targets = 2;
  plan.target.resize(2);
  plan.target[1].id = 12;
  plan.target[1].x_px = 0.1 + 0.2;
  plan.target[1].state = burn_target_t::REFUSED;
  log_.add(plan, kLogStart);
  write();
  const std::vector<Line> lines = read("BURN_PLAN.targets.csv");
  ASSERT_EQ(lines.size(), 3U);
  std::map<std::string, std::string> second;
  for (std::size_t i = 0; i < lines[0].size(); ++i) second[lines[0][i]] = lines[2].at(i);
  EXPECT_EQ(second["seq"], "4");
  EXPECT_EQ(second["id"], "12");
  EXPECT_EQ(second["x_px"], "0.30000000000000004");
  EXPECT_EQ(second["state_word"], "refused");
}

TEST_F(Tables, LeaveOutAndCountWhatIsNotOursToday)
{
  Bytes changed = support::encodedMessage(headed<micron_state_t>(kLogStart, 0));
  changed[0] ^= 1U;
  log_.add(headed<micron_state_t>(kLogStart, 0), kLogStart);
  log_.add("MICRON_STATE", changed, kLogStart);
  Bytes cut = support::encodedMessage(headed<micron_state_t>(kLogStart, 0));
  cut.resize(100);
  log_.add("MICRON_STATE", cut, kLogStart);
  log_.add("SOMEBODYS", changed, kLogStart);
  log_.add("a/b ..", support::encodedMessage(headed<tool_tip_t>(kLogStart, 0)), kLogStart);
  write();
  EXPECT_EQ(read("MICRON_STATE.csv").size(), 2U);
  EXPECT_EQ(counts_["MICRON_STATE"].changed_type, 1);
  EXPECT_EQ(counts_["MICRON_STATE"].undecodable, 1);
  EXPECT_EQ(counts_["SOMEBODYS"].foreign, 1);
  EXPECT_EQ(counts_["SOMEBODYS"].file, "");
  EXPECT_EQ(counts_["a/b .."].file, "a%2Fb%20...csv");
  EXPECT_EQ(read("a%2Fb%20...csv").size(), 2U);
}

TEST_F(Tables, SayThatADiskIsFull)
{
  log_.add(headed<micron_state_t>(kLogStart, 0), kLogStart);
  SortedLog log(log_.finish());
  MessageTables tables([](const std::string&) { return "/dev/full"; });
  const auto event = log.next();
  EXPECT_THROW(tables.add(*event), files::FileError);
}

}  // namespace
}  // namespace eyeslam::replay
