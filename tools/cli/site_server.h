// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace vdbmap::cli {

/// Where a site is served.
struct ServerAddress {
  std::string host = "127.0.0.1";
  int port = 8080;  ///< 0: any that is free
};

/// Serves the files of a folder over HTTP 1.1, in threads of its own while it lives: GET and HEAD, one range of bytes,
/// entity tags, text compressed by gzip for clients that take it. Only regular files beneath the folder; see
/// ServedFile.
class SiteServer {
 public:
  /// Begins to serve. Throws IoError (system) where the address cannot be had: the port is taken.
  SiteServer(const std::filesystem::path& folder, const ServerAddress& address);
  ~SiteServer();  ///< ends connections that wait for a request within a second
  SiteServer(const SiteServer&) = delete;
  SiteServer& operator=(const SiteServer&) = delete;

  int port() const;
  std::string url() const;  ///< "http://127.0.0.1:8080/"

 private:
  struct Running;
  std::unique_ptr<Running> running_;
};

}  // namespace vdbmap::cli
