// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/configuration/listing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sodium.h>

#include <algorithm>
#include <array>

namespace eyeslam::configuration {
namespace {

std::vector<std::string> split(const std::string& key)
{
  std::vector<std::string> parts{""};
  for (const char c : key) {
    if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

std::string groupOf(const std::string& key)
{
  const std::size_t dot = key.rfind('.');
  return dot == std::string::npos ? "" : key.substr(0, dot);
}

std::string indent(std::size_t depth) { return std::string(2 * depth, ' '); }

// Opens the groups of `path` that the key before was not in.
std::string groupHeads(const std::vector<std::string>& path, const std::vector<std::string>& before)
{
  std::string heads;
  bool same = true;
  for (std::size_t depth = 0; depth + 1 < path.size(); ++depth) {
    same = same && depth + 1 < before.size() && before[depth] == path[depth];
    if (!same) heads += indent(depth) + path[depth] + ":\n";
  }
  return heads;
}

// Within YAML's double quotes, where a bare end of line would become a space.
std::string escaped(char c)
{
  if (c == '\n') return "\\n";
  if (c == '\r') return "\\r";
  return c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
}

std::string quoted(const Field& field)
{
  const bool is_text = std::holds_alternative<std::string*>(field.value) && field.choices.empty();
  if (!is_text) return textOf(field);
  std::string text = "\"";
  for (const char c : textOf(field)) text += escaped(c);
  return text + '"';
}

std::string limits(const Field& field) { return allowedText(field) + (field.unit.empty() ? "" : "; " + field.unit); }

// A bar would end the table's cell.
std::string cell(std::string text)
{
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

}  // namespace

std::string yamlOf(const std::vector<Field>& fields, YamlComments comments)
{
  std::string text;
  std::vector<std::string> before;
  for (const Field& field : fields) {
    const std::vector<std::string> path = split(field.key);
    text += groupHeads(path, before);
    const std::string margin = indent(path.size() - 1);
    const bool bare = comments == YamlComments::left_out;
    if (!bare) text += fmt::format("{}# {}\n", margin, field.doc);
    text += fmt::format("{}{}: {}{}\n", margin, path.back(), quoted(field), bare ? "" : "  # " + limits(field));
    before = path;
  }
  return text;
}

std::string markdownOf(const std::vector<Field>& fields)
{
  std::string text;
  std::string group = ".";  // no key's group
  for (const Field& field : fields) {
    if (groupOf(field.key) != group) {
      group = groupOf(field.key);
      text += fmt::format("{}## {}\n\n| key | default | allowed | what it does; source |\n| --- | --- | --- | --- |\n",
                          text.empty() ? "" : "\n", group.empty() ? "General" : "`" + group + "`");
    }
    text += fmt::format("| `{}` | {} | {} | {} |\n", field.key, textOf(field), cell(limits(field)), cell(field.doc));
  }
  return text;
}

std::string canonicalOf(const std::vector<Field>& fields)
{
  std::vector<std::string> lines;
  lines.reserve(fields.size());
  for (const Field& field : fields) lines.push_back(fmt::format("{}={}\n", field.key, textOf(field)));
  std::sort(lines.begin(), lines.end());
  return fmt::format("{}", fmt::join(lines, ""));
}

std::string hashOf(const std::vector<Field>& fields)
{
  const std::string text = canonicalOf(fields);
  std::array<unsigned char, crypto_hash_sha256_BYTES> digest{};
  crypto_hash_sha256(digest.data(), reinterpret_cast<const unsigned char*>(text.data()), text.size());
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

}  // namespace eyeslam::configuration
