// SPDX-License-Identifier: Apache-2.0
// The bytes of a session's log around its ticks (tick_bytes.cpp has those): header, record, end.
#include <nlohmann/json.hpp>

#include "session/session_reader.hpp"

namespace fdcg::dev {
namespace {

template <class T>
void put(std::uint8_t* to, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i)
    to[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i));
}

template <class T>
void append(std::string* text, T value) {
  std::uint8_t bytes[sizeof(T)];
  put(bytes, value);
  text->append(reinterpret_cast<const char*>(bytes), sizeof bytes);
}

}  // namespace

std::string encode_session_header(const SessionHeader& header) {
  nlohmann::json body;
  body["program"] = header.program;
  body["scene_file"] = header.scene_file;
  body["scene"] = header.scene;
  body["graphs"] = nlohmann::json::array();
  for (const SessionGraph& graph : header.graphs)
    body["graphs"].push_back({{"file", graph.file}, {"bytes", graph.bytes}, {"checksum", graph.checksum}});
  // a path may hold bytes that are no UTF-8
  const std::string text = body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string bytes(kSessionMagic, sizeof kSessionMagic);
  append(&bytes, kSessionVersion);
  append(&bytes, static_cast<std::uint32_t>(text.size()));
  bytes += text;
  append(&bytes, fdcg_checksum(bytes.data(), bytes.size()));
  return bytes;
}

std::size_t encode_record(RecordKind kind, std::uint16_t device, std::uint64_t tick, const std::uint8_t* payload,
                          std::size_t payload_bytes, std::uint8_t* to) {
  const std::size_t bytes = kRecordFrameBytes + payload_bytes;
  put(to, static_cast<std::uint32_t>(bytes));
  put(to + 4, static_cast<std::uint16_t>(kind));
  put(to + 6, device);
  put(to + 8, tick);
  for (std::size_t i = 0; i < payload_bytes; ++i)
    to[16 + i] = payload[i];
  put(to + bytes - 8, fdcg_checksum(to, bytes - 8));
  return bytes;
}

std::string encode_end(const SessionEnd& end) {
  std::string payload;
  append(&payload, static_cast<std::uint8_t>(end.reason));
  for (std::size_t i = 0; i < end.ticks.size(); ++i) {
    append(&payload, end.ticks[i]);
    append(&payload, end.dropped[i]);
  }
  std::string bytes(kRecordFrameBytes + payload.size(), '\0');
  encode_record(RecordKind::kEnd, static_cast<std::uint16_t>(end.ticks.size()), 0,
                reinterpret_cast<const std::uint8_t*>(payload.data()), payload.size(),
                reinterpret_cast<std::uint8_t*>(bytes.data()));
  return bytes;
}

}  // namespace fdcg::dev
