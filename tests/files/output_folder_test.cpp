// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/output_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/partial_file.h"
#include "support/temporary_folder.h"

namespace eyeslam::files {
namespace {

namespace fs = std::filesystem;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

class Output : public ::testing::Test {
 protected:
  static std::vector<std::string> namesIn(const std::string& folder)
  {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
    return names;
  }
  static std::string textOf(const std::string& path)
  {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void publish(const std::string& text, std::initializer_list<const char*> names)
  {
    OutputFolder folder(out_, {"run.json", "old.csv", "map"});
    for (const char* name : names) folder.write(name, text);
    folder.publish();
  }

  support::TemporaryFolder temporary_;
  std::string out_ = temporary_.path("out");
};

TEST_F(Output, IsNotThereBeforeItIsPublished)
{
  OutputFolder folder(out_, {});
  folder.write("run.json", "1");
  EXPECT_FALSE(fs::exists(out_));
  folder.publish();
  EXPECT_THAT(namesIn(out_), UnorderedElementsAre("run.json"));
  EXPECT_THAT(namesIn(temporary_.path("")), UnorderedElementsAre("out"));
}

TEST_F(Output, LeavesNothingWhenItIsNeverPublished)
{
  {
    OutputFolder folder(temporary_.path("a/b/out"), {});
    folder.write("map/a.json", "1");
  }
  EXPECT_THAT(namesIn(temporary_.path("")), IsEmpty());
}

TEST_F(Output, LeavesAnEarlierResultWhenItIsNeverPublished)
{
  publish("first", {"run.json", "map/a.json"});
  {
    OutputFolder folder(out_, {"run.json", "map"});
    folder.write("run.json", "second");
  }
  EXPECT_EQ(textOf(out_ + "/run.json"), "first");
  EXPECT_THAT(namesIn(out_), UnorderedElementsAre("run.json", "map"));
}

TEST_F(Output, ReplacesItsOwnFilesAndKeepsOthers)
{
  publish("first", {"run.json", "old.csv", "map/a.json"});
  std::ofstream(out_ + "/notes.txt") << "mine";
  publish("second", {"run.json", "map/b.json"});
  EXPECT_THAT(namesIn(out_), UnorderedElementsAre("run.json", "map", "notes.txt"));
  EXPECT_THAT(namesIn(out_ + "/map"), UnorderedElementsAre("b.json"));
  EXPECT_EQ(textOf(out_ + "/run.json"), "second");
}

TEST_F(Output, TakesATrailingSlashForNothing)
{
  for (const char* ending : {"/", "//", "/.", "/./"}) {
    fs::remove_all(temporary_.path("out"));
    out_ = temporary_.path("out") + ending;
    publish("1", {"run.json"});
    EXPECT_THAT(namesIn(temporary_.path("")), UnorderedElementsAre("out")) << ending;
    EXPECT_THAT(namesIn(temporary_.path("out")), UnorderedElementsAre("run.json")) << ending;
  }
}

TEST_F(Output, SweepsUpAfterAKilledRun)
{
  constexpr const char* kNobody = "4194305";  // above Linux's largest process number
  fs::create_directory(temporary_.path(std::string(".out.partial-") + kNobody));
  publish("1", {"run.json"});
  EXPECT_THAT(namesIn(temporary_.path("")), UnorderedElementsAre("out"));
}

TEST_F(Output, RefusesAFileInItsPlace)
{
  std::ofstream(out_) << "mine";
  EXPECT_THROW(OutputFolder(out_, {}), FileError);
  EXPECT_THROW(OutputFolder(out_ + "/below", {}), FileError);
  EXPECT_EQ(textOf(out_), "mine");
}

TEST_F(Output, NamesTheFinalPlaceOfWhatCannotBeWritten)
{
  const OutputFolder folder(out_, {});
  folder.write("taken", "a file");
  try {
    folder.write("taken/below", "1");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), ::testing::StartsWith(out_ + "/taken/below: "));
  }
}

TEST_F(Output, WritesPicturesThatReadBack)
{
  cv::Mat image(20, 30, CV_8UC3);
  cv::randu(image, 0, 255);
  OutputFolder folder(out_, {});
  folder.writePng("mosaic.png", image);
  folder.publish();
  EXPECT_EQ(cv::norm(cv::imread(out_ + "/mosaic.png"), image, cv::NORM_INF), 0.0);
}

TEST_F(Output, PartialFileAppearsOnlyWhenPublished)
{
  const std::string path = temporary_.path("a.mkv");
  {
    PartialFile file(path);
    std::ofstream(file.partialPath()) << "half";
    EXPECT_EQ(fs::path(file.partialPath()).extension(), ".mkv");
  }
  EXPECT_THAT(namesIn(temporary_.path("")), IsEmpty());
  PartialFile file(path);
  std::ofstream(file.partialPath()) << "whole";
  file.publish();
  EXPECT_THAT(namesIn(temporary_.path("")), UnorderedElementsAre("a.mkv"));
  EXPECT_THROW(PartialFile(temporary_.path("gone/a.mkv")), FileError);
}

}  // namespace
}  // namespace eyeslam::files
