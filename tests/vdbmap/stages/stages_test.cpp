// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/city_folders.h"
#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/threads.h"
#include "vdbmap/core/error.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/ply/ply.h"
#include "vdbmap/stages/job_run.h"
#include "vdbmap/stages/job_status.h"
#include "vdbmap/stages/plan_stage.h"
#include "vdbmap/stages/reduce_stage.h"
#include "vdbmap/store/city_build.h"
#include "vdbmap/store/city_lock.h"

namespace vdbmap {
namespace {

constexpr std::size_t kBuckets = 5;

// A piece of street, moved along x: pieces overlap, and lie across tiles.
PointCloud piece_at(double x, unsigned seed) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, -20, 5);
  return test::moved(test::sample_scene(test::street(), 6, seed), pose);
}

PointCloud with_all_attributes(PointCloud cloud) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.intensities.push_back(static_cast<float>(i % 200));
    cloud.labels.push_back(static_cast<std::uint16_t>(i % 5));
    cloud.colors.push_back({static_cast<std::uint16_t>(257 * (i % 256)), 257 * 40, 257 * 80});
  }
  return cloud;
}

class StagesTest : public testing::Test {
 protected:
  MapInput file(const std::string& name, const PointCloud& cloud) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    write_ply(folder_ / name, cloud);
    return {{folder_ / name, std::nullopt}};
  }

  std::vector<MapInput> three_files() const {
    return {file("a.ply", piece_at(0, 1)), file("b.ply", with_all_attributes(piece_at(50, 2))),
            file("c.ply", piece_at(-70, 3))};
  }

  JobOptions options(std::optional<std::int32_t> epoch = std::nullopt) const {
    JobOptions options;
    options.city = folder_ / "city";
    options.files.build.epoch = epoch;
    options.num_buckets = kBuckets;
    return options;
  }

  Job plan(const std::vector<MapInput>& inputs, const JobOptions& options) const {
    return plan_job(folder_ / "job", inputs, options);
  }

  Job plan(const std::vector<MapInput>& inputs) const { return plan(inputs, options()); }

  static JobFinished run(const Job& job) { return run_job(job, {}); }

  // The city that build_city() makes of the same, and that of the job, must be one.
  void expect_built(const std::vector<MapInput>& inputs, const JobOptions& options) const {
    CityBuildOptions build;
    build.files = options.files;
    build_city(folder_ / "built", inputs, build);
    EXPECT_TRUE(test::files_of_city(folder_ / "built") == test::files_of_city(folder_ / "city"));
  }

  std::string error_of(const std::function<void()>& body) const { return test::io_error_of(body); }

  test::TemporaryFolder folder_;
};

using Stages = StagesTest;

TEST_F(Stages, GiveTheBytesOfABuild) {
  const std::vector<MapInput> inputs = three_files();
  const JobFinished finished = run(plan(inputs, options(3)));
  EXPECT_EQ(finished.built.added.size(), 3U);
  EXPECT_EQ(finished.built.manifest.epoch, 3);
  EXPECT_GT(finished.built.manifest.tiles.size(), 3U);
  expect_built(inputs, options(3));
}

TEST_F(Stages, KeepThePartsThatABuildKeeps) {
  const std::vector<MapInput> inputs = three_files();
  JobOptions keeping = options(3);
  keeping.keeps_parts = true;
  keeping.files.build.epsg = 25832;
  const Job job = plan(inputs, keeping);
  run(job);
  EXPECT_TRUE(run(job).was_published);
  CityBuildOptions build;
  build.files = keeping.files;
  build.keeps_parts = true;
  build_city(folder_ / "built", inputs, build);
  EXPECT_TRUE(test::files_of_city(folder_ / "built") == test::files_of_city(folder_ / "city"));
  EXPECT_TRUE(keeps_parts(open_city(folder_ / "city").manifest));

  JobOptions adding = options(4);
  adding.adds = true;
  try {
    plan_job(folder_ / "more", {file("d.ply", piece_at(20, 4))}, adding);
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    EXPECT_TRUE(std::string(error.what()).ends_with("city: keeps the sums of its sources: add to it by build --into"));
  }
}

