// SPDX-License-Identifier: Apache-2.0
// A plugin's settings: an object of JSON, as the scene has it.
#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace fdcg::plugin {

class Settings {
 public:
  // Throws std::runtime_error with one line.
  Settings(const char* text, std::initializer_list<const char*> keys) : json_(nlohmann::json::parse(text)) {
    for (const auto& [key, value] : json_.items()) {
      bool is_known = false;
      std::string all;
      for (const char* const one : keys) {
        is_known = is_known || key == one;
        all += (all.empty() ? "" : ", ") + std::string(one);
      }
      if (!is_known) throw std::runtime_error("settings have \"" + key + "\", which is no key (the keys are " + all + ")");
    }
  }
  [[nodiscard]] double number(const char* key, double fallback, double least, double most) const {
    const nlohmann::json value = json_.value(key, nlohmann::json(fallback));
    if (!value.is_number() || value.get<double>() < least || value.get<double>() > most)
      throw std::runtime_error(std::string("settings.") + key + " must be a number from " + std::to_string(least) + " to " +
                               std::to_string(most));
    return value.get<double>();
  }
  [[nodiscard]] std::string text(const char* key, const char* fallback) const {
    const nlohmann::json value = json_.value(key, nlohmann::json(fallback));
    if (!value.is_string()) throw std::runtime_error(std::string("settings.") + key + " must be a text");
    return value.get<std::string>();
  }

 private:
  nlohmann::json json_;
};

}  // namespace fdcg::plugin
