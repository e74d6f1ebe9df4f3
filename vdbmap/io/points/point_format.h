// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

namespace vdbmap {

enum class PointFormat { kPly, kPcd, kLas, kKittiBin, kXyz, kVlp16Pcap };

/// The format of a point file. Its content decides: the first bytes, or text that begins with a number. Where that says
/// nothing the extension does, and last that the file is text. Throws IoError where nothing fits, and for an empty
/// file.
PointFormat detect_point_format(const std::filesystem::path& path);

/// The format that an extension stands for, in any case.
std::optional<PointFormat> format_of_extension(const std::filesystem::path& path);

}  // namespace vdbmap
