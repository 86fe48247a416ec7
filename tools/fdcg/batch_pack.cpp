// SPDX-License-Identifier: Apache-2.0
#include "batch_pack.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include "batch_process.hpp"
#include "fdcg/results.hpp"

namespace fdcg::tools {
namespace {

namespace fs = std::filesystem;

// A text in a pack: this, the hash of its key and itself, a line's end, itself.
constexpr std::string_view kMagic = "fdcg batch entry 2 ";
constexpr std::size_t kHashDigits = 64, kHead = kMagic.size() + kHashDigits + 1;
// An entry of an index: the key, the offset and the bytes in the pack, in the machine's byte order. One of another order leads
// nowhere.
constexpr std::size_t kIndexBytes = 48;

std::string cannot_write(const std::string& path) {
  return "cannot write '" + path + "': " + std::strerror(errno);
}

bool write_now(std::FILE* file, const std::string& bytes) {
  return std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() && std::fflush(file) == 0;
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

std::optional<std::string> BatchPacks::get(const std::string& key) const {
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
    if (!file.read(record.data(), static_cast<std::streamsize>(record.size())) || !record.starts_with(kMagic)) continue;
    const std::string hash = record.substr(kMagic.size(), kHashDigits);
    record.replace(0, kHead, key);
    if (bake::sha256_of(record) == hash) return record.substr(key.size());
  }
  return std::nullopt;
}

std::string BatchPacks::put(const std::string& key, const std::string& text) {
  if (!pack_)
    if (std::string trouble = begin_pack(); !trouble.empty()) return trouble;
  std::string record = key + text;
  const std::string hash = bake::sha256_of(record);
  record.replace(0, key.size(), std::string(kMagic) + hash + "\n");
  const Place place{static_cast<std::uint32_t>(packs_.size() - 1), written_, record.size()};
  const Key bytes = binary(key);
  std::string entry(bytes.data(), bytes.size());
  entry.append(reinterpret_cast<const char*>(&place.offset), sizeof place.offset);
  entry.append(reinterpret_cast<const char*>(&place.bytes), sizeof place.bytes);
  if (!write_now(pack_.get(), record)) return cannot_write(packs_.back() + ".pack");
  written_ += record.size();
  if (!write_now(index_.get(), entry)) return cannot_write(packs_.back() + ".index");
  places_.emplace(bytes, place);
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
