// SPDX-License-Identifier: Apache-2.0
#include "session/session_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

namespace fdcg::dev {
namespace {

constexpr std::size_t kFixedHeaderBytes = sizeof kSessionMagic + 8;  // magic, version, length
constexpr std::size_t kMostHeaderBytes = 64'000'000;
constexpr std::size_t kMostRecordBytes = kRecordFrameBytes + kMostTickBytes;
constexpr std::size_t kBytesOfEnd = 16;  // a device
constexpr std::size_t kPieceBytes = 1 << 16;

std::uint64_t get(const std::uint8_t* from, std::size_t bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i)
    value |= static_cast<std::uint64_t>(from[i]) << (8 * i);
  return value;
}

// False where the text is not what encode_session_header makes.
bool parse_header(const std::string& text, SessionHeader* header) {
  using nlohmann::json;
  const json body = json::parse(text, nullptr, false);
  if (!body.is_object()) return false;
  try {
    header->program = body.at("program").get<std::string>();
    header->scene_file = body.at("scene_file").get<std::string>();
    header->scene = body.at("scene").get<std::string>();
    for (const json& graph : body.at("graphs"))
      header->graphs.push_back({graph.at("file").get<std::string>(), graph.at("bytes").get<std::uint64_t>(),
                                graph.at("checksum").get<std::uint64_t>()});
  } catch (const json::exception&) {
    return false;
  }
  return true;
}

std::string no_log(const std::string& path, const std::string& why) {
  return path + ": not a session's log: " + why;
}

}  // namespace

bool is_session_log(const std::string& path) {
  std::FILE* const file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return false;
  char magic[sizeof kSessionMagic] = {};
  const bool is_read = std::fread(magic, 1, sizeof magic, file) == sizeof magic;
  std::fclose(file);
  return is_read && std::memcmp(magic, kSessionMagic, sizeof magic) == 0;
}

SessionReader::SessionReader() = default;

SessionReader::~SessionReader() {
  if (file_ != nullptr) std::fclose(file_);
}

std::string SessionReader::open(const std::string& path) {
  errno = 0;
  std::FILE* const file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return "cannot read '" + path + "': " + std::strerror(errno);
  return open(file, path);
}

std::string SessionReader::open(std::FILE* file, const std::string& path) {
  file_ = file;
  path_ = path;
  errno = 0;
  bytes_.resize(kFixedHeaderBytes);
  const std::size_t got = std::fread(bytes_.data(), 1, bytes_.size(), file_);
  if (got == 0 && std::ferror(file_) != 0) return "cannot read '" + path + "': " + std::strerror(errno);
  if (got < bytes_.size() || std::memcmp(bytes_.data(), kSessionMagic, sizeof kSessionMagic) != 0) {
    return no_log(path, "it does not begin as one");
  }
  const std::uint64_t version = get(bytes_.data() + 8, 4), text_bytes = get(bytes_.data() + 12, 4);
  if (version != kSessionVersion) {
    return path + ": version " + std::to_string(version) + " of the session log; this program reads version " +
           std::to_string(kSessionVersion) + ": use the fdcg-servo that wrote it";
  }
  if (text_bytes > kMostHeaderBytes) {
    return path + ": byte 12: a header of " + std::to_string(text_bytes) + " bytes; at most " +
           std::to_string(kMostHeaderBytes) + ": the file is damaged";
  }
  const std::size_t header_bytes = kFixedHeaderBytes + text_bytes + 8;
  if (!read_up_to(header_bytes)) {
    return path + ": the header has " + std::to_string(header_bytes) + " bytes, the file ends after " +
           std::to_string(bytes_.size()) + ": nothing of the session is left";
  }
  const std::uint64_t checksum = get(bytes_.data() + bytes_.size() - 8, 8);
  const std::string text(reinterpret_cast<const char*>(bytes_.data()) + kFixedHeaderBytes, text_bytes);
  if (checksum != fdcg_checksum(bytes_.data(), bytes_.size() - 8) || !parse_header(text, &header_)) {
    return path + ": the header's bytes have changed since they were written (checksum): nothing of the session can be used";
  }
  offset_ = bytes_.size();
  bytes_.reserve(kMostRecordBytes);
  return {};
}

