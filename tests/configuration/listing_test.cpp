// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/configuration/listing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <rapidcheck/gtest.h>
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>

#include "configuration/test_options.h"
#include "eyeslam/configuration/assignment.h"
#include "support/temporary_folder.h"

namespace eyeslam::configuration {
namespace {

using ::testing::HasSubstr;

CameraOptions readBack(const std::string& yaml)
{
  const support::TemporaryFolder folder;
  std::ofstream(folder.path("dump.yaml")) << yaml;
  return applied(CameraOptions{}, readYaml(folder.path("dump.yaml")));
}

RC_GTEST_PROP(Listing, YamlReadsBackToTheSameValues, (double gain, int turns, bool coated))
{
  CameraOptions options;
  options.gain = gain;
  options.lens.turns = std::abs(turns % 11);
  options.lens.coated = coated;
  RC_ASSERT(canonicalOf(readBack(yamlOf(options))) == canonicalOf(options));
}

/// What no YAML says by itself: a text that any quote or backslash may stand in.
struct NoteOptions {
  std::string note = "none";
  CameraOptions camera;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    visitor.field("note", self.note, retina::Range{}, "", "of who set it; source: the user");
    visitor.group("camera", self.camera);
  }
};

RC_GTEST_PROP(Listing, YamlWithoutCommentsReadsBackToTheSameValues, (double gain, int turns))
{
  NoteOptions options;
  options.camera.gain = gain;
  options.camera.lens.turns = std::abs(turns % 11);
  options.note = *rc::gen::container<std::string>(rc::gen::elementOf(std::string("ab \n\r\t\"'\\:#,[]{}&*!|>%@`-?=.")));
  const std::string yaml = yamlOf(options, YamlComments::left_out);
  RC_ASSERT(canonicalOf(applied(NoteOptions{}, parseYaml("text", yaml))) == canonicalOf(options));
  // No comment but what stands within a text.
  RC_ASSERT(std::count(yaml.begin(), yaml.end(), '#') == std::count(options.note.begin(), options.note.end(), '#'));
}

TEST(Listing, YamlQuotesQuotesAndBackslashes)
{
  NoteOptions options;
  options.note = R"(a "b" c:\d\n # e)";
  EXPECT_THAT(yamlOf(options, YamlComments::left_out), HasSubstr("note: \"a \\\"b\\\" c:\\\\d\\\\n # e\"\n"));
  EXPECT_EQ(applied(NoteOptions{}, parseYaml("text", yamlOf(options))).note, options.note);
}

TEST(Listing, YamlTellsMeaningUnitAndRange)
{
  const std::string yaml = yamlOf(CameraOptions{});
  EXPECT_THAT(
      yaml, HasSubstr("lens:\n  # how far it sees; source: the maker\n  focus_mm: 12.5  # a number in [1, 100]; mm\n"));
  EXPECT_THAT(yaml, HasSubstr("\ngain: 0.1"));  // back outside the group
}

TEST(Listing, MarkdownHasARowForEachOption)
{
  const std::string text = markdownOf(CameraOptions{});
  EXPECT_THAT(text, HasSubstr("| `lens.turns` | 3 | a whole number in [0, 10] | of the ring; source: counted |"));
  EXPECT_THAT(text, HasSubstr("glare \\| haze"));
}

TEST(Listing, CanonicalFormIsSortedAndComplete)
{
  EXPECT_EQ(canonicalOf(CameraOptions{}),
            "gain=0.1\nkind=colour\nlens.coated=true\nlens.focus_mm=12.5\nlens.turns=3\n");
}

// printf 'gain=0.1\nkind=colour\nlens.coated=true\nlens.focus_mm=12.5\nlens.turns=3\n' | sha256sum
TEST(Listing, HashIsThatOfTheCanonicalForm)
{
  EXPECT_EQ(hashOf(CameraOptions{}), "8bdce0506814489c715b9ec25233a5414b2d21f675f7c477771c1e9b47513d5c");
}

TEST(Listing, HashChangesWithEachOption)
{
  const std::string before = hashOf(CameraOptions{});
  for (const auto& [key, text] : {std::pair{"kind", "grey"},
                                  {"lens.focus_mm", "13"},
                                  {"lens.turns", "4"},
                                  {"lens.coated", "false"},
                                  {"gain", "0.10000000000000002"}}) {
    EXPECT_NE(hashOf(applied(CameraOptions{}, {{key, text, "test"}})), before) << key;
  }
}

}  // namespace
}  // namespace eyeslam::configuration
