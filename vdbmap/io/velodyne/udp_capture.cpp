// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/velodyne/udp_capture.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <string>

#include <pcap/pcap.h>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"

namespace vdbmap {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint16_t kEtherTypeIpv4 = 0x0800;
constexpr std::uint16_t kEtherTypeVlan = 0x8100;
constexpr std::uint16_t kEtherTypeServiceVlan = 0x88a8;
constexpr std::uint8_t kProtocolUdp = 17;

std::uint16_t big_endian_16(Bytes bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

std::uint32_t big_endian_32(Bytes bytes, std::size_t at) {
  return static_cast<std::uint32_t>(big_endian_16(bytes, at)) << 16 | big_endian_16(bytes, at + 2);
}

Bytes without_front(Bytes bytes, std::size_t count) { return bytes.size() < count ? Bytes{} : bytes.subspan(count); }

// The packet after a link header whose EtherType stands at `at`; empty unless it is IPv4.
Bytes ipv4_after_ether_type(Bytes frame, std::size_t at) {
  while (frame.size() >= at + 2) {
    const std::uint16_t type = big_endian_16(frame, at);
    if (type == kEtherTypeIpv4) return frame.subspan(at + 2);
    if (type != kEtherTypeVlan && type != kEtherTypeServiceVlan) break;
    at += 4;
  }
  return {};
}

Bytes ipv4_packet(int link_type, Bytes frame) {
  switch (link_type) {
    case DLT_EN10MB:
      return ipv4_after_ether_type(frame, 12);
    case DLT_LINUX_SLL:
      return ipv4_after_ether_type(frame, 14);
    case DLT_LINUX_SLL2:  // the type comes first, the rest of the header is 18 bytes
      return frame.size() >= 20 && big_endian_16(frame, 0) == kEtherTypeIpv4 ? frame.subspan(20) : Bytes{};
    case DLT_NULL:
    case DLT_LOOP:
      return without_front(frame, 4);
    default:
      return frame;
  }
}

bool is_supported(int link_type) {
  switch (link_type) {
    case DLT_EN10MB:
    case DLT_LINUX_SLL:
    case DLT_LINUX_SLL2:
    case DLT_NULL:
    case DLT_LOOP:
    case DLT_RAW:
    case DLT_IPV4:
      return true;
    default:
      return false;
  }
}

std::optional<UdpDatagram> udp_datagram(Bytes ip) {
  if (ip.size() < 20 || ip[0] >> 4 != 4 || ip[9] != kProtocolUdp) return std::nullopt;
  const bool is_fragment = (big_endian_16(ip, 6) & 0x3fff) != 0;
  const std::size_t header_size = (ip[0] & 0x0f) * std::size_t{4};
  if (is_fragment || header_size < 20) return std::nullopt;

  const Bytes udp = without_front(ip, header_size);
  if (udp.size() < 8 || big_endian_16(udp, 4) < 8) return std::nullopt;

  UdpDatagram datagram;
  datagram.source.address = big_endian_32(ip, 12);
  datagram.source.destination_port = big_endian_16(udp, 2);
  datagram.full_size = big_endian_16(udp, 4) - std::size_t{8};
  datagram.payload = udp.subspan(8, std::min(datagram.full_size, udp.size() - 8));
  return datagram;
}

}  // namespace

void UdpCapture::Closer::operator()(pcap* capture) const { pcap_close(capture); }

UdpCapture::UdpCapture(const std::filesystem::path& path) {
  check_regular_file(path);
  // Opened here, because pcap_open_offline() takes "-" for the standard input.
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) throw IoError::system(path, "cannot open", errno);

  std::array<char, PCAP_ERRBUF_SIZE> reason{};
  capture_.reset(pcap_fopen_offline(file, reason.data()));
  if (!capture_) {
    std::fclose(file);
    throw IoError::malformed(path, "not a packet capture: " + std::string(reason.data()));
  }
  link_type_ = pcap_datalink(capture_.get());
  if (!is_supported(link_type_)) {
    throw IoError::malformed(path, "link layer " + std::to_string(link_type_) +
                                       " is not supported, expected Ethernet, raw IP, loopback or Linux cooked");
  }
}

std::optional<UdpDatagram> UdpCapture::next() {
  while (damage_.empty()) {
    pcap_pkthdr* header = nullptr;
    const std::uint8_t* bytes = nullptr;
    const int status = pcap_next_ex(capture_.get(), &header, &bytes);
    if (status == PCAP_ERROR_BREAK) return std::nullopt;
    ++packet_number_;
    if (status != 1) {
      damage_ = "packet " + std::to_string(packet_number_) + ": " + pcap_geterr(capture_.get());
      break;
    }

    const auto datagram = udp_datagram(ipv4_packet(link_type_, Bytes(bytes, header->caplen)));
    if (datagram) return datagram;
  }
  return std::nullopt;
}

}  // namespace vdbmap
