// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/http_request.h"

#include <cstdint>
#include <sstream>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "vdbmap/io/file/text.h"

namespace vdbmap::test {
namespace {

std::string answer_to(int port, const std::string& request) {
  const int connection = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  std::string answer;
  if (::connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0 &&
      ::send(connection, request.data(), request.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(request.size())) {
    char buffer[65536];
    for (ssize_t size; (size = ::recv(connection, buffer, sizeof(buffer), 0)) > 0;) {
      answer.append(buffer, static_cast<std::size_t>(size));
    }
  }
  ::close(connection);
  return answer;
}

}  // namespace

HttpAnswer http_request(int port, const std::string& target, const std::vector<std::string>& headers,
                        const std::string& method) {
  std::string request = method + " " + target + " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n";
  for (const std::string& header : headers) request += header + "\r\n";
  const std::string text = answer_to(port, request + "\r\n");

  HttpAnswer answer;
  const std::size_t end = text.find("\r\n\r\n");
  if (end == std::string::npos) return answer;
  std::istringstream lines(text.substr(0, end));
  std::string line;
  std::getline(lines, line);
  answer.status = std::stoi(line.substr(line.find(' ')));
  while (std::getline(lines, line)) {
    const std::size_t colon = line.find(": ");
    if (line.ends_with('\r')) line.pop_back();
    answer.headers[lower_case(line.substr(0, colon))] = line.substr(colon + 2);
  }
  answer.body = text.substr(end + 4);
  return answer;
}

}  // namespace vdbmap::test