TEST_F(Stages, ThreadsMemoryJobsAndOrderChangeNoByteOfAPart) {
  std::vector<MapInput> inputs = three_files();
  const Job first = plan(inputs);
  for (std::size_t i = 0; i < 3; ++i) map_source(first, i, {});
  std::ranges::reverse(inputs);
  const Job second = plan_job(folder_ / "second", inputs, options());
  JobRunOptions little;
  little.num_jobs = 3;
  little.map.memory_bytes = 1 << 20;
  test::on_threads(4, [&] { return run_job(second, little).built.notes.num_points; });
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(test::read_raw(part_path(first.folder, i)) == test::read_raw(part_path(second.folder, i))) << i;
  }
  expect_built(inputs, options());
}

TEST_F(Stages, AnOutputThatIsThereIsSkipped) {
  const Job job = plan(three_files());
  EXPECT_EQ(map_source(job, 1, {}), MapOutcome::kDone);
  const auto written = std::filesystem::last_write_time(part_path(job.folder, 1));
  EXPECT_EQ(map_source(job, 1, {}), MapOutcome::kWasThere);
  EXPECT_EQ(std::filesystem::last_write_time(part_path(job.folder, 1)), written);
  map_source(job, 0, {});
  map_source(job, 2, {});
  EXPECT_EQ(reduce_bucket(job, 2), ReduceOutcome::kDone);
  EXPECT_EQ(reduce_bucket(job, 2), ReduceOutcome::kWasThere);
  EXPECT_FALSE(run(job).was_published);
  EXPECT_TRUE(run(job).was_published);
  EXPECT_EQ(reduce_bucket(job, 2), ReduceOutcome::kWasThere);
}

// Where no second name can be given to a file, its bytes are copied.
TEST_F(Stages, AJobOnAnotherFileSystemGivesTheSameBytes) {
  struct stat memory {};
  struct stat here {};
  if (::stat("/dev/shm", &memory) != 0 || ::stat(folder_.path().c_str(), &here) != 0 || memory.st_dev == here.st_dev) {
    GTEST_SKIP() << "needs two file systems";
  }
  const std::vector<MapInput> inputs = three_files();
  const std::filesystem::path job = "/dev/shm/vdbmap_job_" + std::to_string(::getpid());
  run(plan_job(job, inputs, options()));
  std::filesystem::remove_all(job);
  expect_built(inputs, options());
}

TEST_F(Stages, TwoThatDoTheSameAtOnceDoNoHarm) {
  const std::vector<MapInput> inputs = three_files();
  const Job job = plan(inputs);
  const auto twice = [](const std::function<void()>& body) {
    std::jthread other(body);
    body();
  };
  for (std::size_t i = 0; i < 3; ++i) twice([&] { map_source(job, i, {}); });
  for (std::size_t i = 0; i < kBuckets; ++i) twice([&] { reduce_bucket(job, i); });
  finish_job(job);
  expect_built(inputs, options());
}

TEST_F(Stages, EveryTileIsInItsBucketAlone) {
  const std::vector<MapInput> inputs = three_files();
  const Job job = plan(inputs);
  for (std::size_t i = 0; i < 3; ++i) map_source(job, i, {});
  const CountedParts counted = open_parts(job);
  std::map<TileId, std::size_t> buckets;
  for (std::size_t i = 0; i < kBuckets; ++i) {
    reduce_bucket(job, i);
    for (const CityTile& tile : open_bucket(job, i, counted).tiles) {
      EXPECT_TRUE(buckets.emplace(tile.id, i).second);
      EXPECT_EQ(bucket_of(tile.id, kBuckets), i);
    }
  }
  EXPECT_EQ(buckets.size(), finish_job(job).built.manifest.tiles.size());
}

TEST_F(Stages, EqualSourcesAreCountedOnce) {
  const std::vector<MapInput> inputs = {file("a.ply", piece_at(0, 1)), file("copy.ply", piece_at(0, 1))};
  const JobFinished finished = run(plan(inputs));
  EXPECT_EQ(finished.built.not_counted, (std::vector<std::string>{"copy.ply"}));
  EXPECT_EQ(finished.built.notes.num_points, piece_at(0, 1).size());
  expect_built(inputs, options());
}

