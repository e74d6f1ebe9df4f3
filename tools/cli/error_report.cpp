// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/error_report.h"

#include <new>
#include <stdexcept>
#include <string>

#include <CLI/Error.hpp>
#include <spdlog/spdlog.h>

#include "vdbmap/core/error.h"

namespace vdbmap::cli {
namespace {

ExitCode fail(ExitCode code, const std::string& message) {
  spdlog::error(message);
  return code;
}

}  // namespace

ExitCode report_errors(const std::function<ExitCode()>& body) {
  try {
    return body();
  } catch (const IoError& error) {
    const bool malformed = error.kind() == IoError::Kind::kMalformed;
    return fail(malformed ? ExitCode::kBadInput : ExitCode::kInputOutputFailed, error.what());
  } catch (const CLI::ParseError& error) {
    return fail(ExitCode::kWrongUsage, error.what());
  } catch (const std::invalid_argument& error) {
    return fail(ExitCode::kWrongUsage, error.what());
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::kInputOutputFailed, "out of memory");
  } catch (const std::exception& error) {
    return fail(ExitCode::kInputOutputFailed, error.what());
  }
}

}  // namespace vdbmap::cli