// In pieces: a damaged length costs no more memory than the file has bytes.
bool SessionReader::read_up_to(std::size_t bytes) {
  while (bytes_.size() < bytes) {
    const std::size_t had = bytes_.size(), piece = std::min(bytes - had, kPieceBytes);
    bytes_.resize(had + piece);
    const std::size_t got = std::fread(bytes_.data() + had, 1, piece, file_);
    bytes_.resize(had + got);
    if (got < piece) return false;
  }
  return true;
}

bool SessionReader::ends(Ending ending, const std::string& why) {
  ending_ = ending;
  if (ending != Ending::kEnded) damage_ = path_ + ": byte " + std::to_string(offset_) + ": " + why;
  return false;
}

// Fills record_ with the next record, whatever its kind.
bool SessionReader::read_record() {
  bytes_.resize(4);
  std::size_t got = std::fread(bytes_.data(), 1, 4, file_);
  if (got == 0 && std::ferror(file_) != 0) return ends(Ending::kDamaged, std::strerror(errno));
  if (got == 0)
    return ends(Ending::kUnclosed,
                "the log ends here without its last record: the program that wrote it was "
                "ended or the disk was full");
  const std::uint64_t length = got == 4 ? get(bytes_.data(), 4) : 0;
  if (got == 4 && (length < kRecordFrameBytes || length > kMostRecordBytes)) {
    return ends(Ending::kDamaged, "a record of " + std::to_string(length) + " bytes; " + std::to_string(kRecordFrameBytes) +
                                      " to " + std::to_string(kMostRecordBytes) + ": the file is damaged from here on");
  }
  if (got == 4) {
    bytes_.resize(static_cast<std::size_t>(length));
    got += std::fread(bytes_.data() + 4, 1, bytes_.size() - 4, file_);
  }
  if (got < std::max<std::uint64_t>(length, 5)) return ends(Ending::kDamaged, "the file ends within a record");
  if (get(bytes_.data() + bytes_.size() - 8, 8) != fdcg_checksum(bytes_.data(), bytes_.size() - 8)) {
    return ends(Ending::kDamaged, "a record whose bytes have changed since they were written (checksum)");
  }
  record_.kind = static_cast<RecordKind>(get(bytes_.data() + 4, 2));
  record_.device = static_cast<std::uint16_t>(get(bytes_.data() + 6, 2));
  record_.tick = get(bytes_.data() + 8, 8);
  record_.payload = bytes_.data() + 16;
  record_.payload_bytes = bytes_.size() - kRecordFrameBytes;
  return true;
}

bool SessionReader::read_end(const SessionRecord& record) {
  if (record.payload_bytes != 1 + kBytesOfEnd * record.device || record.payload[0] > 1) {
    return ends(Ending::kDamaged, "the last record does not fit the number of devices");
  }
  end_.reason = static_cast<EndReason>(record.payload[0]);
  for (std::size_t i = 0; i < record.device; ++i) {
    end_.ticks.push_back(get(record.payload + 1 + kBytesOfEnd * i, 8));
    end_.dropped.push_back(get(record.payload + 9 + kBytesOfEnd * i, 8));
  }
  offset_ += bytes_.size();
  if (std::fgetc(file_) != EOF) return ends(Ending::kDamaged, "there is more after the last record");
  return ends(Ending::kEnded, "");
}

bool SessionReader::next(SessionRecord* record) {
  if (ending_ != Ending::kNotYet || !read_record()) return false;
  if (record_.kind == RecordKind::kEnd) return read_end(record_);
  if (record_.kind != RecordKind::kTick) return ends(Ending::kDamaged, "a record of a kind that there is not");
  offset_ += bytes_.size();
  *record = record_;
  return true;
}

}  // namespace fdcg::dev
