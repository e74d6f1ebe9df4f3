// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/simulate.h"

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "tools/simulator/epoch_writer.h"
#include "tools/simulator/output_folder.h"
#include "tools/simulator/street_json.h"
#include "tools/simulator/truth_files.h"
#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/file/atomic_folder.h"

namespace vdbmap::simulator {

SimulateResult simulate(const std::filesystem::path& out, const SimulateOptions& options) {
  options.check();
  check_output_folder(out);
  AtomicFolder folder(out);
  const std::filesystem::path& inside = folder.temporary_path();
  Street street = make_street(options.street);

  SimulateResult result;
  SimulationRecord record;
  for (int epoch = 0; epoch < options.street.num_epochs; ++epoch) {
    result.epochs.push_back(write_epoch(inside / fmt::format("epoch{}", epoch), street, epoch, options, record));
  }
  write_spaces(inside / "spaces.geojson", street, record.seen);
  result.num_spaces = street.parking.spaces.size();
  result.num_changed_voxels = write_changes(inside / "changes.csv", street);

  nlohmann::ordered_json json = {{"generator", kGenerator}};
  json.update(json_of_street(street));
  json["surveys"] = record.drives;
  write_file(inside / "street.json", json.dump(1) + "\n");
  folder.commit();
  return result;
}

}  // namespace vdbmap::simulator
