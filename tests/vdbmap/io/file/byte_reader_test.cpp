// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/file/byte_reader.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"

namespace vdbmap {
namespace {

using test::io_error_of;

class ByteReaderTest : public testing::Test {
 protected:
  ByteReader open(const std::string& bytes) const { return ByteReader(test::write_raw(folder_ / "scan", bytes)); }

  test::TemporaryFolder folder_;
};

TEST_F(ByteReaderTest, ReadsNumbersOfBothByteOrders) {
  ByteReader reader = open(std::string("\x01\x02\x01\x02\xff\x00\x00\x80\x3f\x3f\x80\x00\x00", 13));
  EXPECT_EQ(reader.read_le<std::uint16_t>(), 0x0201);
  EXPECT_EQ(reader.read_be<std::uint16_t>(), 0x0102);
  EXPECT_EQ(reader.read_le<std::int8_t>(), -1);
  EXPECT_EQ(reader.read_le<float>(), 1.0f);
  EXPECT_EQ(reader.read_be<float>(), 1.0f);
  EXPECT_EQ(reader.remaining(), 0u);
}

TEST_F(ByteReaderTest, NeverLeavesTheFile) {
  ByteReader reader = open("12345");
  reader.skip(2);
  const std::string message = "scan: byte 2: the file ends too early: expected 4 more bytes, found 3";
  EXPECT_EQ(io_error_of([&] { reader.read_le<std::uint32_t>(); }), message);
  EXPECT_NE(io_error_of([&] { reader.skip(~std::uint64_t{0}); }), "no error");
  EXPECT_NE(io_error_of([&] { reader.seek(6); }), "no error");
  EXPECT_EQ(reader.bytes(3), "345") << "a failed read moves nothing";
  EXPECT_EQ(io_error_of([&] { reader.bytes(0); }), "no error");
}

TEST_F(ByteReaderTest, ReadsLinesOfBothKindsAndCountsThem) {
  ByteReader reader = open("one\r\n\ntwo");
  EXPECT_EQ(reader.read_line(), "one");
  EXPECT_EQ(reader.read_line(), "");
  EXPECT_EQ(reader.read_line(), "two");
  EXPECT_EQ(reader.line(), 3u);
  EXPECT_EQ(io_error_of([&] { reader.fail_line("wrong"); }), "scan:3: wrong");
  EXPECT_EQ(io_error_of([&] { reader.read_line(); }), "scan: byte 9: the file ends too early: expected another line");
}

TEST_F(ByteReaderTest, ReadsTheFrontOfAFile) {
  const auto path = test::write_raw(folder_ / "scan", "12345");
  EXPECT_EQ(read_front(path, 3), "123");
  EXPECT_EQ(read_front(path, 9), "12345");
}

TEST_F(ByteReaderTest, RefusesWhatIsNotAFile) {
  EXPECT_EQ(io_error_of([&] { ByteReader(folder_ / "missing"); }), "missing: cannot open: No such file or directory");
  EXPECT_NE(io_error_of([&] { ByteReader(folder_.path()); }).find("Is a directory"), std::string::npos);
  EXPECT_EQ(io_error_of([&] { ByteReader("/dev/zero"); }), "zero: not a regular file");
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(io_error_of([&] { ByteReader(folder_ / "pipe"); }), "pipe: not a regular file");
}

}  // namespace
}  // namespace vdbmap
