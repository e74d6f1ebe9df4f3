// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/site_server.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include <httplib.h>
#include <zlib.h>

#include "tools/cli/served_file.h"
#include "vdbmap/core/error.h"

namespace vdbmap::cli {
namespace {

// A connection that waits for its next request keeps a thread: browsers have six each.
constexpr std::size_t kMostConnections = 192;
constexpr time_t kWaitForNextRequest = 1;  // [s]
constexpr std::size_t kMostRequestsOfAConnection = 10'000;
constexpr std::size_t kMostRequestBytes = 4096;
constexpr std::uint64_t kMostBytesToCompress = std::uint64_t{16} << 20;
constexpr std::size_t kMostFilesKept = 64;
constexpr std::size_t kBytesAtOnce = std::size_t{256} << 10;

// Empty where it could not be done.
std::string gzip_of(const std::string& bytes) {
  constexpr int kGzip = 15 + 16;
  constexpr int kMemoryLevel = 8;
  z_stream stream{};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzip, kMemoryLevel, Z_DEFAULT_STRATEGY) != Z_OK)
    return "";
  std::string compressed(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(compressed.data());
  stream.avail_out = static_cast<uInt>(compressed.size());
  const bool is_done = deflate(&stream, Z_FINISH) == Z_STREAM_END;
  compressed.resize(stream.total_out);
  deflateEnd(&stream);
  return is_done ? compressed : "";
}

// Texts as they were sent last, by their tags: none is compressed for each client anew.
class CompressedFiles {
 public:
  std::shared_ptr<const std::string> find_or_compress(const ServedFile& file) {
    {
      const std::lock_guard lock(mutex_);
      const auto found = files_.find(file.tag());
      if (found != files_.end()) return found->second;
    }
    std::string bytes(file.size(), '\0');
    bytes.resize(file.read(0, bytes.data(), bytes.size()));
    const auto compressed = std::make_shared<const std::string>(gzip_of(bytes));
    const std::lock_guard lock(mutex_);
    if (files_.size() >= kMostFilesKept) files_.clear();
    return files_[file.tag()] = compressed;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const std::string>> files_;
};

// Whether a header's list of values has one, with a weight above zero: "gzip, br;q=0".
bool accepts_gzip(const httplib::Request& request) {
  std::string list = request.get_header_value("Accept-Encoding");
  std::erase_if(list, [](char c) { return c == ' '; });
  for (std::size_t begin = 0; begin < list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string value = list.substr(begin, end - begin);
    if (value == "gzip") return true;
    if (value.starts_with("gzip;q=")) return std::strtod(value.c_str() + 7, nullptr) > 0;
    begin = end + 1;
  }
  return false;
}

// Whether the client has this state of the file already: "*", or a list of tags, weak ones too.
bool has_already(const httplib::Request& request, const std::string& quoted_tag) {
  const std::string tags = request.get_header_value("If-None-Match");
  return tags == "*" || tags.find(quoted_tag) != std::string::npos;
}

struct ByteRange {
  std::uint64_t first;
  std::uint64_t last;
};

enum class RangeAnswer { kWhole, kPart, kNotThere };

// What is asked for of a file. Several ranges at once are not answered as such: the whole file comes, as it may.
RangeAnswer answer_to_range(const httplib::Request& request, const std::string& quoted_tag, std::uint64_t size,
                            ByteRange& range) {
  const std::string only_if = request.get_header_value("If-Range");
  if (request.ranges.size() != 1 || (!only_if.empty() && only_if != quoted_tag)) return RangeAnswer::kWhole;
  const auto [first, last] = request.ranges.front();  // -1: not given
  const auto end = static_cast<ssize_t>(size);
  if (first < 0) {  // the last bytes
    if (last <= 0 || end == 0) return RangeAnswer::kNotThere;
    range = {static_cast<std::uint64_t>(std::max<ssize_t>(end - last, 0)), size - 1};
    return RangeAnswer::kPart;
  }
  if (first >= end || (last >= 0 && last < first)) return RangeAnswer::kNotThere;
  range = {static_cast<std::uint64_t>(first), static_cast<std::uint64_t>(last < 0 ? end - 1 : std::min(last, end - 1))};
  return RangeAnswer::kPart;
}

void send_compressed(std::shared_ptr<const std::string> bytes, const std::string& type, httplib::Response& response) {
  response.set_header("Content-Encoding", "gzip");
  response.set_content_provider(bytes->size(), type,
                                [bytes](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                  return sink.write(bytes->data() + offset, length);
                                });
}

void send_part(const ServedFile& file, const ByteRange& range, httplib::Response& response) {
  response.set_content_provider(range.last - range.first + 1, media_type(file.path()),
                                [file, range](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                  std::string chunk(std::min(length, kBytesAtOnce), '\0');
                                  chunk.resize(file.read(range.first + offset, chunk.data(), chunk.size()));
                                  return !chunk.empty() && sink.write(chunk.data(), chunk.size());
                                });
}

void send_text(int status, const std::string& text, httplib::Response& response) {
  response.status = status;
  response.set_content(text + "\n", "text/plain; charset=utf-8");
}

void describe(const ServedFile& file, const std::string& quoted_tag, httplib::Response& response) {
  response.set_header("ETag", quoted_tag);
  response.set_header("Accept-Ranges", "bytes");
  response.set_header("Cache-Control",
                      is_named_by_content(file.path()) ? "public, max-age=31536000, immutable" : "no-cache");
  if (is_compressible(file.path())) response.set_header("Vary", "Accept-Encoding");
}

// The library applies ranges by itself, but takes those beyond the end for good ones. The request is its own, and not
// constant there.
void keep_ranges_from_library(const httplib::Request& request) {
  const_cast<httplib::Request&>(request).ranges.clear();
}

void answer(const std::filesystem::path& folder, CompressedFiles& compressed, const httplib::Request& request,
            httplib::Response& response) {
  const std::optional<ServedFile> file = ServedFile::open(folder, request.path);
  if (!file) return send_text(404, "not found", response);

  const bool is_gzip = request.ranges.empty() && accepts_gzip(request) && is_compressible(file->path()) &&
                       file->size() <= kMostBytesToCompress;
  const std::string tag = "\"" + file->tag() + (is_gzip ? "-gzip\"" : "\"");
  ByteRange range{0, file->size() - 1};
  const RangeAnswer part = answer_to_range(request, tag, file->size(), range);
  keep_ranges_from_library(request);
  describe(*file, tag, response);
  if (has_already(request, tag)) {
    response.status = 304;
    return;
  }
  if (part == RangeAnswer::kNotThere) {
    response.set_header("Content-Range", "bytes */" + std::to_string(file->size()));
    return send_text(416, "the file has no such bytes", response);
  }
  response.status = part == RangeAnswer::kPart ? 206 : 200;
  if (part == RangeAnswer::kPart) {
    response.set_header("Content-Range", "bytes " + std::to_string(range.first) + "-" + std::to_string(range.last) +
                                             "/" + std::to_string(file->size()));
  }
  if (is_gzip) {
    auto bytes = compressed.find_or_compress(*file);
    if (!bytes->empty()) return send_compressed(std::move(bytes), media_type(file->path()), response);
  }
  if (file->size() == 0) return response.set_content("", media_type(file->path()));
  send_part(*file, range, response);
}

httplib::Server::HandlerResponse refuse_other_methods(const httplib::Request& request, httplib::Response& response) {
  if (request.method == "GET" || request.method == "HEAD") return httplib::Server::HandlerResponse::Unhandled;
  response.set_header("Allow", "GET, HEAD");
  send_text(405, "only GET and HEAD", response);
  return httplib::Server::HandlerResponse::Handled;
}

}  // namespace

struct SiteServer::Running {
  httplib::Server server;
  CompressedFiles compressed;
  std::string host;
  int port = 0;
  std::thread thread;
};

SiteServer::SiteServer(const std::filesystem::path& folder, const ServerAddress& address)
    : running_(std::make_unique<Running>()) {
  httplib::Server& server = running_->server;
  CompressedFiles& compressed = running_->compressed;
  server.new_task_queue = [] { return new httplib::ThreadPool(kMostConnections); };
  server.set_keep_alive_timeout(kWaitForNextRequest);
  server.set_keep_alive_max_count(kMostRequestsOfAConnection);
  server.set_payload_max_length(kMostRequestBytes);
  server.set_tcp_nodelay(true);
  server.set_default_headers({{"X-Content-Type-Options", "nosniff"}});
  // Not the library's SO_REUSEPORT, with which two servers share a port.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  });
  server.set_pre_routing_handler(refuse_other_methods);
  server.Get(".*", [folder, &compressed](const httplib::Request& request, httplib::Response& response) {
    answer(folder, compressed, request, response);
  });

  running_->host = address.host;
  errno = 0;
  const bool is_bound = address.port == 0 ? (running_->port = server.bind_to_any_port(address.host)) > 0
                                          : server.bind_to_port(address.host, address.port);
  if (!is_bound) {
    throw IoError::system(address.host + ":" + std::to_string(address.port), "cannot serve there",
                          errno != 0 ? errno : EADDRNOTAVAIL);
  }
  if (address.port != 0) running_->port = address.port;
  running_->thread = std::thread([&server] { server.listen_after_bind(); });
  while (!server.is_running()) std::this_thread::yield();
}

SiteServer::~SiteServer() {
  running_->server.stop();
  running_->thread.join();
}

int SiteServer::port() const { return running_->port; }

std::string SiteServer::url() const {
  const bool is_ipv6 = running_->host.find(':') != std::string::npos;
  const std::string host = is_ipv6 ? "[" + running_->host + "]" : running_->host;
  return "http://" + host + ":" + std::to_string(running_->port) + "/";
}

}  // namespace vdbmap::cli
