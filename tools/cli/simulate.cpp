// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/simulate.h"

#include <chrono>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "tools/cli/command.h"
#include "tools/cli/output.h"
#include "tools/cli/progress.h"
#include "tools/simulator/sensor_file.h"
#include "vdbmap/io/file/text.h"

namespace vdbmap::cli {
namespace {

using simulator::EpochResult;
using simulator::SimulateOptions;
using simulator::SimulateResult;

struct SimulateCommandOptions {
  std::filesystem::path out;
  SimulateOptions simulate;
  std::string sensors;
  std::string quarter;
};

// A negative number would turn into a huge one.
std::string expect_no_sign(const std::string& text) {
  return text.starts_with('-') ? "is " + text + ", expected a whole number from 0 on" : std::string();
}

// Ranges are checked by the library, whose messages name them.
void add_options(CLI::App& app, SimulateCommandOptions& options) {
  SimulateOptions& simulate = options.simulate;
  app.add_option("OUT", options.out,
                 "Folder to write; one that exists must be empty or an earlier simulation, which is replaced")
      ->type_name("FOLDER")
      ->required();
  app.add_option("--seed", simulate.street.seed, "Another seed, another street")
      ->check(expect_no_sign)
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--length", simulate.street.length, "Length of the street [m], 30 to 1000")
      ->type_name("L")
      ->capture_default_str();
  app.add_option("--margin", simulate.street.margin, "How far its houses go on before and after [m], 0 to 200")
      ->type_name("M")
      ->capture_default_str();
  app.add_option("--epochs", simulate.street.num_epochs, "Days on which the street is visited, 1 to 20")
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--quarter", options.quarter,
                 "Blocks of a quarter of streets, 1 to 6 along its rows and its columns, instead of one street: one "
                 "drive goes through all of it, with loops")
      ->type_name("NxM");
  app.add_option("--sensors", options.sensors,
                 "What drives up the street, in every epoch or in one: mapper (cloud.las), vlp16 (scans/), hdl64 "
                 "(scans_hdl64/), hdl32, os1-128, or a JSON file that describes scanners")
      ->type_name("NAME[@EPOCH],... or FILE.json")
      ->default_str("mapper@0, vlp16 later");
  app.add_option("--scans", simulate.num_scans,
                 "Scans that each scanner takes in an epoch, one turn after the other, 1 to 5000")
      ->type_name("N")
      ->default_str("101, in a quarter all of its tour");
  app.add_option("--rain", simulate.rain, "Rain during the surveys [mm/h], 0 to 50: specks in the air, wet ground")
      ->type_name("R")
      ->capture_default_str();
  app.add_flag("--ideal", simulate.street.is_ideal,
               "A street where nothing moves, hedges are neat, and no survey has an error");
  app.add_option("--occupancy", simulate.street.occupancy, "Share of the parking spaces that is taken, 0 to 1")
      ->type_name("S")
      ->capture_default_str();
  app.add_option("--turnover", simulate.street.turnover, "Share of the cars that is gone by the next epoch, 0 to 1")
      ->type_name("S")
      ->capture_default_str();
}

nlohmann::ordered_json json_of(const SimulateCommandOptions& options, const SimulateResult& result, double seconds) {
  nlohmann::ordered_json epochs = nlohmann::ordered_json::array();
  for (const EpochResult& epoch : result.epochs) {
    epochs.push_back({{"vehicles", epoch.num_vehicles},
                      {"cloud_points", epoch.num_cloud_points},
                      {"scans", epoch.num_scans},
                      {"scan_points", epoch.num_scan_points}});
  }
  return {{"folder", options.out.string()},
          {"seed", options.simulate.street.seed},
          {"spaces", result.num_spaces},
          {"changed_voxels", result.num_changed_voxels},
          {"epochs", epochs},
          {"seconds", seconds}};
}

std::string text_of_epoch(std::size_t number, const EpochResult& epoch) {
  std::string text = fmt::format("epoch{}     {} vehicles", number, epoch.num_vehicles);
  if (epoch.num_cloud_points > 0) text += fmt::format(", cloud of {} points", epoch.num_cloud_points);
  if (epoch.num_scans > 0) {
    text += fmt::format(", {} scans of {} points", epoch.num_scans, epoch.num_scan_points / epoch.num_scans);
  }
  return text + "\n";
}

std::string text_of(const SimulateCommandOptions& options, const SimulateResult& result, double seconds) {
  const std::string place = options.quarter.empty() ? fmt::format("street of {} m", options.simulate.street.length)
                                                    : fmt::format("quarter of {} blocks", options.quarter);
  std::string text = fmt::format("{}: {}, seed {}, made in {:.1f} s\n", options.out.string(), place,
                                 options.simulate.street.seed, seconds);
  text += fmt::format("spaces     {} for parking\n", result.num_spaces);
  text += fmt::format("changes    {} voxels of 10 cm\n", result.num_changed_voxels);
  for (std::size_t i = 0; i < result.epochs.size(); ++i) text += text_of_epoch(i, result.epochs[i]);
  return text;
}

// "3x2", or nothing.
void set_quarter(simulator::StreetOptions& street, const std::string& text) {
  if (text.empty()) return;
  const std::size_t x = text.find('x');
  const auto columns = parse_count(text.substr(0, x));
  const auto rows = x == std::string::npos ? std::nullopt : parse_count(text.substr(x + 1));
  if (!columns || !rows || *columns > 1000 || *rows > 1000) {
    throw std::invalid_argument("--quarter " + vdbmap::quoted(text) + " is not of the form 3x2");
  }
  street.quarter_columns = static_cast<int>(*columns);
  street.quarter_rows = static_cast<int>(*rows);
  if (street.quarter_columns == 0)
    throw std::invalid_argument("--quarter 0: columns of the quarter, allowed are 1 to 6");
}

std::vector<simulator::SensorUse> sensors_of(const std::string& text) {
  if (text.ends_with(".json")) return simulator::read_sensors(text);
  return simulator::parse_sensors(text);
}

SimulateResult run_with_progress(const std::filesystem::path& out, SimulateOptions options,
                                 const CommonOptions& common) {
  options.check();
  Progress progress("surveying the street", options.num_steps(), common);
  options.on_step = [&progress] { progress.advance(); };
  return simulator::simulate(out, options);
}

ExitCode run(const SimulateCommandOptions& options, const CommonOptions& common) {
  const auto start = std::chrono::steady_clock::now();
  SimulateOptions simulate = options.simulate;
  if (!options.sensors.empty()) simulate.sensors = sensors_of(options.sensors);
  set_quarter(simulate.street, options.quarter);
  const SimulateResult result = run_with_progress(options.out, simulate, common);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  if (common.json) {
    print_json(json_of(options, result, elapsed.count()));
  } else {
    print_result(text_of(options, result, elapsed.count()));
  }
  return ExitCode::kDone;
}

}  // namespace

Command simulate_command() {
  return make_command<SimulateCommandOptions>(
      "simulate", "Make a street of parked cars with exact truth, and scan it",
      "vdbmap simulate street --seed 1 --length 175 --epochs 2\n"
      "vdbmap simulate street --ideal\n"
      "vdbmap simulate quarter --quarter 3x2 --sensors mapper@0,os1-128@1\n"
      "vdbmap simulate street --epochs 3 --sensors mapper@0,vlp16@1,vlp16@2\n"
      "vdbmap simulate street --epochs 1 --sensors mapper,hdl64 --scans 20 --occupancy 1",
      add_options, run);
}

}  // namespace vdbmap::cli
