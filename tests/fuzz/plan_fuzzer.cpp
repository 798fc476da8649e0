// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as plan.json, or as one target of a good plan: a FileError, or a plan that is written and read alike.
#include <cstdlib>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/plan_file.h"

using namespace eyeslam;

namespace {

std::string goodPlan(const std::string& target)
{
  fixtures::BurnPlan plan;
  plan.um_per_px = 5.0;
  plan.map.hash = std::string(64, '0');
  std::string text = files::planJson(plan);
  text.insert(text.rfind(']'), target);
  return text;
}

void readAndWrite(const std::string& text)
{
  try {
    const std::string written = files::planJson(files::planFrom(text, "plan.json"));
    if (files::planJson(files::planFrom(written, "plan.json")) != written) std::abort();
  } catch (const files::FileError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  const std::string text(bytes, bytes + size);
  readAndWrite(text);
  readAndWrite(goodPlan(text));
  return 0;
}
