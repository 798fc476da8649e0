// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/video_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "eyeslam/files/video_file.h"
#include "support/temporary_folder.h"

namespace eyeslam::files {
namespace {

using ::testing::HasSubstr;

// Its brightness tells the frame's number, in steps that compression keeps; it begins again after kPictures.
constexpr int kPictures = 20;
cv::Mat picture(int number, cv::Size size = {96, 64})
{
  const int level = 8 * (number % kPictures);
  return {size, CV_8UC3, cv::Scalar(10 + level, 20 + level, 60 + level)};
}

int numberOf(const cv::Mat& image) { return cvRound((cv::mean(image)[1] - 20.0) / 8.0); }

class Source : public ::testing::Test {
 protected:
  std::string video(const std::string& name, int count, VideoCoding coding)
  {
    VideoFile file(folder_.path(name), name, coding, 25.0);
    for (int i = 0; i < count; ++i) file.add(picture(i));
    file.close();
    return folder_.path(name);
  }
  std::string images(int count)
  {
    for (int i = 0; i < count; ++i) cv::imwrite(folder_.path("im" + std::to_string(i) + ".png"), picture(i));
    return folder_.path("");
  }
  static std::vector<int> numbersRead(VideoSource& source)
  {
    std::vector<int> numbers;
    VideoFrame frame;
    while (source.read(frame)) {
      EXPECT_EQ(frame.number % kPictures, numberOf(frame.image));
      EXPECT_NEAR(frame.t, static_cast<double>(frame.number) / source.framesPerSecond(), 2e-3);
      numbers.push_back(static_cast<int>(frame.number));
    }
    return numbers;
  }
  static VideoSourceOptions upTo(std::int64_t last)
  {
    VideoSourceOptions options;
    options.last_frame = last;
    return options;
  }

  support::TemporaryFolder folder_;
};

TEST_F(Source, SaysAfterEachImageHowFarTheCheckOfAFolderIs)
{
  VideoSourceOptions options;
  std::vector<std::int64_t> checked;
  options.checking = [&](std::int64_t count, std::int64_t all) {
    EXPECT_EQ(all, 5);
    checked.push_back(count);
    return true;
  };
  EXPECT_EQ(numbersRead(*openVideoSource(images(5), options)).size(), 5U);
  EXPECT_EQ(checked, (std::vector<std::int64_t>{1, 2, 3, 4, 5}));
}

TEST_F(Source, EndsTheCheckOfAFolderWhenAsked)
{
  VideoSourceOptions options;
  options.checking = [](std::int64_t count, std::int64_t) { return count < 2; };
  const std::string folder = images(5);
  try {
    openVideoSource(folder, options);
    FAIL() << "was not ended";
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("2 of 5"));
  }
}

TEST_F(Source, ReadsEveryFrameOfAVideoWithItsNumberAndTime)
{
  for (const auto& [name, coding] : {std::pair{"a.mp4", VideoCoding::h264}, {"a.mkv", VideoCoding::lossless}}) {
    const auto source = openVideoSource(video(name, 20, coding), {});
    EXPECT_EQ(numbersRead(*source).size(), 20U) << name;
    EXPECT_TRUE(source->notices().empty()) << name;
  }
}

TEST_F(Source, StartsAndEndsWhereItIsTold)
{
  const std::string mp4 = video("a.mp4", 20, VideoCoding::h264);
  for (const std::string& input : {mp4, images(20)}) {
    const auto source = openVideoSource(input, upTo(8));
    source->skipTo(5);
    EXPECT_THAT(numbersRead(*source), ::testing::ElementsAre(5, 6, 7, 8));
  }
}

TEST_F(Source, ReportsAVideoThatEndsBeforeItsAnnouncedCount)
{
  const std::string path = video("a.mp4", 60, VideoCoding::h264);
  std::FILE* const file = std::fopen(path.c_str(), "r+b");
  ASSERT_NE(file, nullptr);
  const auto size = static_cast<long>(std::filesystem::file_size(path));
  std::fseek(file, size / 4, SEEK_SET);
  const std::vector<char> junk(static_cast<std::size_t>(size) / 8, '\x5a');
  std::fwrite(junk.data(), 1, junk.size(), file);
  std::fclose(file);
  try {
    numbersRead(*openVideoSource(path, {}));
    FAIL() << "the damage went unnoticed";
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("60 frames announced"));
  }
}

