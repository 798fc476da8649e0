// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/results_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/partial_file.h"
#include "eyeslam/files/whole_file.h"

namespace eyeslam::trials {

namespace {

using Row = std::vector<std::string>;

std::string quoted(const std::string& cell)
{
  if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
  std::string result = "\"";
  for (const char letter : cell) {
    if (letter == '"') result += '"';
    result += letter;
  }
  return result + '"';
}

std::string lineOf(const Row& row)
{
  std::string line;
  for (const std::string& cell : row) line += (line.empty() && &cell == &row.front() ? "" : ",") + quoted(cell);
  return line + "\n";
}

/// Takes a table apart, a letter after the other.
class CellReader {
 public:
  explicit CellReader(const std::string& text) : text_(text) {}

  bool atEnd() const { return at_ == text_.size(); }
  /// Of the row that comes next, from 1.
  int line() const { return line_; }

  Row row()
  {
    Row cells{cell()};
    while (take(',')) cells.push_back(cell());
    take('\r');
    if (!atEnd() && !take('\n')) throw std::invalid_argument("something follows a closing quote");
    ++line_;
    return cells;
  }

 private:
  bool take(char letter)
  {
    if (atEnd() || text_[at_] != letter) return false;
    ++at_;
    return true;
  }

  std::string cell() { return take('"') ? quotedCell() : plainCell(); }

  std::string plainCell()
  {
    const std::size_t end = std::min(text_.find_first_of(",\r\n", at_), text_.size());
    std::string cell = text_.substr(at_, end - at_);
    at_ = end;
    return cell;
  }

  std::string quotedCell()
  {
    std::string cell;
    while (!atEnd()) {
      const char letter = text_[at_++];
      if (letter == '"' && !take('"')) return cell;
      if (letter == '\n') ++line_;
      cell += letter;
    }
    throw std::invalid_argument("a quote is not closed");
  }

  const std::string& text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

}  // namespace

std::string resultsTable(const std::vector<TrialScore>& scores)
{
  std::string text = lineOf(columns());
  for (const TrialScore& score : scores) text += lineOf(rowOf(score));
  return text;
}

std::vector<TrialScore> parseResultsTable(const std::string& text)
{
  std::vector<TrialScore> scores;
  bool named = false;
  CellReader reader(text);
  while (!reader.atEnd()) {
    const int line = reader.line();
    try {
      const Row row = reader.row();
      if (row == columns()) {
        named = true;
      } else if (!named) {
        throw std::invalid_argument("a table of results begins with the names of its columns: " + lineOf(columns()));
      } else {
        scores.push_back(scoreOf(row));
      }
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("line {}: {}", line, error.what()));
    }
  }
  if (!named) throw std::invalid_argument("line 1: there is no line of names");
  return scores;
}

void writeResultsTable(const std::string& path, const std::vector<TrialScore>& scores)
{
  files::PartialFile file(path);
  files::writeWholeFile(file.partialPath(), resultsTable(scores));
  file.publish();
}

std::vector<TrialScore> readResultsTable(const std::string& path)
{
  const std::string text = files::readWholeText(path);
  try {
    return parseResultsTable(text);
  } catch (const std::invalid_argument& error) {
    throw files::FileError(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace eyeslam::trials
