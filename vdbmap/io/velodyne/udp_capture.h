// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

struct pcap;

namespace vdbmap {

/// Who sends, and to which port.
struct UdpSource {
  std::uint32_t address = 0;
  std::uint16_t destination_port = 0;

  bool operator==(const UdpSource&) const = default;
};

/// One UDP datagram of a capture.
struct UdpDatagram {
  UdpSource source;
  std::size_t full_size = 0;              ///< [bytes] of the payload when it was sent
  std::span<const std::uint8_t> payload;  ///< the part that was captured; valid until the next call of next()
};

/// The unfragmented IPv4 UDP datagrams of a .pcap or .pcapng file in their order; other traffic is passed over.
class UdpCapture {
 public:
  /// Throws IoError where the file cannot be opened, is no capture or has another link layer than Ethernet, raw IP,
  /// loopback or Linux cooked.
  explicit UdpCapture(const std::filesystem::path& path);

  /// The next datagram, nothing at the end, which comes early where the file is cut off or damaged.
  std::optional<UdpDatagram> next();

  /// Why the end came early: "packet 75: truncated dump file ..."; empty at the end of a whole file.
  const std::string& damage() const { return damage_; }

  /// Number of the packet that next() read last, from 1.
  std::uint64_t packet_number() const { return packet_number_; }

 private:
  struct Closer {
    void operator()(pcap* capture) const;
  };

  std::unique_ptr<pcap, Closer> capture_;
  std::string damage_;
  int link_type_ = 0;
  std::uint64_t packet_number_ = 0;
};

}  // namespace vdbmap
