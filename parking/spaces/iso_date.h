// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vdbmap::parking {

/// Milliseconds since 1970 (UTC) of a date as in ISO 8601: 2023-03-01, 2023-03-01T10:20, 2023-03-01T10:20:30, the last
/// two with Z or an offset like +01:00, without it UTC. Nothing for anything else.
std::optional<std::int64_t> milliseconds_of(std::string_view date);

/// The date of whole seconds since 1970: "2023-03-01T10:20:30Z".
std::string date_of_seconds(std::int64_t seconds);

}  // namespace vdbmap::parking
