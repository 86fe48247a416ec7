// SPDX-License-Identifier: Apache-2.0
#include "batch_cache.hpp"

#include <algorithm>
#include <utility>

#include "batch_process.hpp"
#include "fdcg/fdcg.h"
#include "packed_texts.hpp"

namespace fdcg::tools {

std::optional<CacheEntry> BatchCache::load(const std::string& key) const {
  const auto content = packs_.get(key);
  if (!content) return std::nullopt;
  auto parts = unpacked(*content, 2, 3);
  if (!parts) return std::nullopt;
  return CacheEntry{static_cast<int>(parts->numbers[0]), std::move(parts->texts[0]), std::move(parts->texts[1]),
                    std::move(parts->texts[2]), parts->numbers[1] != 0};
}

void BatchCache::store(const std::string& key, const CacheEntry& entry) {
  put(key, packed({{static_cast<std::size_t>(entry.exit_code), std::size_t{entry.has_output}},
                   {entry.said, entry.body, entry.output}}));
}

std::vector<std::string> BatchCache::references(const std::string& key) const {
  std::vector<std::string> files;
  const auto content = packs_.get(key);
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
  put(key, content);
}

void BatchCache::put(const std::string& key, const std::string& content) {
  if (trouble_.empty()) trouble_ = packs_.put(key, content);  // else it would be the same for each mesh
}

std::string program_identity() {
  return std::string(FDCG_VERSION_STRING " format ") + std::to_string(FDCG_FORMAT_VERSION) + " " + build_identity();
}

}  // namespace fdcg::tools