// Which of two files of one name is the first one, and anchors the city, is told by their hashes.
TEST_F(Stages, FilesOfOneNameAreTakenInTheOrderOfABuild) {
  for (const double far : {4000.0, -4000.0}) {
    std::filesystem::remove_all(folder_ / "job");
    std::filesystem::remove_all(folder_ / "city");
    std::filesystem::remove_all(folder_ / "built");
    const std::vector<MapInput> inputs = {file("x/cloud.ply", piece_at(0, 1)), file("y/cloud.ply", piece_at(far, 2))};
    run(plan(inputs));
    expect_built(inputs, options());
  }
}

TEST_F(Stages, ScansHaveTheirPosesAndRange) {
  std::vector<MapInput> inputs = three_files();
  JobOptions near = options();
  near.files.inputs.range = RangeLimits{2, 60};
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    inputs[i].map_from_scan = Eigen::Isometry3d(
        Eigen::AngleAxisd(0.1 + 0.3 * static_cast<double>(i), Eigen::Vector3d(0.1, 0.2, 1).normalized()));
    inputs[i].map_from_scan->translation() = Eigen::Vector3d(3e5 + 1.0 / 3, 5e6, 40.1);
  }
  const JobFinished finished = run(plan(inputs, near));
  EXPECT_GT(finished.built.notes.num_out_of_range, 0U);
  expect_built(inputs, near);
}

TEST_F(Stages, AFirstSourceOutOfRangeAnchorsNothing) {
  std::vector<MapInput> inputs = {file("a.ply", piece_at(500, 1)), file("b.ply", piece_at(0, 2))};
  for (MapInput& input : inputs) input.map_from_scan = Eigen::Isometry3d::Identity();
  inputs[1].map_from_scan->translation().x() = 7000;
  JobOptions near = options();
  near.files.inputs.range = RangeLimits{1, 50};
  run(plan(inputs, near));
  expect_built(inputs, near);
}

TEST_F(Stages, ALargeFileIsReadInPieces) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(5e5, 5e6, 5);
  PointCloud cloud = with_all_attributes(test::moved(test::sample_scene(test::street(), 60, 1), pose));
  for (std::uint16_t& label : cloud.labels) label %= 3;
  cloud.positions.front() = Eigen::Vector3d(0, 0, 1);  // astray: what anchors the map is told by all pieces together
  write_las(folder_ / "large.las", cloud, {.resolution = 0.01});
  const std::vector<MapInput> inputs = {{{folder_ / "large.las", {}}}};
  JobOptions little = options();
  little.memory_bytes = 1 << 20;
  JobRunOptions running;
  running.map.memory_bytes = 1 << 20;
  const JobFinished finished = run_job(plan(inputs, little), running);
  EXPECT_EQ(finished.built.notes.findings.size(), 1U);
  expect_built(inputs, little);
}

TEST_F(Stages, AddToACityWhatBuildingWouldAdd) {
  const std::vector<MapInput> inputs = three_files();
  CityBuildOptions first;
  first.files.build.epoch = 1;
  build_city(folder_ / "city", {inputs[0]}, first);
  build_city(folder_ / "built", {inputs[0]}, first);

  JobOptions adds = options(2);
  adds.adds = true;
  const JobFinished finished = run(plan(inputs, adds));
  EXPECT_EQ(finished.built.not_counted, (std::vector<std::string>{"a.ply"}));
  CityBuildOptions second;
  second.files.build.epoch = 2;
  add_to_city(folder_ / "built", inputs, second);
  EXPECT_TRUE(test::files_of_city(folder_ / "built") == test::files_of_city(folder_ / "city"));

  const Job again = plan_job(folder_ / "again", inputs, adds);
  EXPECT_TRUE(run(again).built.added.empty());
  EXPECT_TRUE(test::files_of_city(folder_ / "built") == test::files_of_city(folder_ / "city"));
}

