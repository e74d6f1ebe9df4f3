// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

namespace vdbmap::test {

/// What a server answered.
struct HttpAnswer {
  int status = 0;                              ///< 0: nothing came
  std::map<std::string, std::string> headers;  ///< names in small letters
  std::string body;                            ///< all that came after the headers
};

/// Asks a server on 127.0.0.1, word for word as told: `target` is not made better on the way. `headers` are whole
/// lines.
HttpAnswer http_request(int port, const std::string& target, const std::vector<std::string>& headers = {},
                        const std::string& method = "GET");

}  // namespace vdbmap::test
