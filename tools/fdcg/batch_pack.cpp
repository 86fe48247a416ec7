// SPDX-License-Identifier: Apache-2.0
#include "batch_pack.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string_view>
#include <system_error>

#include "batch_process.hpp"
#include "fdcg/results.hpp"

namespace fdcg::tools {
namespace {

namespace fs = std::filesystem;

// A text in a pack: this, the hash of its key, itself and the hash of its bytes, how many bytes, a line's end, itself, the
// bytes.
constexpr std::string_view kMagic = "fdcg batch entry 3 ";
constexpr std::size_t kHashDigits = 64, kSizeDigits = 16, kHead = kMagic.size() + kHashDigits + 1 + kSizeDigits + 1;
// An entry of an index: the key, the offset and the bytes in the pack, in the machine's byte order. One of another order leads
// nowhere.
constexpr std::size_t kIndexBytes = 48;

std::string cannot_write(const std::string& path) {
  return "cannot write '" + path + "': " + std::strerror(errno);
}

bool write_now(std::FILE* file, std::initializer_list<std::string_view> pieces) {
  for (const std::string_view piece : pieces)
    if (std::fwrite(piece.data(), 1, piece.size(), file) != piece.size()) return false;
  return std::fflush(file) == 0;
}

std::string head_of(const std::string& hash, std::size_t bytes) {
  std::array<char, kSizeDigits + 1> size{};
  std::snprintf(size.data(), size.size(), "%016llx", static_cast<unsigned long long>(bytes));
  return std::string(kMagic) + hash + ' ' + size.data() + '\n';
}

std::string hash_of(const std::string& key, const std::string& text, const std::string& sha256) {
  return bake::sha256_of(key + text + sha256);
}

}  // namespace

std::size_t BatchPacks::KeyHash::operator()(const Key& key) const {
  std::size_t hash = 0;  // its bytes are those of a hash already
  std::memcpy(&hash, key.data(), sizeof hash);
  return hash;
}

BatchPacks::Key BatchPacks::binary(const std::string& key) {
  const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  Key bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<char>(digit(key.at(2 * i)) << 4 | digit(key.at(2 * i + 1)));
  return bytes;
}

BatchPacks::BatchPacks(std::string folder) : folder_(std::move(folder)) {
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error))
    if (entry->path().extension() == ".index") read_index((entry->path().parent_path() / entry->path().stem()).string());
}

void BatchPacks::read_index(const std::string& pack) {
  std::ifstream file(pack + ".index", std::ios::binary);
  std::array<char, kIndexBytes> bytes{};
  const auto number = static_cast<std::uint32_t>(packs_.size());
  while (file.read(bytes.data(), kIndexBytes)) {  // a cut one at the end is none
    Key key{};
    Place place{number, 0, 0};
    std::memcpy(key.data(), bytes.data(), key.size());
    std::memcpy(&place.offset, bytes.data() + key.size(), sizeof place.offset);
    std::memcpy(&place.bytes, bytes.data() + key.size() + sizeof place.offset, sizeof place.bytes);
    places_.emplace(key, place);
  }
  packs_.push_back(pack);
}

std::optional<PackedText> BatchPacks::get(const std::string& key) const {
  const auto [first, last] = places_.equal_range(binary(key));
  for (auto at = first; at != last; ++at) {
    const Place& place = at->second;
    const std::string path = packs_[place.pack] + ".pack";
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error);
    if (error || place.offset > size || place.bytes > size - place.offset || place.bytes < kHead) continue;
    std::string record(place.bytes, '\0');
    std::ifstream file(path, std::ios::binary);
    file.seekg(static_cast<std::streamoff>(place.offset));
    if (!file.read(record.data(), static_cast<std::streamsize>(record.size()))) continue;
    std::size_t bytes = 0;
    const char* const digits = record.data() + kHead - 1 - kSizeDigits;
    if (std::from_chars(digits, digits + kSizeDigits, bytes, 16).ec != std::errc{} || bytes > record.size() - kHead) continue;
    PackedText found{record.substr(kHead, record.size() - kHead - bytes), record.substr(record.size() - bytes)};
    const std::string sha256 = found.bytes.empty() ? std::string() : bake::sha256_of(found.bytes);
    if (record.starts_with(head_of(hash_of(key, found.text, sha256), bytes))) return found;
  }
  return std::nullopt;
}

std::string BatchPacks::put(const std::string& key, const std::string& text, const std::string& bytes,
                            const std::string& sha256) {
  if (!pack_)
    if (std::string trouble = begin_pack(); !trouble.empty()) return trouble;
  const std::string head = head_of(hash_of(key, text, bytes.empty() ? std::string() : sha256), bytes.size());
  const Place place{static_cast<std::uint32_t>(packs_.size() - 1), written_, head.size() + text.size() + bytes.size()};
  const Key name = binary(key);
  std::string entry(name.data(), name.size());
  entry.append(reinterpret_cast<const char*>(&place.offset), sizeof place.offset);
  entry.append(reinterpret_cast<const char*>(&place.bytes), sizeof place.bytes);
  if (!write_now(pack_.get(), {head, text, bytes})) return cannot_write(packs_.back() + ".pack");
  written_ += place.bytes;
  if (!write_now(index_.get(), {entry})) return cannot_write(packs_.back() + ".index");
  places_.emplace(name, place);
  return {};
}

// Why there is none, or nothing. Files that are there already, of a process of the same name, stay as they are.
std::string BatchPacks::begin_pack() {
  constexpr int kTries = 1000;
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) return "cannot make the folder '" + folder_ + "': " + error.message();
  for (int i = 0;; ++i) {
    const std::string name = folder_ + "/" + unique_name() + "-" + std::to_string(i);
    pack_.reset(std::fopen((name + ".pack").c_str(), "wbx"));
    if (!pack_ && (errno != EEXIST || i == kTries)) return cannot_write(name + ".pack");
    if (!pack_) continue;
    index_.reset(std::fopen((name + ".index").c_str(), "wbx"));
    if (!index_) return cannot_write(name + ".index");
    packs_.push_back(name);
    return {};
  }
}

}  // namespace fdcg::tools