TEST_F(Stages, APlanWhoseCityHasMovedOnChangesNothing) {
  const std::vector<MapInput> inputs = three_files();
  build_city(folder_ / "city", {inputs[0]}, {});
  JobOptions adds = options();
  adds.adds = true;
  const Job job = plan({inputs[1]}, adds);
  map_source(job, 0, {});
  for (std::size_t i = 0; i < kBuckets; ++i) reduce_bucket(job, i);
  add_to_city(folder_ / "city", {inputs[2]}, {});
  const auto before = test::files_of_city(folder_ / "city");
  const std::string moved_on = "city: has changed since the job was planned: plan it anew";
  EXPECT_EQ(error_of([&] { finish_job(job); }), moved_on);
  EXPECT_EQ(error_of([&] { reduce_bucket(job, 0); }), moved_on);
  EXPECT_TRUE(find_status(job).problem.ends_with(moved_on));
  EXPECT_TRUE(test::files_of_city(folder_ / "city") == before);

  // One that has come to be where there was none.
  const Job fresh = plan_job(folder_ / "fresh", {inputs[1]}, [&] {
    JobOptions other = options();
    other.city = folder_ / "other";
    return other;
  }());
  build_city(folder_ / "other", {inputs[0]}, {});
  EXPECT_EQ(error_of([&] { run(fresh); }), "other: has changed since the job was planned: plan it anew");
}

TEST_F(Stages, ACityOfOtherSourcesIsNotReplaced) {
  const std::vector<MapInput> inputs = three_files();
  build_city(folder_ / "city", {inputs[0]}, {});
  EXPECT_THROW(run(plan({inputs[1]})), std::invalid_argument);
  std::filesystem::remove_all(folder_ / "job");
  EXPECT_EQ(run(plan(inputs)).built.added.size(), 3U);
}

TEST_F(Stages, ABusyCityIsNotPublished) {
  const std::vector<MapInput> inputs = three_files();
  build_city(folder_ / "city", inputs, {});
  const Job job = plan(inputs);
  const CityLock busy(folder_ / "city");
  EXPECT_NE(error_of([&] { run(job); }).find("is writing it"), std::string::npos);
}

TEST_F(Stages, WhatIsMissingIsSaid) {
  const Job job = plan(three_files());
  map_source(job, 0, {});
  EXPECT_EQ(error_of([&] { reduce_bucket(job, 0); }), "1.part: is missing: source 1 is not mapped yet");
  EXPECT_EQ(find_status(job).missing_sources, (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(find_status(job).missing_buckets.size(), kBuckets);
  map_source(job, 1, {});
  map_source(job, 2, {});
  reduce_bucket(job, 3);
  EXPECT_EQ(find_status(job).missing_buckets, (std::vector<std::size_t>{0, 1, 2, 4}));
  EXPECT_EQ(error_of([&] { finish_job(job); }), "0: is missing: bucket 0 is not reduced yet");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "city"));
  run(job);
  EXPECT_TRUE(find_status(job).is_published);
  EXPECT_THROW(map_source(job, 3, {}), std::invalid_argument);
  EXPECT_THROW(reduce_bucket(job, kBuckets), std::invalid_argument);
}

TEST_F(Stages, ADamagedPartIsNoticedAndMappedAgain) {
  const std::vector<MapInput> inputs = three_files();
  const Job job = plan(inputs);
  for (std::size_t i = 0; i < 3; ++i) map_source(job, i, {});
  const std::filesystem::path path = part_path(job.folder, 1);
  const std::string whole = test::read_raw(path);
  for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 97) {
    test::write_raw(path, whole.substr(0, size));
    EXPECT_FALSE(has_part(job, 1)) << size;
  }
  for (std::size_t place = 0; place < whole.size(); place += 1 + whole.size() / 29) {
    std::string changed = whole;
    changed[place] = static_cast<char>(changed[place] ^ 4);
    test::write_raw(path, changed);
    std::string error = "no error";
    for (std::size_t i = 0; i < kBuckets && error == "no error"; ++i) {
      error = error_of([&] { reduce_bucket(job, i); });
    }
    EXPECT_TRUE(error.starts_with("1.part: ")) << place << error;
    std::filesystem::remove_all(buckets_path(job.folder));
    std::filesystem::create_directory(buckets_path(job.folder));
  }
  test::write_raw(path, whole.substr(0, whole.size() - 1));
  EXPECT_EQ(error_of([&] { reduce_bucket(job, 0); }), "1.part: is no part, or was cut");
  EXPECT_EQ(map_source(job, 1, {}), MapOutcome::kDone);
  EXPECT_TRUE(test::read_raw(path) == whole);
  run(job);
  expect_built(inputs, options());
}

