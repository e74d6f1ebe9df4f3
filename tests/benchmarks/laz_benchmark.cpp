// SPDX-License-Identifier: GPL-3.0-or-later
// How many points a second are read of LAZ files, and how many laz-perf decodes of the same files (npm ci in
// tests/exchange).
#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "tests/support/folders.h"
#include "tests/support/laz_bytes.h"
#include "tests/support/raw_files.h"
#include "tests/support/run_command.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/laz/point_records.h"

namespace vdbmap {
namespace {

constexpr std::size_t kNumCopies = 20;  // of the airborne survey: 2.2 M points in 44 chunks
constexpr const char* kRate = "million_points_per_s";
constexpr const char* kExchange = VDBMAP_SOURCE_DIR "/tests/exchange/";

// The header and the records of a LAS file, whose records are repeated.
std::string repeated(const std::string& las, std::size_t num_copies) {
  const std::size_t points_at = load<std::uint32_t>(las.data() + 96);
  const auto num_points = load<std::uint32_t>(las.data() + 107);
  const std::size_t size = num_points * load<std::uint16_t>(las.data() + 105);
  std::string result = las.substr(0, points_at);
  laz::store(result.data() + 107, static_cast<std::uint32_t>(num_points * num_copies));
  for (std::size_t i = 0; i < num_copies; ++i) result.append(las, points_at, size);
  return result;
}

// The points of a file of format 3 in format 7.
std::string layered(const std::string& las) {
  const std::size_t points_at = load<std::uint32_t>(las.data() + 96);
  const std::size_t num_points = load<std::uint32_t>(las.data() + 107);
  std::string result = test::random_las(7, num_points, 0, 1);
  const std::size_t result_at = load<std::uint32_t>(result.data() + 96);
  std::copy_n(las.data() + 131, 48, result.data() + 131);  // scale and offset
  for (std::size_t i = 0; i < num_points; ++i) {
    const char* from = las.data() + points_at + 34 * i;
    char* to = result.data() + result_at + 36 * i;
    const auto returns = load<std::uint8_t>(from + 14);
    std::copy_n(from, 14, to);
    to[14] = static_cast<char>((returns & 7) | (returns >> 3 & 7) << 4);
    to[15] = static_cast<char>(returns & 0xc0);
    to[16] = static_cast<char>(from[15] & 31);
    to[17] = from[17];
    laz::store(to + 18, static_cast<std::int16_t>(load<std::int8_t>(from + 16) / 0.006));
    std::copy_n(from + 18, 16, to + 20);
  }
  return result;
}

// The file of a row, made once; empty where the survey is not there.
const std::filesystem::path& file_of(bool is_layered) {
  static const test::TemporaryFolder folder;
  static std::filesystem::path files[2];
  std::filesystem::path& file = files[is_layered ? 1 : 0];
  const auto data = test::real_data_folder();
  if (!file.empty() || !data) return file;
  const std::string survey = repeated(test::read_raw(*data / "las/autzen_trim.las"), kNumCopies);
  return file = test::write_raw(folder / (is_layered ? "layered.laz" : "pointwise.laz"),
                                test::compress_las(is_layered ? layered(survey) : survey));
}

void read_laz(benchmark::State& state, bool is_layered) {
  const std::filesystem::path& file = file_of(is_layered);
  if (file.empty()) return state.SkipWithError("no real data");
  const ThreadLimit limit(static_cast<std::size_t>(state.range(0)));
  std::size_t num_points = 0;
  for (auto _ : state) num_points += read_las(file).cloud.size();
  state.counters[kRate] = benchmark::Counter(1e-6 * static_cast<double>(num_points), benchmark::Counter::kIsRate);
  state.counters["bytes_a_point"] = static_cast<double>(std::filesystem::file_size(file)) /
                                    (static_cast<double>(num_points) / static_cast<double>(state.iterations()));
}

// By its own clock, without reading the file and starting Node.js.
void laz_perf(benchmark::State& state, bool is_layered) {
  const std::filesystem::path& file = file_of(is_layered);
  if (file.empty()) return state.SkipWithError("no real data");
  const test::TemporaryFolder folder;
  double num_points = 0;
  for (auto _ : state) {
    const auto result =
        test::run_command("/usr/bin/env", {"node", std::string(kExchange) + "laz_perf.js", file, folder / "records"});
    if (result.exit_code != 0) return state.SkipWithError("laz-perf is not installed (npm ci in tests/exchange)");
    const double points = std::strtod(result.out.c_str(), nullptr);
    const double rate = 1e6 * std::strtod(result.out.c_str() + result.out.find(", ") + 2, nullptr);
    state.SetIterationTime(points / rate);
    num_points += points;
  }
  state.counters[kRate] = benchmark::Counter(1e-6 * num_points, benchmark::Counter::kIsRate);
}

void threads(benchmark::internal::Benchmark* row) {
  row->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime()->Repetitions(5)->MinTime(0.5);
}

void peer(benchmark::internal::Benchmark* row) {
  row->Unit(benchmark::kMillisecond)->UseManualTime()->Repetitions(3)->Iterations(1);
}

BENCHMARK_CAPTURE(read_laz, pointwise, false)->Apply(threads);
BENCHMARK_CAPTURE(read_laz, layered, true)->Apply(threads);
BENCHMARK_CAPTURE(laz_perf, pointwise, false)->Apply(peer);
BENCHMARK_CAPTURE(laz_perf, layered, true)->Apply(peer);

}  // namespace
}  // namespace vdbmap
