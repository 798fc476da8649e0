// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <set>
#include <sstream>

#include "eyeslam/configuration/assignment.h"

namespace eyeslam::configuration {
namespace {

// No options struct nests deeper; an alias to its own anchor would never end.
constexpr int kDeepestGroup = 8;
constexpr int kDeepestList = 3;                // polygons, corners, coordinates
constexpr std::size_t kLongestList = 1000000;  // characters: aliases may stand for much more than the file holds

class Flattener {
 public:
  Flattener(const std::string& path, YamlLists lists) : path_(path), lists_(lists) {}

  void add(const YAML::Node& group, const std::string& prefix, int depth)
  {
    if (depth > kDeepestGroup) fail(group, fmt::format("'{}' is nested too deeply", prefix));
    for (const auto& entry : group) {
      if (!entry.first.IsScalar()) fail(entry.first, "a key must be a word");
      const std::string key = prefix + entry.first.Scalar();
      // yaml-cpp keeps both and would look up the first without a word; "a.b" may also stand beside b in the group a.
      if (!seen_.insert(key).second) fail(entry.first, fmt::format("key '{}' stands twice; keep one", key));
      addEntry(entry.second, key, depth);
    }
  }

  std::vector<Assignment> take() { return std::move(assignments_); }

 private:
  void addEntry(const YAML::Node& value, const std::string& key, int depth)
  {
    if (value.IsMap()) return add(value, key + ".", depth + 1);
    if (value.IsSequence() && lists_ == YamlLists::joined) {
      std::string text;
      join(value, key, 1, text);
      assignments_.push_back({key, text, origin(value)});
      return;
    }
    if (value.IsSequence()) fail(value, fmt::format("key '{}' has a list; one value is wanted", key));
    if (!value.IsScalar()) fail(value, fmt::format("key '{}' has no value", key));
    assignments_.push_back({key, value.Scalar(), origin(value)});
  }

  // Appends the text of a list; returns how deep lists are nested in it.
  int join(const YAML::Node& value, const std::string& key, int depth, std::string& text) const
  {
    if (value.IsScalar()) {
      text += value.Scalar();
      return 0;
    }
    if (!value.IsSequence()) fail(value, fmt::format("key '{}' has a list of something else than values", key));
    if (depth > kDeepestList) fail(value, fmt::format("key '{}' has lists nested too deeply", key));
    int height = 0;
    std::string separator;
    for (const auto& entry : value) {
      text += separator;
      const int below = join(entry, key, depth + 1, text);
      if (text.size() > kLongestList) fail(entry, fmt::format("key '{}' has too long a list", key));
      separator = below == 2 ? "; " : " ";
      height = std::max(height, below);
    }
    return height + 1;
  }

  std::string origin(const YAML::Node& node) const { return fmt::format("{}:{}", path_, node.Mark().line + 1); }

  [[noreturn]] void fail(const YAML::Node& node, const std::string& what) const
  {
    throw ConfigurationError(origin(node) + ": " + what);
  }

  std::string path_;
  YamlLists lists_;
  std::set<std::string> seen_;  // keys with their groups
  std::vector<Assignment> assignments_;
};

std::string oneLine(std::string text)
{
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

// Counts documents. YAML::LoadAll is no help: behind a tag that ends in a value it finds documents for ever (0.7).
class DocumentCounter : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark&) override { ++documents_; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

  int documents() const { return documents_; }

 private:
  int documents_ = 0;
};

bool hasSeveralDocuments(std::istream& text)
{
  YAML::Parser parser(text);
  DocumentCounter counter;
  while (counter.documents() < 2 && parser.HandleNextDocument(counter)) continue;
  return counter.documents() > 1;
}

YAML::Node parse(const std::string& name, std::istream& text)
{
  try {
    if (hasSeveralDocuments(text)) throw ConfigurationError(name + ": holds several YAML documents; one is wanted");
    text.clear();
    text.seekg(0);
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw ConfigurationError(fmt::format("{}:{}: is no YAML: {}", name, error.mark.line + 1, oneLine(error.msg)));
  }
}

std::vector<Assignment> flattened(const std::string& name, const YAML::Node& document, YamlLists lists)
{
  if (!document || document.IsNull()) return {};
  if (!document.IsMap()) throw ConfigurationError(name + ": holds no 'key: value' lines");
  Flattener flattener(name, lists);
  flattener.add(document, "", 0);
  return flattener.take();
}

}  // namespace

std::vector<Assignment> readYaml(const std::string& path, YamlLists lists)
{
  std::ifstream file(path);
  // A folder opens, but nothing can be read from it.
  if (!file || file.peek() == std::ifstream::traits_type::eof()) {
    if (file.eof()) return {};
    throw ConfigurationError(fmt::format("{}: cannot be read; a YAML file is wanted", path));
  }
  return flattened(path, parse(path, file), lists);
}

std::vector<Assignment> parseYaml(const std::string& name, const std::string& text, YamlLists lists)
{
  std::istringstream stream(text);
  return flattened(name, parse(name, stream), lists);
}

}  // namespace eyeslam::configuration