TEST_F(Stages, APartOfAnotherPlanOrSourceIsRefused) {
  const std::vector<MapInput> inputs = three_files();
  const Job job = plan(inputs);
  for (std::size_t i = 0; i < 3; ++i) map_source(job, i, {});
  const Job other = plan_job(folder_ / "other", inputs, options(7));
  map_source(other, 1, {});
  const auto overwrite = std::filesystem::copy_options::overwrite_existing;
  std::filesystem::copy_file(part_path(other.folder, 1), part_path(job.folder, 1), overwrite);
  EXPECT_EQ(error_of([&] { reduce_bucket(job, 0); }), "1.part: is of another plan");
  std::filesystem::copy_file(part_path(job.folder, 2), part_path(job.folder, 1), overwrite);
  EXPECT_EQ(error_of([&] { reduce_bucket(job, 0); }), "1.part: is of source 2");
}

TEST_F(Stages, ABucketOfOtherPartsIsRefusedAndMadeAnew) {
  const std::vector<MapInput> inputs = three_files();
  const Job job = plan(inputs);
  run(job);
  std::filesystem::remove_all(folder_ / "city");
  const auto copy = [&](std::size_t from, std::size_t to) {
    std::filesystem::remove_all(bucket_path(job.folder, to));
    std::filesystem::copy(bucket_path(job.folder, from), bucket_path(job.folder, to),
                          std::filesystem::copy_options::recursive);
  };
  copy(0, 1);
  EXPECT_EQ(error_of([&] { finish_job(job); }), "1: is another bucket");
  EXPECT_EQ(reduce_bucket(job, 1), ReduceOutcome::kDone);
  const CityTile tile = open_bucket(job, 1, open_parts(job)).tiles.front();
  std::filesystem::resize_file(tile_path(bucket_path(job.folder, 1), tile), tile.num_bytes - 1);
  EXPECT_NE(error_of([&] { finish_job(job); }).find("is not the tile that its name says"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "city"));
  run(job);
  expect_built(inputs, options());
}

TEST_F(Stages, ABadSourceStopsTheJobOrIsLeftOutByName) {
  std::vector<MapInput> inputs = three_files();
  test::write_raw(folder_ / "bad.ply", test::read_raw(folder_ / "b.ply").substr(0, 90));
  inputs.push_back({{folder_ / "bad.ply", {}}});
  const Job job = plan(inputs);
  EXPECT_NE(error_of([&] { run(job); }).find("bad.ply:"), std::string::npos);
  JobRunOptions skipping;
  skipping.map.skips_bad = true;
  const JobFinished finished = run_job(job, skipping);
  ASSERT_EQ(finished.left_out.size(), 1U);
  EXPECT_EQ(finished.left_out[0].name, "bad.ply");
  EXPECT_NE(finished.left_out[0].reason.find("bad.ply:"), std::string::npos);
  inputs.pop_back();
  expect_built(inputs, options());
}

TEST_F(Stages, ABadFirstSourceIsLeftOutOfThePlan) {
  std::vector<MapInput> inputs = three_files();
  test::write_raw(folder_ / "0.ply", test::read_raw(folder_ / "b.ply").substr(0, 90));
  inputs.push_back({{folder_ / "0.ply", {}}});
  EXPECT_NE(error_of([&] { plan(inputs); }).find("0.ply:"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "job"));
  JobOptions skipping = options();
  skipping.skips_bad = true;
  const JobFinished finished = run(plan(inputs, skipping));
  ASSERT_EQ(finished.left_out.size(), 1U);
  EXPECT_EQ(finished.left_out[0].name, "0.ply");
  inputs.pop_back();
  expect_built(inputs, options());
}

