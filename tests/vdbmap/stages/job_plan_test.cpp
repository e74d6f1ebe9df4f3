// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/stages/job_plan.h"

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/raw_files.h"
#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

// Every field other than by default.
JobPlan full_plan() {
  JobPlan plan;
  plan.city = "/maps/city";
  plan.adds = true;
  plan.city_state = "0123456789abcdef0123456789abcdef";
  plan.files.build.voxel_sizes = {0.05, 0.5, 1};
  plan.files.build.anchor = Eigen::Vector3d(548864, 5804032, -64);
  plan.files.build.epsg = 25832;
  plan.files.build.epoch = 7;
  plan.files.inputs.label_scheme = LabelScheme::kSemanticKitti;
  plan.files.inputs.dropped_classes = {"person", "bicyclist"};
  plan.files.inputs.read = {true,
                            false,
                            parse_sensor_choice("192.168.1.201:2368"),
                            {"x", "y", "z", "-"},
                            {"x", "y", "z", "ring"},
                            ScalarType::kFloat64};
  plan.files.inputs.range = RangeLimits{2.5, std::numeric_limits<double>::infinity()};
  plan.save.density = 0.1F;
  plan.keep_epochs = 4;
  plan.keeps_parts = true;
  plan.num_buckets = 12;
  MapInput scan{{"/scans/3.bin", std::nullopt}};
  scan.map_from_scan = Eigen::Isometry3d(Eigen::AngleAxisd(0.1, Eigen::Vector3d(1, 2, 3).normalized()));
  scan.map_from_scan->translation() = Eigen::Vector3d(1.0 / 3, 5e6 + 0.1, -7);
  scan.labels = "/labels/3.label";
  plan.sources = {{{{"/scans/a.pcap", 12}}, 1'000'000'000'000}, {scan, 5}};
  plan.left_out = {{"b.las", "b.las: is damaged"}};
  return plan;
}

TEST(JobPlan, ComesBackAsItWas) {
  const JobPlan plan = full_plan();
  const std::string text = text_of(plan);
  const JobPlan back = parse_job_plan(text, "job.json");
  EXPECT_EQ(text_of(back), text);
  EXPECT_EQ(back.city, plan.city);
  EXPECT_TRUE(back.adds);
  EXPECT_EQ(back.files.build.voxel_sizes, plan.files.build.voxel_sizes);
  EXPECT_EQ(back.files.build.anchor, plan.files.build.anchor);
  EXPECT_EQ(back.files.build.epoch, 7);
  EXPECT_EQ(back.files.inputs.label_scheme, LabelScheme::kSemanticKitti);
  EXPECT_EQ(back.files.inputs.dropped_classes, plan.files.inputs.dropped_classes);
  EXPECT_EQ(back.files.inputs.read.sensor, plan.files.inputs.read.sensor);
  EXPECT_EQ(back.files.inputs.read.columns, plan.files.inputs.read.columns);
  EXPECT_EQ(back.files.inputs.read.bin_type, ScalarType::kFloat64);
  EXPECT_EQ(back.files.inputs.range->min, 2.5);
  EXPECT_EQ(back.files.inputs.range->max, std::numeric_limits<double>::infinity());
  EXPECT_EQ(back.save.density, 0.1F);
  EXPECT_TRUE(back.keeps_parts);
  EXPECT_EQ(back.sources[0].input.scan, plan.sources[0].input.scan);
  EXPECT_EQ(back.sources[0].num_bytes, 1'000'000'000'000U);
  // Bit for bit: sums count in steps of 1.5 um.
  EXPECT_EQ(back.sources[1].input.map_from_scan->matrix(), plan.sources[1].input.map_from_scan->matrix());
  EXPECT_EQ(back.sources[1].input.labels, plan.sources[1].input.labels);
  EXPECT_EQ(back.left_out, plan.left_out);
}

TEST(JobPlan, ACutTextIsRefused) {
  const std::string text = text_of(full_plan());
  for (std::size_t size = 0; size + 2 < text.size(); ++size) {
    EXPECT_THROW(parse_job_plan(text.substr(0, size), "job.json"), IoError) << size;
  }
}

TEST(JobPlan, WhatCannotBeIsRefusedWithItsPlace) {
  const auto error_with = [](const std::string& old_part, const std::string& new_part) {
    std::string text = text_of(full_plan());
    const std::size_t at = text.find(old_part);
    EXPECT_NE(at, std::string::npos) << old_part;
    return test::io_error_of([&] { parse_job_plan(text.replace(at, old_part.size(), new_part), "job.json"); });
  };
  EXPECT_EQ(error_with("\"version\": 2", "\"version\": 3"),
            "job.json: version is 3, newer than the 2 that this program knows");
  EXPECT_EQ(error_with("vdbmap job", "vdbmap city"), "job.json: format is not 'vdbmap job'");
  EXPECT_EQ(error_with("\"buckets\": 12", "\"buckets\": 0"), "job.json: buckets is 0");
  EXPECT_EQ(error_with("\"bytes\":5", "\"bytes\":-5"), "job.json: sources[1].bytes is no whole number from 0 on");
  EXPECT_EQ(error_with("\"semantickitti\"", "\"ours\""), "job.json: label_scheme is not known");
  EXPECT_NE(error_with("548864", "548865").find("job.json: build cannot be: "), std::string::npos);
}

TEST(JobPlan, NamesThatJsonCannotHoldAreRefused) {
  JobPlan plan = full_plan();
  plan.sources[0].input.scan.file = "/scans/\xff.las";
  EXPECT_THROW(text_of(plan), std::invalid_argument);
}

TEST(JobPlan, BucketsAreOfLikeSize) {
  constexpr std::size_t kBuckets = 16;
  constexpr std::int32_t kEdge = 64;
  std::vector<int> counts(kBuckets, 0);
  for (std::int32_t x = -kEdge / 2; x < kEdge / 2; ++x) {
    for (std::int32_t y = -kEdge / 2; y < kEdge / 2; ++y) ++counts[bucket_of({x, y}, kBuckets)];
  }
  // 256 expected in each; five standard deviations of a fair draw are 78.
  for (const int count : counts) EXPECT_NEAR(count, 256, 78);
}

}  // namespace
}  // namespace vdbmap
