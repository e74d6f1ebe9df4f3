// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "tests/portable/sample_hash.h"
#include "tests/support/run_command.h"

// Set where there is a program of the same code for plain x86-64.
#ifdef VDBMAP_PLAIN_HASH

namespace vdbmap {
namespace {

TEST(PortableBytes, MapsAreTheSameForProcessorsWithAndWithoutFusedMultiplication) {
  const test::CommandResult plain = test::run_command(VDBMAP_PLAIN_HASH, {});
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  std::string here(17, '\0');
  std::snprintf(here.data(), here.size(), "%016llx", static_cast<unsigned long long>(portable::sample_hash()));
  here.back() = '\n';
  EXPECT_EQ(plain.out, here);
}

}  // namespace
}  // namespace vdbmap

#endif
