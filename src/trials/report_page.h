// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace eyeslam::trials {

/// Rows of text under a row of names.
struct ReportTable {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;
  std::size_t words = 1;  ///< so many columns stand left; the others, being numbers, right
};

/// A figure that is said first.
struct Headline {
  std::string value, unit, name;
};

/// A self-contained page: no script, no address outside of it, also well-formed as XML. Texts are given as they are and
/// escaped here.
class ReportPage {
 public:
  ReportPage(const std::string& title, const std::string& subtitle);

  /// In a box that says so; nothing of none.
  void warnings(const std::vector<std::string>& warnings);
  void headlines(const std::vector<Headline>& headlines);
  void section(const std::string& title);
  void paragraph(const std::string& text);
  void note(const std::string& text);
  /// Numbered. @param svg  may be empty: then nothing is shown
  void figure(const std::string& svg, const std::string& caption);
  /// Nothing of no rows.
  void table(const ReportTable& table, const std::string& caption);
  /// Folded: text as it stands in a file.
  void folded(const std::string& summary, const std::string& text);
  /// Folded. Nothing of no rows.
  void foldedTable(const std::string& summary, const ReportTable& table);

  std::string html() const;

 private:
  std::string title_, body_;
  int figures_ = 0, tables_ = 0;
};

}  // namespace eyeslam::trials
