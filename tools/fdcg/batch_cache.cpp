// SPDX-License-Identifier: Apache-2.0
#include "batch_cache.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>

#include "../common/atomic_file.hpp"
#include "batch_process.hpp"
#include "fdcg/results.hpp"
#include "fdcg/fdcg.h"
#include "packed_texts.hpp"

namespace fdcg::tools {
namespace {

namespace fs = std::filesystem;

// An entry: this line with the hash of all that follows.
constexpr std::string_view kMagic = "fdcg batch entry 1 ";
constexpr std::size_t kHashDigits = 64;

// What a whole entry says after its hash; nothing where it is not whole.
std::optional<std::string> checked_content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  std::ostringstream all;
  all << file.rdbuf();
  const std::string text = std::move(all).str();
  const std::size_t head = kMagic.size() + kHashDigits + 1;
  if (text.size() < head || !text.starts_with(kMagic) || text[head - 1] != '\n') return std::nullopt;
  std::string content = text.substr(head);
  if (bake::sha256_of(content) != std::string_view(text).substr(kMagic.size(), kHashDigits)) return std::nullopt;
  return content;
}

}  // namespace

std::string BatchCache::path_of(const std::string& key) const {
  return folder_ + "/" + key.substr(0, 2) + "/" + key.substr(2);
}

std::optional<CacheEntry> BatchCache::load(const std::string& key) const {
  const auto content = checked_content(path_of(key));
  if (!content) return std::nullopt;
  auto parts = unpacked(*content, 2, 3);
  if (!parts) return std::nullopt;
  return CacheEntry{static_cast<int>(parts->numbers[0]), std::move(parts->texts[0]), std::move(parts->texts[1]),
                    std::move(parts->texts[2]), parts->numbers[1] != 0};
}

void BatchCache::store(const std::string& key, const CacheEntry& entry) {
  write(key, packed({{static_cast<std::size_t>(entry.exit_code), std::size_t{entry.has_output}},
                     {entry.said, entry.body, entry.output}}));
}

std::vector<std::string> BatchCache::references(const std::string& key) const {
  std::vector<std::string> files;
  const auto content = checked_content(path_of(key));
  for (std::size_t at = 0; content && at < content->size();) {
    const std::size_t end = std::min(content->find('\0', at), content->size());
    files.push_back(content->substr(at, end - at));
    at = end + 1;
  }
  return files;
}

void BatchCache::store_references(const std::string& key, const std::vector<std::string>& files) {
  std::string content;
  for (const std::string& file : files)
    content.append(file) += '\0';
  write(key, content);
}

void BatchCache::write(const std::string& key, const std::string& content) {
  if (!trouble_.empty()) return;  // it would be the same for each mesh
  const std::string path = path_of(key);
  std::error_code error;
  for (const fs::path& folder : {fs::path(path).parent_path(), fs::path(folder_) / "unfinished"})
    if (!error) fs::create_directories(folder, error);
  if (error) {
    trouble_ = "cannot make folders in '" + folder_ + "': " + error.message();
    return;
  }
  AtomicFile file(path, folder_ + "/unfinished/" + unique_name() + "-" + std::to_string(written_++));
  file.write(kMagic);
  file.write(bake::sha256_of(content) + "\n");
  file.write(content);
  if (!file.commit()) trouble_ = file.error();
}

void BatchCache::sweep() const {
  std::error_code ignored;
  const auto yesterday = fs::file_time_type::clock::now() - std::chrono::hours(24);
  for (fs::directory_iterator entry(folder_ + "/unfinished", ignored), end; !ignored && entry != end; entry.increment(ignored)) {
    std::error_code error;
    if (fs::last_write_time(entry->path(), error) < yesterday && !error) fs::remove(entry->path(), error);
  }
}

std::string program_identity() {
  return std::string(FDCG_VERSION_STRING " format ") + std::to_string(FDCG_FORMAT_VERSION) + " " + build_identity();
}

}  // namespace fdcg::tools
