// SPDX-License-Identifier: Apache-2.0
#include "batch_cache.hpp"

#include <algorithm>
#include <utility>

#include "batch_process.hpp"
#include "fdcg/fdcg.h"
#include "packed_texts.hpp"

namespace fdcg::tools {

std::optional<CacheEntry> BatchCache::load(const std::string& key) const {
  auto found = packs_.get(key);
  auto parts = found ? unpacked(found->text, 2, 2) : std::nullopt;
  if (!parts) return std::nullopt;
  CacheEntry entry;
  entry.exit_code = static_cast<int>(parts->numbers[0]);
  entry.has_output = parts->numbers[1] != 0;
  entry.said = std::move(parts->texts[0]);
  entry.body = std::move(parts->texts[1]);
  entry.output = std::move(found->bytes);
  return entry;
}

void BatchCache::store(const std::string& key, const CacheEntry& entry) {
  if (!trouble_.empty()) return;  // else it would be the same for each mesh
  const std::string text =
      packed({{static_cast<std::size_t>(entry.exit_code), std::size_t{entry.has_output}}, {entry.said, entry.body}});
  trouble_ = packs_.put(key, text, entry.output, entry.output_sha256);
}

std::vector<std::string> BatchCache::references(const std::string& key) const {
  std::vector<std::string> files;
  const auto found = packs_.get(key);
  for (std::size_t at = 0; found && at < found->text.size();) {
    const std::size_t end = std::min(found->text.find('\0', at), found->text.size());
    files.push_back(found->text.substr(at, end - at));
    at = end + 1;
  }
  return files;
}

void BatchCache::store_references(const std::string& key, const std::vector<std::string>& files) {
  std::string content;
  for (const std::string& file : files)
    content.append(file) += '\0';
  if (trouble_.empty()) trouble_ = packs_.put(key, content);
}

std::string program_identity() {
  return std::string(FDCG_VERSION_STRING " format ") + std::to_string(FDCG_FORMAT_VERSION) + " " + build_identity();
}

}  // namespace fdcg::tools
