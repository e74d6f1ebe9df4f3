// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/class_options.h"

namespace vdbmap::cli {

void add_class_options(CLI::App& app, ClassOptions& options) {
  app.add_option("--labels", options.labels,
                 "Classes of the points: SemanticKITTI's .label file of the one cloud, or a folder with NAME.label for "
                 "each scan NAME (default: those that the point files hold)")
      ->type_name("PATH");
  app.add_option("--label-scheme", options.scheme_name,
                 "Whose numbers the classes are: asprs or semantickitti (default: asprs of LAS, semantickitti of "
                 "--labels, else unknown)")
      ->check(CLI::IsMember({text_of(LabelScheme::kAsprs), text_of(LabelScheme::kSemanticKitti)}).description(""))
      ->type_name("NAME");
  app.add_option("--drop", options.dropped,
                 "Leave out points of these classes, moving or not: person,bicyclist. What vdbmap segment makes of "
                 "scans are such classes")
      ->delimiter(',')
      ->type_name("CLASS,...");
}

}  // namespace vdbmap::cli