TEST_F(Stages, ASourceThatWasRepairedIsCountedAfterAll) {
  std::vector<MapInput> inputs = three_files();
  const std::string good = test::read_raw(folder_ / "b.ply");
  std::string bad = good;
  bad.replace(0, 3, "PLX");
  test::write_raw(folder_ / "b.ply", bad);
  const Job job = plan(inputs);
  JobRunOptions skipping;
  skipping.map.skips_bad = true;
  for (std::size_t i = 0; i < 3; ++i) map_source(job, i, skipping.map);
  reduce_bucket(job, 0);
  test::write_raw(folder_ / "b.ply", good);
  EXPECT_EQ(map_source(job, 1, {}), MapOutcome::kDone);
  EXPECT_FALSE(has_bucket(job, 0, open_parts(job)));
  EXPECT_TRUE(run(job).left_out.empty());
  expect_built(inputs, options());
}

// What the machine cannot do is not the source's fault.
TEST_F(Stages, ANodeWithoutTheInputLeavesNothingOut) {
  const Job job = plan(three_files());
  std::filesystem::remove(folder_ / "b.ply");
  MapStageOptions skipping;
  skipping.skips_bad = true;
  EXPECT_EQ(error_of([&] { map_source(job, 1, skipping); }), "b.ply: cannot open: No such file or directory");
  EXPECT_FALSE(left_out_source(job, 1));
}

TEST_F(Stages, AFileOfAnotherSizeThanPlannedIsRefused) {
  const Job job = plan(three_files());
  const std::string bytes = test::read_raw(folder_ / "b.ply");
  test::write_raw(folder_ / "b.ply", bytes + "\n");
  EXPECT_NE(error_of([&] { map_source(job, 1, {}); }).find("when the job was planned: plan it anew"),
            std::string::npos);
}

TEST_F(Stages, SourcesThatDoNotGoTogetherAreRefusedAsInABuild) {
  write_las(folder_ / "a.las", piece_at(0, 5), {.epsg = 25832});
  write_las(folder_ / "b.las", piece_at(0, 6), {.epsg = 25833});
  const Job job = plan({{{folder_ / "a.las", {}}}, {{folder_ / "b.las", {}}}});
  EXPECT_EQ(error_of([&] { run(job); }), "b.las: is in EPSG:25833, files before it are in EPSG:25832");
}

TEST_F(Stages, AnOutputThatCannotBeIsRefusedBeforeTheWork) {
  const std::vector<MapInput> inputs = three_files();
  JobOptions home = options();
  home.city = folder_.path();
  EXPECT_NE(error_of([&] { plan(inputs, home); }).find("is no city: it holds"), std::string::npos);
  EXPECT_THROW(plan_job(folder_ / "city", inputs, options()), std::invalid_argument);
  JobOptions adds = options();
  adds.adds = true;
  EXPECT_EQ(error_of([&] { plan(inputs, adds); }), "city: cannot open: No such file or directory");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "city"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "job"));
  for (const std::int32_t epoch : {1, 2}) {
    CityBuildOptions build;
    build.files.build.epoch = epoch;
    if (epoch == 1) build_city(folder_ / "city", {inputs[0]}, build);
    if (epoch == 2) add_to_city(folder_ / "city", {inputs[1]}, build);
  }
  EXPECT_THROW(plan(inputs), std::invalid_argument);
  const CityLock busy(folder_ / "city");
  EXPECT_NE(error_of([&] { plan(inputs, adds); }).find("is writing it"), std::string::npos);
}

TEST_F(Stages, APlanIsMadeOnce) {
  const std::vector<MapInput> inputs = three_files();
  const Job job = plan(inputs);
  EXPECT_EQ(plan(inputs).key, job.key);
  EXPECT_EQ(open_job(folder_ / "job").key, job.key);
  EXPECT_THROW(plan({inputs[0]}), std::invalid_argument);
  EXPECT_THROW(plan_job(folder_ / "none", {}, options()), std::invalid_argument);
  test::write_raw(folder_ / "home.txt", "");
  EXPECT_NE(error_of([&] { plan_job(folder_.path(), inputs, options()); }).find("is no job: it holds"),
            std::string::npos);
  EXPECT_EQ(error_of([&] { open_job(folder_ / "none"); }), "none: cannot open: No such file or directory");
  std::filesystem::create_directory(folder_ / "empty");
  EXPECT_EQ(error_of([&] { open_job(folder_ / "empty"); }), "empty: is no job: it has no job.json");
}

}  // namespace
}  // namespace vdbmap
