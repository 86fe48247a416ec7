// SPDX-License-Identifier: Apache-2.0
#include "options.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>

#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

// 0.001, 1e9
std::string shown(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  std::string shown(text, end);
  if (const std::size_t plus = shown.find("e+0"); plus != std::string::npos) shown.erase(plus + 1, 2);
  return shown;
}

}  // namespace

std::optional<double> parse_number_between(const std::string& text, double low, double high) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stopped != end || !(value > low && value < high)) return std::nullopt;
  return value;
}

void require_choice(const std::string& option, const std::string& value, const std::vector<std::string>& choices) {
  if (std::find(choices.begin(), choices.end(), value) != choices.end()) return;
  std::string list;
  for (const std::string& choice : choices)
    list += (list.empty() ? "" : ", ") + choice;
  throw CLI::ValidationError(option, "'" + value + "' is none of " + list + did_you_mean(value, choices));
}

std::string one_of(const std::string& help, const std::vector<std::string>& words) {
  std::string text = help + " One of ";
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return offering(text + ".", words);
}

std::string offering(const std::string& help, const std::vector<std::string>& words) {
  std::string text = help;
  for (const std::string& word : words)
    text += "\n" + word;
  return text;
}

CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
  const auto check = [least, most](const std::string& text) -> std::string {
    std::uint64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, value);
    if (error == std::errc{} && stopped == end && value >= least && value <= most) return {};
    return "'" + text + "' is no whole number from " + std::to_string(least) + " to " + std::to_string(most);
  };
  return {check, ""};  // no description: it would stand in the messages of the parser
}

CLI::Option* choice_option(CLI::App& command, const std::string& name, const std::function<void(const std::string&)>& set,
                           const std::string& help, const std::vector<std::string>& choices) {
  const auto parse = [name, set, choices](const std::string& text) {
    require_choice(name, text, choices);
    set(text);
  };
  return command.add_option_function<std::string>(name, parse, one_of(help, choices));
}

CLI::Option* choice_option(CLI::App& command, const std::string& name, std::string& value, const std::string& help,
                           const std::vector<std::string>& choices) {
  return choice_option(
      command, name, [&value](const std::string& text) { value = text; }, help, choices);
}

CLI::Option* number_option(CLI::App& command, const std::string& name, double& value, const NumberBounds& bounds,
                           const std::string& help) {
  const auto parse = [name, &value, bounds](const std::string& text) {
    double number = 0;
    const char* const end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc{} || stopped != end || !(number >= bounds.least && number <= bounds.most)) {
      throw CLI::ValidationError(
          name, "'" + text + "' is no number from " + shown(bounds.least) + " to " + shown(bounds.most) + bounds.unit);
    }
    value = number;
  };
  return command.add_option_function<std::string>(name, parse, help);
}

}  // namespace fdcg::tools
