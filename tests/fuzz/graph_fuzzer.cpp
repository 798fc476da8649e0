// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as a graph.json: a FileError, or a graph that is written and read back as it is.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/graph_file.h"

using namespace eyeslam;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  try {
    const files::RecordedGraph graph = files::graphFrom(std::string(bytes, bytes + size), "fuzz.json");
    const std::string text = files::graphJson(graph);
    if (files::graphJson(files::graphFrom(text, "again.json")) != text) std::abort();
  } catch (const files::FileError&) {
  }
  return 0;
}
