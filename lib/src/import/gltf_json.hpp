// SPDX-License-Identifier: Apache-2.0
// JSON values that know where they stand, so that each complaint names its place: "meshes[2].primitives[0].mode: ...".
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "import/gltf_document.hpp"

namespace fdcg::bake::gltf {

// A view of a value, for use on the stack: it points to the value that it was found in. All but path() throw Refusal where the
// file is not as it should be.
class Value {
 public:
  explicit Value(const nlohmann::json& root) : json_(&root) {}

  [[nodiscard]] std::string path() const;
  [[noreturn]] void fail(const std::string& what) const;

  // ---- of an object
  [[nodiscard]] std::optional<Value> find(std::string_view key) const&;
  [[nodiscard]] Value at(std::string_view key) const&;  // which must be there
  std::optional<Value> find(std::string_view key) const&& = delete;
  Value at(std::string_view key) const&& = delete;

  // ---- of an array
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] Value item(std::size_t index) const&;
  Value item(std::size_t index) const&& = delete;

  // ---- scalars
  [[nodiscard]] std::uint64_t whole() const;  // 0 or more, below 2^53
  [[nodiscard]] double number() const;
  [[nodiscard]] const std::string& text() const;
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] std::string shown() const;  // for messages: a string or number, cut to 64 bytes
  // The number of one of `count` things.
  [[nodiscard]] Index index_of(std::size_t count, const char* things) const;

  // ---- of an object, with a default
  [[nodiscard]] std::uint64_t whole_or(std::string_view key, std::uint64_t fallback) const;

 private:
  Value(const nlohmann::json& json, const Value& parent, std::string_view key, std::size_t index)
      : json_(&json), parent_(&parent), key_(key), index_(index) {}

  const nlohmann::json* json_;
  const Value* parent_ = nullptr;
  std::string_view key_;  // of a member; empty for an item
  std::size_t index_ = 0;
};

// Throws Refusal on a text that is no JSON or nested deeper than 128 levels.
nlohmann::json parse_json(std::string_view text);

}  // namespace fdcg::bake::gltf
