// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/site_server.h"

#include <array>
#include <chrono>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <zlib.h>

#include "tests/support/folders.h"
#include "tests/support/http_request.h"
#include "tests/support/raw_files.h"
#include "vdbmap/core/error.h"

namespace vdbmap::cli {
namespace {

using test::HttpAnswer;

std::string gunzip(const std::string& compressed) {
  z_stream stream{};
  inflateInit2(&stream, 15 + 16);
  std::string bytes(1 << 20, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data()));
  stream.avail_in = static_cast<uInt>(compressed.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  bytes.resize(stream.total_out);
  inflateEnd(&stream);
  return bytes;
}

class Server : public testing::Test {
 protected:
  Server() {
    for (const char* const name : {"site", "site/tiles", "site/assets", "outside"}) {
      std::filesystem::create_directory(folder_ / name);
    }
    write("site/index.html", "<p>page</p>");
    write("site/site.json", "{\"format\": \"" + std::string(5000, 'x') + "\"}");
    write("site/tiles/0_1_2.ab.glb", kTile);
    write("site/empty.json", "");
    write("site/.hidden", "secret");
    write("outside/secret.txt", "secret");
    std::filesystem::create_symlink(folder_ / "outside/secret.txt", folder_ / "site/link.txt");
    std::filesystem::create_symlink(folder_ / "outside", folder_ / "site/tiles/out");
    ::mkfifo((folder_ / "site/pipe.txt").c_str(), 0600);
    server_ = std::make_unique<SiteServer>(folder_ / "site", ServerAddress{"127.0.0.1", 0});
  }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }

  HttpAnswer get(const std::string& target, const std::vector<std::string>& headers = {}) const {
    return test::http_request(server_->port(), target, headers);
  }

  const std::string kTile = "0123456789abcdefghij";
  test::TemporaryFolder folder_;
  std::unique_ptr<SiteServer> server_;
};

TEST_F(Server, SendsFilesWithTheirTypes) {
  const HttpAnswer page = get("/");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.body, "<p>page</p>");
  EXPECT_EQ(page.headers.at("content-type"), "text/html; charset=utf-8");
  EXPECT_EQ(page.headers.at("cache-control"), "no-cache");
  const HttpAnswer tile = get("/tiles/0_1_2.ab.glb?v=1");
  EXPECT_EQ(tile.body, kTile);
  EXPECT_EQ(tile.headers.at("content-type"), "model/gltf-binary");
  EXPECT_NE(tile.headers.at("cache-control").find("immutable"), std::string::npos);
  EXPECT_EQ(tile.headers.at("x-content-type-options"), "nosniff");
  EXPECT_EQ(get("/empty.json").status, 200);
  EXPECT_EQ(get("/empty.json").body, "");
}

TEST_F(Server, SendsNothingButTheFilesOfTheSite) {
  for (const std::string target :
       {"/../outside/secret.txt", "/%2e%2e/outside/secret.txt", "/tiles/../../outside/secret.txt",
        "/..%2foutside%2fsecret.txt", "//../outside/secret.txt", "/tiles/%2e%2e/%2e%2e/outside/secret.txt", "/link.txt",
        "/tiles/out/secret.txt", "/.hidden", "/tiles", "/tiles/", "/pipe.txt", "/nothing.json", "/site.json%00.html",
        "/site.json/", "/..\\outside\\secret.txt"}) {
    const HttpAnswer answer = get(target);
    EXPECT_EQ(answer.status, 404) << target;
    EXPECT_EQ(answer.body.find("secret"), std::string::npos) << target;
  }
  EXPECT_NE(get((folder_ / "outside/secret.txt").string()).status, 200);
}

TEST_F(Server, SendsRangesOfBytes) {
  struct Case {
    std::string range;
    int status;
    std::string body;
    std::string content_range;
  };
  for (const Case& c :
       {Case{"bytes=4-7", 206, "4567", "bytes 4-7/20"}, Case{"bytes=15-", 206, "fghij", "bytes 15-19/20"},
        Case{"bytes=-3", 206, "hij", "bytes 17-19/20"}, Case{"bytes=18-1000", 206, "ij", "bytes 18-19/20"},
        Case{"bytes=0-0", 206, "0", "bytes 0-0/20"}, Case{"bytes=-1000", 206, kTile, "bytes 0-19/20"}}) {
    const HttpAnswer answer = get("/tiles/0_1_2.ab.glb", {"Range: " + c.range});
    EXPECT_EQ(answer.status, c.status) << c.range;
    EXPECT_EQ(answer.body, c.body) << c.range;
    EXPECT_EQ(answer.headers.at("content-range"), c.content_range);
    EXPECT_EQ(answer.headers.at("content-length"), std::to_string(c.body.size()));
  }
  for (const std::string range : {"bytes=20-", "bytes=99-100"}) {
    const HttpAnswer answer = get("/tiles/0_1_2.ab.glb", {"Range: " + range});
    EXPECT_EQ(answer.status, 416) << range;
    EXPECT_EQ(answer.headers.at("content-range"), "bytes */20");
  }
  EXPECT_EQ(get("/tiles/0_1_2.ab.glb", {"Range: bytes=0-1,4-5"}).body, kTile) << "several at once: all of it";
}

