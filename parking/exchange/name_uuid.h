// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace vdbmap::parking {

/// The UUID of a name: version 5 (RFC 4122, SHA-1) in the namespace of URLs. The same name has the same everywhere.
std::string uuid_of_name(const std::string& name);

}  // namespace vdbmap::parking
