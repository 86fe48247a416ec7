// SPDX-License-Identifier: Apache-2.0
// Options of the command line that both programs declare alike. A wrong value is a usage error that names the right ones.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fdcg::tools {

// The whole of `text` as a finite number in (low, high); nothing else counts.
std::optional<double> parse_number_between(const std::string& text, double low, double high);

// `value` is one of `choices`, or a ValidationError that lists them and names the nearest.
void require_choice(const std::string& option, const std::string& value, const std::vector<std::string>& choices);

// A description whose option takes one of these words, or for which completion offers them. page_of (help_page.hpp) takes them
// apart again.
std::string one_of(const std::string& help, const std::vector<std::string>& words);
std::string offering(const std::string& help, const std::vector<std::string>& words);

// A whole number in these bounds.
CLI::Validator whole_number(std::uint64_t least, std::uint64_t most);

// A word of `choices`.
CLI::Option* choice_option(CLI::App& command, const std::string& name, const std::function<void(const std::string&)>& set,
                           const std::string& help, const std::vector<std::string>& choices);
CLI::Option* choice_option(CLI::App& command, const std::string& name, std::string& value, const std::string& help,
                           const std::vector<std::string>& choices);

// `unit` is for the message: " N/m".
struct NumberBounds {
  double least = 0, most = 0;
  std::string unit = {};
};
CLI::Option* number_option(CLI::App& command, const std::string& name, double& value, const NumberBounds& bounds,
                           const std::string& help);

}  // namespace fdcg::tools
