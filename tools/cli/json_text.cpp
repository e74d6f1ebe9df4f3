// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/json_text.h"

namespace vdbmap::cli {

nlohmann::ordered_json json_of_place(const ScanPlace& scan) {
  nlohmann::ordered_json json = {{"file", scan.file.string()}};
  if (scan.turn) json["turn"] = *scan.turn + 1;
  return json;
}

}  // namespace vdbmap::cli
