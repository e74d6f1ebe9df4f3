// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/evaluation/error_histogram.h"

#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace vdbmap::registration {
namespace {

std::size_t total(const ErrorHistogram& histogram) {
  return std::accumulate(histogram.counts.begin(), histogram.counts.end(), std::size_t{0}) + histogram.num_below +
         histogram.num_above;
}

TEST(ErrorHistogram, CountsEachValueInItsBin) {
  std::mt19937 random(1);
  std::normal_distribution<double> error(0.003, 0.01);
  std::vector<double> values(500);
  for (double& value : values) value = error(random);
  const ErrorHistogram histogram = histogram_of(values);

  EXPECT_EQ(total(histogram), 500U);
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    const double low = histogram.first + histogram.width * static_cast<double>(i);
    const auto count = std::count_if(values.begin(), values.end(),
                                     [&](double value) { return value >= low && value < low + histogram.width; });
    EXPECT_EQ(histogram.counts[i], static_cast<std::size_t>(count)) << low;
  }
}

TEST(ErrorHistogram, FewFarValuesDoNotHideTheOthers) {
  std::vector<double> values;
  for (int i = 0; i < 99; ++i) values.push_back(0.0001 * i);
  values.push_back(55);
  values.push_back(-70);
  const ErrorHistogram histogram = histogram_of(values);

  EXPECT_LE(histogram.last(), 0.05);
  EXPECT_EQ(histogram.num_above, 1U);
  EXPECT_EQ(histogram.num_below, 1U);
  EXPECT_EQ(total(histogram), 101U);
}

TEST(ErrorHistogram, HasAnAxisForAnyNumberOfValues) {
  for (const std::vector<double>& values :
       {std::vector<double>{}, {0.0}, {0.0, 0.0, 0.0}, {1e-17, -1e-17}, {3.0}, {-3.0}, {1e7, 2e7}}) {
    const ErrorHistogram histogram = histogram_of(values);
    EXPECT_GT(histogram.width, 0);
    EXPECT_GE(histogram.counts.size(), 1U);
    EXPECT_LE(histogram.counts.size(), 20U);
    EXPECT_EQ(total(histogram), values.size());
    EXPECT_EQ(histogram.num_above + histogram.num_below, 0U);
  }
}

}  // namespace
}  // namespace vdbmap::registration
