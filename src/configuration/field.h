// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "eyeslam/retina/options.h"

namespace eyeslam::configuration {

/// One option of a struct, by reference: the struct must outlive it.
struct Field {
  using Value = std::variant<bool*, int*, std::int64_t*, std::uint64_t*, float*, double*, std::string*>;

  std::string key;  ///< groups and name, joined by dots: "frame.scale"
  Value value;
  retina::Range range;
  std::string unit;                  ///< empty where the number has none
  std::string doc;                   ///< what it does; source
  std::vector<std::string> choices;  ///< of a choice, else empty
};

/// The visitor that lists what an options struct visits (src/retina/options.h).
class FieldCollector {
 public:
  template <class T>
  void field(const char* name, T& value, retina::Range range, const char* unit, const char* doc)
  {
    fields_.push_back({prefix_ + name, &value, range, unit, doc, {}});
  }

  void choice(const char* name, std::string& value, std::vector<std::string> choices, const char* doc)
  {
    fields_.push_back({prefix_ + name, &value, {}, "", doc, std::move(choices)});
  }

  template <class Options>
  void group(const char* name, Options& options)
  {
    const std::string outer = prefix_;
    prefix_ += std::string(name) + ".";
    Options::visit(options, *this);
    prefix_ = outer;
  }

  std::vector<Field> take() { return std::move(fields_); }

 private:
  std::string prefix_;
  std::vector<Field> fields_;
};

/// All options of a struct, in the order in which it lists them.
template <class Options>
std::vector<Field> fieldsOf(Options& options)
{
  FieldCollector collector;
  Options::visit(options, collector);
  return collector.take();
}

/// The value as YAML and `--set` spell it; numbers in the shortest form that reads back to the same value.
std::string textOf(const Field& field);

/// What is allowed, in words: "a number in [0.1, 1]", "true or false", "one of ridge, tracing".
std::string allowedText(const Field& field);

/// Sets the value from its text.
/// @return empty, or what is wrong with the text ("is not ..."); then the value is as before
std::string assignText(Field& field, const std::string& text);

}  // namespace eyeslam::configuration
