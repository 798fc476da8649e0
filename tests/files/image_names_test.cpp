// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/image_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <rapidcheck/gtest.h>
#include <algorithm>
#include <filesystem>
#include <fstream>

#include "eyeslam/files/file_error.h"
#include "support/temporary_folder.h"

namespace eyeslam::files {
namespace {

using ::testing::ElementsAre;

class ImageNames : public ::testing::Test {
 protected:
  void make(std::initializer_list<const char*> names)
  {
    for (const char* name : names) std::ofstream(folder_.path(name)) << "x";
  }
  std::vector<std::string> found(const std::string& what)
  {
    std::vector<std::string> names = imagesOf(what);
    for (std::string& name : names) name = std::filesystem::path(name).filename().string();
    return names;
  }
  support::TemporaryFolder folder_;
};

TEST_F(ImageNames, ComeInTheOrderOfTheirNumbers)
{
  make({"im10.png", "im9.png", "im1.png", "im009.png", "im2.JPG"});
  EXPECT_THAT(found(folder_.path("")), ElementsAre("im1.png", "im2.JPG", "im009.png", "im9.png", "im10.png"));
}

TEST_F(ImageNames, LeaveOutWhatIsNoImage)
{
  make({"im1.png", "meta.json", "video.mp4", "notes"});
  EXPECT_THAT(found(folder_.path("")), ElementsAre("im1.png"));
}

TEST_F(ImageNames, FollowAGlob)
{
  make({"a1.png", "a2.png", "b1.png", "a3.txt"});
  EXPECT_TRUE(isGlob(folder_.path("a*")));
  EXPECT_THAT(found(folder_.path("a*")), ElementsAre("a1.png", "a2.png"));
}

TEST_F(ImageNames, AreNoGlobWhereAFileIsNamedLikeOne)
{
  make({"a[1].png"});
  EXPECT_FALSE(isGlob(folder_.path("a[1].png")));
}

TEST_F(ImageNames, RefuseAFolderWithoutImages)
{
  make({"notes.txt"});
  EXPECT_THROW(imagesOf(folder_.path("")), FileError);
  EXPECT_THROW(imagesOf(folder_.path("*.png")), FileError);
}

// Sorting needs it, or its result would depend on the order of the folder.
RC_GTEST_PROP(NaturalLess, IsAStrictTotalOrder, ())
{
  const auto name = rc::gen::container<std::string>(rc::gen::elementOf(std::string("ab019")));
  const auto a = *name;
  const auto b = *name;
  const auto c = *name;
  RC_ASSERT(!naturalLess(a, a));
  RC_ASSERT(a == b || naturalLess(a, b) != naturalLess(b, a));
  RC_ASSERT(!(naturalLess(a, b) && naturalLess(b, c)) || naturalLess(a, c));
}

}  // namespace
}  // namespace eyeslam::files
