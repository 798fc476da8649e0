// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

namespace eyeslam::support {

/// What is wrong with a text as XML, empty where nothing is: elements closed in order, attributes quoted and each once,
/// no bare & or <. Knows neither CDATA nor comments, which a report does not need.
class XmlCheck {
 public:
  static std::string faultOf(const std::string& text) { return XmlCheck(text).run(); }

 private:
  explicit XmlCheck(const std::string& text) : text_(text) {}

  std::string run()
  {
    const std::string doctype = "<!DOCTYPE html>\n";
    if (text_.rfind(doctype, 0) == 0) at_ = doctype.size();
    while (at_ < text_.size() && fault_.empty()) {
      if (text_[at_] == '<') {
        element();
      } else {
        letter();
      }
    }
    if (fault_.empty() && !open_.empty()) fail("<" + open_.back() + "> is not closed");
    return fault_;
  }

  void letter()
  {
    if (open_.empty() && std::isspace(static_cast<unsigned char>(text_[at_])) == 0) fail("text outside of the root");
    if (text_[at_] == '&') reference();
    ++at_;
  }

  void reference()
  {
    const std::size_t end = text_.find(';', at_);
    const std::string name = end == std::string::npos ? "" : text_.substr(at_ + 1, end - at_ - 1);
    static const std::vector<std::string> kKnown{"amp", "lt", "gt", "quot", "#39"};
    if (std::find(kKnown.begin(), kKnown.end(), name) == kKnown.end()) fail("a bare &");
  }

  void element()
  {
    const bool closes = text_.compare(at_, 2, "</") == 0;
    at_ += closes ? 2 : 1;
    const std::string name = word();
    if (name.empty()) return fail("a bare <");
    if (closes) {
      if (open_.empty() || open_.back() != name) return fail("</" + name + "> closes nothing");
      open_.pop_back();
    } else {
      attributes(name);
    }
    if (!fault_.empty()) return;
    const bool empty = text_[at_] == '/';
    at_ += empty ? 1 : 0;
    if (text_[at_++] != '>') return fail("<" + name + " does not end");
    if (!closes && !empty) open_.push_back(name);
  }

  void attributes(const std::string& element)
  {
    std::vector<std::string> seen;
    while (fault_.empty() && at_ < text_.size() && text_[at_] != '>' && text_[at_] != '/') {
      if (std::isspace(static_cast<unsigned char>(text_[at_])) != 0) {
        ++at_;
        continue;
      }
      const std::string name = word();
      if (name.empty() || std::find(seen.begin(), seen.end(), name) != seen.end())
        return fail("attributes of <" + element + ">");
      seen.push_back(name);
      if (text_.compare(at_, 2, "=\"") != 0) return fail(name + " of <" + element + "> is not quoted");
      for (at_ += 2; at_ < text_.size() && text_[at_] != '"'; ++at_) {
        if (text_[at_] == '<') return fail("< in an attribute of <" + element + ">");
        if (text_[at_] == '&') reference();
      }
      ++at_;
    }
  }

  std::string word()
  {
    const std::size_t from = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '-' ||
                                  text_[at_] == ':' || text_[at_] == '_'))
      ++at_;
    return text_.substr(from, at_ - from);
  }

  void fail(const std::string& what)
  {
    if (fault_.empty()) fault_ = what + " near: " + text_.substr(at_ > 60 ? at_ - 60 : 0, 120);
  }

  const std::string& text_;
  std::size_t at_ = 0;
  std::vector<std::string> open_;
  std::string fault_;
};

}  // namespace eyeslam::support
