// SPDX-License-Identifier: Apache-2.0
// Numbers and texts of any bytes as one text, for files and channels of our own.
#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fdcg::tools {

struct PackedTexts {
  std::vector<std::size_t> numbers;
  std::vector<std::string> texts;
};

inline std::string packed(const PackedTexts& parts) {
  std::string out;
  for (const std::size_t number : parts.numbers)
    out += std::to_string(number) + ' ';
  for (const std::string& text : parts.texts)
    out += std::to_string(text.size()) + ' ';
  for (const std::string& text : parts.texts)
    out += text;
  return out;
}

// Nothing where `text` is not so many numbers and texts, and no more.
inline std::optional<PackedTexts> unpacked(std::string_view text, std::size_t numbers, std::size_t texts) {
  std::vector<std::size_t> values(numbers + texts);
  for (std::size_t& value : values) {
    const auto [stopped, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const auto length = static_cast<std::size_t>(stopped - text.data());
    if (error != std::errc{} || length >= text.size() || *stopped != ' ') return std::nullopt;
    text.remove_prefix(length + 1);
  }
  PackedTexts parts;
  for (std::size_t i = 0; i < texts; ++i) {
    const std::size_t bytes = values[numbers + i];
    if (bytes > text.size()) return std::nullopt;
    parts.texts.emplace_back(text.substr(0, bytes));
    text.remove_prefix(bytes);
  }
  values.resize(numbers);
  parts.numbers = std::move(values);
  return text.empty() ? std::optional(std::move(parts)) : std::nullopt;
}

}  // namespace fdcg::tools
