// SPDX-License-Identifier: Apache-2.0
#include "options.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

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

double number_between(const std::string& option, const std::string& text, double low, double high, const std::string& wrong) {
  const auto number = parse_number_between(text, low, high);
  if (!number) throw CLI::ValidationError(option, "'" + text + "' is " + wrong);
  return *number;
}

double positive_number(const std::string& option, const std::string& text, const std::string& wrong) {
  return number_between(option, text, 0, std::numeric_limits<double>::infinity(), wrong);
}

void require_choice(const std::string& option, const std::string& value, const std::vector<std::string>& choices) {
  if (std::find(choices.begin(), choices.end(), value) != choices.end()) return;
  throw CLI::ValidationError(option, "'" + value + "' is none of " + listed(choices) + did_you_mean(value, choices));
}

std::string one_of(const std::string& help, const std::vector<std::string>& words) {
  std::string text = help + " One of ";
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return offering(text + ".", words);
}

std::string offering(const std::string& help, const std::vector<std::string>& words) {
  return words.empty() ? help : help + "\n" + listed(words, "\n");
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

CLI::Option* OptionGroup::flag(const std::string& names, bool& target, const std::string& help) const {
  return command_.add_flag(names, target, help)->group(title_);
}

CLI::Option* OptionGroup::text(const std::string& names, const std::string& value, std::string& target, const std::string& help,
                               const std::string& shown_default) const {
  return command_.add_option(names, target, help)->type_name(value)->default_str(shown_default)->group(title_);
}

CLI::Option* OptionGroup::parsed(const std::string& name, const std::string& value, const Parse& parse, const std::string& help,
                                 const std::string& shown_default) const {
  CLI::Option* const option = command_.add_option_function<std::string>(name, parse, help);
  return option->type_name(value)->default_str(shown_default)->group(title_);
}

CLI::Option* OptionGroup::repeated(const std::string& name, const std::string& value, const Parse& parse,
                                   const std::string& help, const std::string& shown_default) const {
  const auto parse_each = [parse](const std::vector<std::string>& values) {
    std::for_each(values.begin(), values.end(), parse);
  };
  CLI::Option* const option = command_.add_option_function<std::vector<std::string>>(name, parse_each, help);
  option->type_name(value)->default_str(shown_default)->group(title_);
  return option->allow_extra_args(false)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

CLI::Option* OptionGroup::number(const std::string& name, const std::string& value, double& target, const NumberBounds& bounds,
                                 const std::string& help, const std::string& shown_default) const {
  const auto parse = [name, &target, bounds](const std::string& text) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const auto number = parse_number_between(text, -kInfinity, kInfinity);
    if (!number || *number < bounds.least || *number > bounds.most) {
      throw CLI::ValidationError(
          name, "'" + text + "' is no number from " + shown(bounds.least) + " to " + shown(bounds.most) + bounds.unit);
    }
    target = *number;
  };
  return parsed(name, value, parse, help, shown_default);
}

void OptionGroup::jobs(unsigned& target, const std::string& help) const {
  CLI::Option* const option = command_.add_option("--jobs", target, "Number of threads. " + help);
  option->type_name("N")->default_str("one for each core")->check(whole_number(1, 1024))->group(title_);
}

}  // namespace fdcg::tools