TEST_F(Source, KeepsSixteenBits)
{
  cv::Mat deep(40, 50, CV_16UC1, cv::Scalar(40000));
  cv::imwrite(folder_.path("a.png"), deep);
  const auto source = openVideoSource(folder_.path("a.png"), {});
  VideoFrame frame;
  ASSERT_TRUE(source->read(frame));
  EXPECT_EQ(frame.image.type(), CV_16UC1);
  EXPECT_EQ(frame.image.at<std::uint16_t>(3, 4), 40000);
}

TEST_F(Source, TakesColourImagesWithoutColourAsGrey)
{
  cv::imwrite(folder_.path("a.png"), cv::Mat(40, 50, CV_8UC3, cv::Scalar(80, 80, 80)));
  const auto source = openVideoSource(folder_.path("a.png"), {});
  VideoFrame frame;
  ASSERT_TRUE(source->read(frame));
  EXPECT_EQ(frame.image.type(), CV_8UC1);
  EXPECT_EQ(source->notices().size(), 1U);
}

TEST_F(Source, JudgesColourByTheImagesThatAreNotDark)
{
  cv::imwrite(folder_.path("a.png"), cv::Mat(40, 50, CV_8UC3, cv::Scalar(0, 0, 0)));
  EXPECT_TRUE(openVideoSource(folder_.path("a.png"), {})->notices().empty());
  cv::imwrite(folder_.path("b.png"), cv::Mat(40, 50, CV_8UC3, cv::Scalar(80, 80, 80)));
  EXPECT_EQ(openVideoSource(folder_.path(""), {})->notices().size(), 1U);
}

TEST_F(Source, FindsABadImageBeforeTheFirstFrame)
{
  images(3);
  std::filesystem::resize_file(folder_.path("im2.png"), 100);
  EXPECT_THROW(openVideoSource(folder_.path(""), {}), FileError);
  EXPECT_NO_THROW(openVideoSource(folder_.path(""), upTo(1)));
  cv::imwrite(folder_.path("im2.png"), picture(2, {90, 64}));
  EXPECT_THROW(openVideoSource(folder_.path(""), {}), FileError);
}

TEST_F(Source, RefusesInputByItsName)
{
  for (const char* input : {"gone.mp4", "camera:x", "camera:-1", "camera:97", "shm:eye", "gone*.png"}) {
    try {
      openVideoSource(input, {});
      FAIL() << input;
    } catch (const FileError& error) {
      EXPECT_THAT(error.what(), HasSubstr(input));
    }
  }
}

TEST_F(Source, LosslessVideoGivesBackEveryBit)
{
  cv::Mat noise(64, 96, CV_8UC3);
  cv::randu(noise, 0, 255);
  VideoFile file(folder_.path("a.mkv"), "a.mkv", VideoCoding::lossless, 30.0);
  file.add(noise);
  file.close();
  VideoFrame frame;
  ASSERT_TRUE(openVideoSource(folder_.path("a.mkv"), {})->read(frame));
  EXPECT_EQ(cv::norm(frame.image, noise, cv::NORM_INF), 0.0);
}

TEST_F(Source, VideoFileRefusesAFrameUnlikeTheFirst)
{
  VideoFile file(folder_.path("a.mp4"), "a.mp4", VideoCoding::h264, 30.0);
  file.add(picture(0));
  EXPECT_THROW(file.add(picture(1, {48, 32})), FileError);
}

TEST_F(Source, VideoFileThatCannotBeWrittenSaysSo)
{
  VideoFile file(folder_.path("gone/a.mp4"), "a.mp4", VideoCoding::h264, 30.0);
  EXPECT_THROW(file.add(picture(0)), FileError);
}

}  // namespace
}  // namespace eyeslam::files
