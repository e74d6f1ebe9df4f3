// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace vdbmap::cli {

/// What the command tells the shell; 128 plus its number where a signal ended it.
enum class ExitCode : int {
  kDone = 0,
  kNo = 1,                 ///< the answer is no: not localized, not found, a rule is broken
  kWrongUsage = 2,         ///< the command line is wrong
  kBadInput = 3,           ///< the content of an input file is wrong
  kInputOutputFailed = 4,  ///< the operating system refused: missing file, disk full, no memory
};

}  // namespace vdbmap::cli
