// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/capture_reader.hpp"

#include <fmt/format.h>
#include <pcap/pcap.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include "driver/core/error.hpp"
#include "pcap/classic_records.hpp"
#include "pcap/ip_packet.hpp"
#include "pcap/link_layer.hpp"

namespace glint {
namespace {

struct PcapCloser {
  void operator()(pcap_t* capture) const { pcap_close(capture); }
};
using PcapHandle = std::unique_ptr<pcap_t, PcapCloser>;

/// Judges the file, names its link type, and reads what is not classic.
PcapHandle open_capture(const std::filesystem::path& file) {
  std::FILE* const stream = std::fopen(file.c_str(), "rb");
  std::array<char, PCAP_ERRBUF_SIZE> message{};
  // A folder opens, but cannot be read, which libpcap says of no format.
  const int first = stream != nullptr ? std::fgetc(stream) : EOF;
  if (stream == nullptr || std::ferror(stream) != 0) {
    const std::string reason = std::strerror(errno);
    if (stream != nullptr) std::fclose(stream);
    throw InputError(
        fmt::format("The capture {} cannot be read: {}; check the path and its rights.",
                    file.string(), reason));
  }
  std::ungetc(first, stream);
  PcapHandle capture(
      pcap_fopen_offline_with_tstamp_precision(stream, PCAP_TSTAMP_PRECISION_NANO, message.data()));
  if (capture == nullptr) {
    std::fclose(stream);
    throw InputError(
        fmt::format("{} is no pcap or pcapng capture ({}); give a file that tcpdump, "
                    "Wireshark or the sensor's tools recorded.",
                    file.string(), message.data()));
  }
  return capture;
}

std::string link_type_name(int dlt) {
  const char* const name = pcap_datalink_val_to_name(dlt);
  return name != nullptr ? name : fmt::format("DLT {}", dlt);
}

LinkType known_link_type(const std::filesystem::path& file, int dlt) {
  const std::optional<LinkType> type = link_type_of(dlt);
  if (type) return *type;
  throw InputError(
      fmt::format("{} was captured with link type {}, which carries no IP that can be "
                  "read here; capture on an Ethernet, loopback or \"any\" interface.",
                  file.string(), link_type_name(dlt)));
}

}  // namespace

struct CaptureReader::Impl {
  explicit Impl(std::filesystem::path path)
      : file(std::move(path)),
        capture(open_capture(file)),
        link_type(known_link_type(file, pcap_datalink(capture.get()))),
        link_name(link_type_name(pcap_datalink(capture.get()))),
        classic(ClassicRecords::open(file)) {}

  /// The next record, or null at the end of the file or where it breaks off.
  const CaptureRecord* read_record();
  /// The same of a file that is not classic.
  const CaptureRecord* read_by_libpcap();
  /// What the record holds of a UDP datagram: it, or the one it completes. Empty if nothing.
  Bytes udp_of(Bytes record, HostTime time, IpPacket& packet);
  /// Counts what is no datagram. True if `datagram` was set.
  bool take(const CaptureRecord& record);

  const std::filesystem::path file;
  const PcapHandle capture;
  const LinkType link_type;
  const std::string link_name;
  std::optional<ClassicRecords> classic;
  CaptureRecord libpcap_record{};
  std::string libpcap_fault;
  std::string problem;
  bool ended = false;
  CaptureCounters counters;
  IpReassembler reassembler;
  Datagram datagram;
};

const CaptureRecord* CaptureReader::Impl::read_by_libpcap() {
  pcap_pkthdr* header = nullptr;
  const u_char* data = nullptr;
  const int status = pcap_next_ex(capture.get(), &header, &data);
  if (status == 1) {
    // With nanosecond precision tv_usec holds nanoseconds.
    libpcap_record = {{header->ts.tv_sec * kNsPerSecond + header->ts.tv_usec},
                      {data, header->caplen}};
    return &libpcap_record;
  }
  if (status != PCAP_ERROR_BREAK) libpcap_fault = pcap_geterr(capture.get());
  return nullptr;
}

const CaptureRecord* CaptureReader::Impl::read_record() {
  if (ended) return nullptr;
  if (const CaptureRecord* const record = classic ? classic->next() : read_by_libpcap()) {
    ++counters.records;
    return record;
  }
  ended = true;
  reassembler.finish();
  const std::string& fault = classic ? classic->fault() : libpcap_fault;
  if (!fault.empty()) {
    problem =
        fmt::format("The capture {} breaks off after {} records ({}); what came before is used.",
                    file.string(), counters.records, fault);
  }
  return nullptr;
}

Bytes CaptureReader::Impl::udp_of(Bytes record, HostTime time, IpPacket& packet) {
  const LinkStatus link = strip_link_header(link_type, record);
  const ParseStatus ip = link == LinkStatus::kIp          ? parse_ip(record, packet)
                         : link == LinkStatus::kTruncated ? ParseStatus::kTruncated
                                                          : ParseStatus::kOther;
  if (ip == ParseStatus::kTruncated) {
    ++counters.truncated_records;
  } else if (ip == ParseStatus::kMalformed) {
    ++counters.malformed_records;
  } else if (ip == ParseStatus::kOther || packet.protocol != kProtocolUdp) {
    ++counters.other_protocols;
  } else if (packet.is_fragment) {
    ++counters.fragments;
    return reassembler.push(packet, time);
  } else {
    ++counters.whole_datagrams;
    return packet.payload;
  }
  return {};
}

bool CaptureReader::Impl::take(const CaptureRecord& record) {
  IpPacket packet;
  const Bytes bytes = udp_of(record.bytes, record.time, packet);
  if (bytes.data() == nullptr) return false;
  UdpDatagram udp;
  const ParseStatus status = parse_udp(bytes, udp);
  if (status != ParseStatus::kOk) {
    // The record was counted as a datagram, or as a fragment of one, in good faith.
    --(packet.is_fragment ? counters.fragments : counters.whole_datagrams);
    ++(status == ParseStatus::kTruncated ? counters.truncated_records : counters.malformed_records);
    return false;
  }
  datagram = {record.time,
              {packet.source, udp.source_port},
              {packet.destination, udp.destination_port},
              std::as_bytes(udp.payload)};
  return true;
}

CaptureReader::CaptureReader(std::filesystem::path file)
    : impl_(std::make_unique<Impl>(std::move(file))) {}
CaptureReader::~CaptureReader() = default;

const Datagram* CaptureReader::next() {
  while (const CaptureRecord* const record = impl_->read_record()) {
    if (impl_->take(*record)) return &impl_->datagram;
  }
  return nullptr;
}

CaptureCounters CaptureReader::counters() const {
  CaptureCounters counters = impl_->counters;
  counters.reassembly = impl_->reassembler.counters();
  return counters;
}

const std::string& CaptureReader::link_type() const { return impl_->link_name; }
const std::string& CaptureReader::problem() const { return impl_->problem; }
const std::filesystem::path& CaptureReader::file() const { return impl_->file; }

}  // namespace glint
