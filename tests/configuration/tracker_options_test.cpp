// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/tracker_options.h"

#include <gtest/gtest.h>

#include <set>

#include "eyeslam/configuration/field.h"

namespace eyeslam::configuration {
namespace {

std::vector<Field> fields(tracking::TrackerOptions& options) { return fieldsOf(options); }

TEST(TrackerOptions, HaveDefaultsThatTheirOwnRangesAllow)
{
  tracking::TrackerOptions options;
  for (Field& field : fields(options)) EXPECT_EQ(assignText(field, textOf(field)), "") << field.key;
}

TEST(TrackerOptions, HaveKeysOfTheirOwn)
{
  tracking::TrackerOptions options;
  std::set<std::string> keys;
  for (const Field& field : fields(options)) EXPECT_TRUE(keys.insert(field.key).second) << field.key;
}

}  // namespace
}  // namespace eyeslam::configuration
