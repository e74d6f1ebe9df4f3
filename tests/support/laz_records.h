// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace vdbmap::test {

/// The records of a LAS file, or of a LAZ file with all of its layers decoded: every field of every point. Damage fails
/// the test.
std::string point_records(const std::filesystem::path& path);

}  // namespace vdbmap::test
