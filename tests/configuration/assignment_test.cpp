// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/configuration/assignment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "configuration/test_options.h"
#include "support/temporary_folder.h"

namespace eyeslam::configuration {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class Yaml : public ::testing::Test {
 protected:
  CameraOptions read(const std::string& text)
  {
    const std::string path = folder_.path("camera.yaml");
    std::ofstream(path) << text;
    return applied(CameraOptions{}, readYaml(path));
  }

  // The message, which must be one line that names the file.
  std::string refusal(const std::string& text)
  {
    try {
      read(text);
    } catch (const ConfigurationError& error) {
      EXPECT_THAT(error.what(), HasSubstr("camera.yaml"));
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.what();
    }
    return "accepted";
  }

  support::TemporaryFolder folder_;
};

TEST_F(Yaml, SetsWhatItNamesAndNothingElse)
{
  const CameraOptions options = read("lens:\n  turns: 7\n  coated: false\nkind: grey\n");
  EXPECT_EQ(options.lens.turns, 7);
  EXPECT_FALSE(options.lens.coated);
  EXPECT_EQ(options.kind, "grey");
  EXPECT_EQ(options.lens.focus_mm, 12.5);
}

TEST_F(Yaml, ReadsNumbersAsPeopleWriteThem)
{
  EXPECT_EQ(read("lens: {turns: 010}").lens.turns, 10);  // not octal
  EXPECT_EQ(read("gain: 1e-3").gain, 1e-3);
  EXPECT_EQ(read("gain: -4").gain, -4.0);
}

TEST_F(Yaml, ChangesNothingWhenEmptyOrAllComments)
{
  EXPECT_EQ(read("").lens.turns, 3);
  EXPECT_EQ(read("# nothing yet\n").lens.turns, 3);
}

// All that is said of a text: keys, values and lines, or what is wrong with it.
template <class Read>
std::string said(const Read& read)
{
  std::string text;
  try {
    for (const Assignment& assignment : read()) {
      text += assignment.key + "=" + assignment.text + " (" + assignment.origin + ")\n";
    }
  } catch (const ConfigurationError& error) {
    text = error.what();
  }
  return text;
}

TEST_F(Yaml, IsTheSameFromATextAsFromAFile)
{
  const std::string path = folder_.path("camera.yaml");
  for (const YamlLists lists : {YamlLists::refused, YamlLists::joined}) {
    for (const char* text : {"", "# nothing\n", "gain: 3", "lens:\n  turns: 7\n  coated: false\nkind: grey\n",
                             "kind: [grey, colour]\n", "kind: [[[1, 2], [3]], [[4]]]", "gain: 1\ngain: 2\n", "gain: {",
                             "a: 1\n---\nb: 2\n", "- 1\n- 2\n", "x: \"a \\\"b\\\" \\\\ c\"\n", "gain:\n"}) {
      std::ofstream(path) << text;
      EXPECT_EQ(said([&] { return parseYaml(path, text, lists); }), said([&] { return readYaml(path, lists); }))
          << text;
    }
  }
  EXPECT_EQ(said([] { return parseYaml("MARK", "lens:\n  turns: 7"); }), "lens.turns=7 (MARK:2)\n");
}

TEST_F(Yaml, RefusesAnUnknownKeyAndNamesTheNearest)
{
  EXPECT_THAT(refusal("lens:\n  truns: 1\n"),
              AllOf(HasSubstr(":2:"), HasSubstr("lens.truns"), HasSubstr("lens.turns")));
  EXPECT_THAT(refusal("lens: 3\n"), HasSubstr("'lens' is unknown"));
}

TEST_F(Yaml, RefusesAKeyThatStandsTwice)
{
  EXPECT_THAT(refusal("gain: 1\nkind: grey\ngain: 2\n"), AllOf(HasSubstr(":3:"), HasSubstr("'gain' stands twice")));
  EXPECT_THAT(refusal("lens: {turns: 1}\nlens: {coated: true}\n"), HasSubstr("'lens' stands twice"));
  EXPECT_THAT(refusal("lens.turns: 1\nlens: {turns: 2}\n"), HasSubstr("'lens.turns' stands twice"));
}

TEST_F(Yaml, RefusesTheWrongTypeAndSaysTheRightOne)
{
  EXPECT_THAT(refusal("lens: {turns: many}"), HasSubstr("a whole number in [0, 10]"));
  EXPECT_THAT(refusal("lens: {turns: 1.5}"), HasSubstr("a whole number"));
  EXPECT_THAT(refusal("lens: {turns: 1e3}"), HasSubstr("a whole number"));
  EXPECT_THAT(refusal("lens: {coated: 1}"), HasSubstr("true or false"));
  EXPECT_THAT(refusal("kind: sepia"), HasSubstr("one of colour, grey"));
  EXPECT_THAT(refusal("gain: [1, 2]"), HasSubstr("has a list"));
  EXPECT_THAT(refusal("gain:"), HasSubstr("has no value"));
}

TEST_F(Yaml, RefusesWhatIsNotFiniteOrOutOfRange)
{
  for (const char* value : {".nan", "nan", ".inf", "inf", "-inf", "1e999"}) {
    EXPECT_THAT(refusal(std::string("gain: ") + value), HasSubstr("is not a number")) << value;
  }
  EXPECT_THAT(refusal("lens: {focus_mm: 100.5}"), HasSubstr("[1, 100]"));
  EXPECT_THAT(refusal("lens: {turns: -1}"), HasSubstr("[0, 10]"));
}

TEST_F(Yaml, RefusesWhatIsNoYamlOrNoMap)
{
  EXPECT_THAT(refusal("lens: {turns: 1"), HasSubstr("is no YAML"));
  EXPECT_THAT(refusal("- 1\n- 2\n"), HasSubstr("key: value"));
  EXPECT_THAT(refusal("gain: 1\n---\ngain: 2\n"), HasSubstr("several"));
  EXPECT_THAT(refusal("a: &a {b: *a}"), ::testing::Not("accepted"));  // an alias inside its own anchor
}

TEST_F(Yaml, RefusesAFileThatIsNotThere)
{
  EXPECT_THROW(readYaml(folder_.path("gone.yaml")), ConfigurationError);
  EXPECT_THROW(readYaml(folder_.path("")), ConfigurationError);  // a folder
}

TEST(Setting, SplitsAtTheFirstEqualsSign)
{
  const Assignment assignment = parseSetting("kind=a=b");
  EXPECT_EQ(assignment.key, "kind");
  EXPECT_EQ(assignment.text, "a=b");
  EXPECT_THROW(parseSetting("kind"), ConfigurationError);
  EXPECT_THROW(parseSetting("=3"), ConfigurationError);
}

TEST(Assign, LetsLaterAssignmentsWin)
{
  const CameraOptions options = applied(CameraOptions{}, {{"gain", "1", "a"}, {"gain", "2", "b"}});
  EXPECT_EQ(options.gain, 2.0);
}

TEST(Assign, ChangesNothingWhenAnyAssignmentIsWrong)
{
  CameraOptions options;
  EXPECT_THROW(options = applied(options, {{"gain", "5", "--set"}, {"lens.turns", "x", "--set"}}), ConfigurationError);
  EXPECT_EQ(options.gain, 0.1);
}

}  // namespace
}  // namespace eyeslam::configuration
