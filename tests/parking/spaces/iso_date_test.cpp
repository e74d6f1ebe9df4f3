// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/spaces/iso_date.h"

#include <gtest/gtest.h>

namespace vdbmap::parking {
namespace {

// Expected numbers by `date -u -d ... +%s`.
TEST(IsoDate, CountsMillisecondsSince1970) {
  EXPECT_EQ(milliseconds_of("2023-03-01"), 1677628800000);
  EXPECT_EQ(milliseconds_of("2023-03-01T10:20"), 1677666000000);
  EXPECT_EQ(milliseconds_of("2023-03-01T10:20:30Z"), 1677666030000);
  EXPECT_EQ(milliseconds_of("2023-03-01T10:20:30+01:00"), 1677662430000);
  EXPECT_EQ(milliseconds_of("1969-12-31"), -86400000);
}

TEST(IsoDate, RefusesWhatIsNoDate) {
  for (const char* text : {"", "2023", "2023-02-30", "2023-3-1", "2023-03-01T", "2023-03-01T25:00", "2023-03-01 10:00",
                           "2023-03-01T10:00:61", "2023-03-01T10:00+1", "yesterday"}) {
    EXPECT_FALSE(milliseconds_of(text)) << text;
  }
}

TEST(IsoDate, WritesWhatItReads) {
  for (const std::int64_t seconds : {std::int64_t{0}, std::int64_t{1677666030}, std::int64_t{951782400}}) {
    EXPECT_EQ(milliseconds_of(date_of_seconds(seconds)), 1000 * seconds);
  }
  EXPECT_EQ(date_of_seconds(1677666030), "2023-03-01T10:20:30Z");
}

}  // namespace
}  // namespace vdbmap::parking