TEST_F(Server, KnowsWhatAClientHasAlready) {
  const HttpAnswer first = get("/site.json");
  const std::string tag = first.headers.at("etag");
  const HttpAnswer again = get("/site.json", {"If-None-Match: \"other\", " + tag});
  EXPECT_EQ(again.status, 304);
  EXPECT_EQ(again.body, "");
  EXPECT_EQ(again.headers.at("etag"), tag);
  EXPECT_EQ(get("/site.json", {"Range: bytes=0-1", "If-Range: " + tag}).status, 206);
  write("site/site.json", "another");
  EXPECT_EQ(get("/site.json", {"If-None-Match: " + tag}).body, "another");
  EXPECT_EQ(get("/site.json", {"Range: bytes=0-1", "If-Range: " + tag}).body, "another");
}

TEST_F(Server, CompressesTextForThoseWhoTakeIt) {
  const std::string plain = get("/site.json").body;
  const HttpAnswer gzip = get("/site.json", {"Accept-Encoding: br, gzip"});
  EXPECT_EQ(gzip.headers.at("content-encoding"), "gzip");
  EXPECT_EQ(gzip.headers.at("vary"), "Accept-Encoding");
  EXPECT_LT(gzip.body.size(), plain.size() / 10);
  EXPECT_EQ(gunzip(gzip.body), plain);
  EXPECT_NE(gzip.headers.at("etag"), get("/site.json").headers.at("etag"));
  for (const std::string encoding : {"br", "gzip;q=0", "identity"}) {
    EXPECT_EQ(get("/site.json", {"Accept-Encoding: " + encoding}).body, plain) << encoding;
  }
  EXPECT_EQ(get("/tiles/0_1_2.ab.glb", {"Accept-Encoding: gzip"}).body, kTile) << "compressed already";
  EXPECT_EQ(get("/site.json", {"Accept-Encoding: gzip", "Range: bytes=0-3"}).body, plain.substr(0, 4));
}

TEST_F(Server, TakesNoOtherMethods) {
  EXPECT_EQ(test::http_request(server_->port(), "/site.json", {}, "POST").status, 405);
  EXPECT_EQ(test::http_request(server_->port(), "/site.json", {}, "DELETE").status, 405);
  const HttpAnswer head = test::http_request(server_->port(), "/site.json", {}, "HEAD");
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.body, "");
  EXPECT_EQ(head.headers.at("content-length"), std::to_string(get("/site.json").body.size()));
}

TEST_F(Server, ServesManyAtOnce) {
  const std::string large(3 << 20, 'g');
  write("site/tiles/large.bin", large);
  std::array<bool, 64> is_whole{};
  std::vector<std::thread> clients;
  for (bool& whole : is_whole) {
    clients.emplace_back([&] {
      whole = get("/tiles/large.bin").body == large && get("/site.json", {"Accept-Encoding: gzip"}).status == 200;
    });
  }
  for (std::thread& client : clients) client.join();
  for (const bool whole : is_whole) EXPECT_TRUE(whole);
}

TEST_F(Server, RefusesAPortThatIsTaken) {
  try {
    const SiteServer second(folder_ / "site", {"127.0.0.1", server_->port()});
    ADD_FAILURE() << "two servers share a port";
  } catch (const IoError& error) {
    EXPECT_EQ(error.what(),
              "127.0.0.1:" + std::to_string(server_->port()) + ": cannot serve there: Address already in use");
  }
  EXPECT_EQ(get("/").status, 200);
}

TEST_F(Server, IsReachedFromThisComputerOnly) {
  // Another address of the loopback stands for another way in: the server listens on 127.0.0.1 alone.
  EXPECT_EQ(server_->url(), "http://127.0.0.1:" + std::to_string(server_->port()) + "/");
  const SiteServer beside(folder_ / "site", {"127.0.0.2", server_->port()});
  EXPECT_EQ(beside.port(), server_->port());
}

TEST_F(Server, ServesTheSiteThatTakesItsPlace) {
  std::filesystem::create_directory(folder_ / "new");
  write("new/index.html", "<p>new</p>");
  std::filesystem::rename(folder_ / "site", folder_ / "old");
  std::filesystem::rename(folder_ / "new", folder_ / "site");
  EXPECT_EQ(get("/").body, "<p>new</p>");
}

}  // namespace
}  // namespace vdbmap::cli
