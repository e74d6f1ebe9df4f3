// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/image.h"

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/picture.h"
#include "tests/support/raw_files.h"
#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

Image gradient(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.at(x, y) = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), static_cast<std::uint8_t>(x ^ y)};
    }
  }
  return image;
}

TEST(Image, OtherProgramsReadItsPngPixelForPixel) {
  const test::TemporaryFolder folder;
  for (const auto& [width, height] : {std::pair{256, 200}, {1, 1}, {1, 300}, {301, 1}}) {
    const Image image = gradient(width, height);
    write_png(folder / "picture.png", image);
    const Image reread = test::read_picture(folder / "picture.png");

    ASSERT_EQ(reread.width(), width);
    ASSERT_EQ(reread.height(), height);
    EXPECT_TRUE(std::equal(image.pixels().begin(), image.pixels().end(), reread.pixels().begin()));
  }
}

// Width and height in the frame header of a JPEG file (ITU T.81, B.2.2), after its segments before that.
std::pair<int, int> size_of_jpeg(const std::string& bytes) {
  const auto number = [&](std::size_t at) {
    return static_cast<unsigned char>(bytes.at(at)) << 8 | static_cast<unsigned char>(bytes.at(at + 1));
  };
  std::size_t at = 2;
  while (number(at) < 0xffc0 || number(at) > 0xffc2) at += 2 + static_cast<std::size_t>(number(at + 2));
  return {number(at + 7), number(at + 5)};
}

TEST(Image, IsWrittenInTheFormatOfTheEnding) {
  const test::TemporaryFolder folder;
  const Image image = gradient(40, 30);
  for (const char* name : {"a.jpg", "a.JPEG"}) {
    write_picture(folder / name, image);
    const std::string bytes = test::read_raw(folder / name);
    EXPECT_TRUE(bytes.starts_with("\xff\xd8\xff") && bytes.ends_with("\xff\xd9")) << name;
    EXPECT_EQ(size_of_jpeg(bytes), std::pair(40, 30)) << name;
  }
  for (const char* name : {"a.png", "a", "a.old"}) {
    write_picture(folder / name, image);
    EXPECT_EQ(test::read_raw(folder / name), png_of(image)) << name;
  }
}

TEST(Image, SamePixelsGiveTheSameBytes) { EXPECT_EQ(png_of(gradient(64, 48)), png_of(gradient(64, 48))); }

TEST(Image, SizesThatCannotBeDrawnAreRefused) {
  for (const auto& [width, height] : {std::pair{0, 10}, {10, 0}, {-1, 10}, {100'000, 10}, {10, kMaxImageSize + 1}}) {
    EXPECT_THROW(Image(width, height), std::invalid_argument) << width << " x " << height;
  }
}

TEST(Image, BlendingIsAMeanWeightedByCoverage) {
  Image image(1, 1, {100, 0, 255});
  image.blend(0, 0, {200, 255, 255}, 0.25);
  EXPECT_EQ(image.at(0, 0), (Rgb8{125, 64, 255}));
  image.blend(0, 0, {7, 8, 9}, 1);
  EXPECT_EQ(image.at(0, 0), (Rgb8{7, 8, 9}));
}

TEST(Image, BlendingOutsideAndWithoutCoverageChangesNothing) {
  Image image = gradient(4, 4);
  for (const auto& [x, y] : {std::pair{-1, 0}, {0, -1}, {4, 0}, {0, 4}}) image.blend(x, y, {9, 9, 9}, 1);
  for (const double coverage : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    image.blend(1, 1, {9, 9, 9}, coverage);
  }
  EXPECT_EQ(png_of(image), png_of(gradient(4, 4)));
}

TEST(Image, AFolderThatIsNotThereIsASystemError) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(write_png(folder / "missing" / "picture.png", Image(1, 1)), IoError);
}

}  // namespace
}  // namespace vdbmap
