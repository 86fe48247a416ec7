// SPDX-License-Identifier: Apache-2.0
// Options of the command line that both programs declare alike. A wrong value is a usage error that names the right ones.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fdcg::tools {

// The whole of `text` as a finite number in (low, high); nothing else counts.
std::optional<double> parse_number_between(const std::string& text, double low, double high);

// The same, or a ValidationError: "'text' is WRONG".
double number_between(const std::string& option, const std::string& text, double low, double high, const std::string& wrong);

double positive_number(const std::string& option, const std::string& text, const std::string& wrong);

// `value` is one of `choices`, or a ValidationError that lists them and names the nearest.
void require_choice(const std::string& option, const std::string& value, const std::vector<std::string>& choices);

// A description whose option takes one of these words, or for which completion offers them. page_of (help_page.hpp) takes them
// apart again.
std::string one_of(const std::string& help, const std::vector<std::string>& words);
std::string offering(const std::string& help, const std::vector<std::string>& words);

// A whole number in these bounds.
CLI::Validator whole_number(std::uint64_t least, std::uint64_t most);

// Both included; `unit` is for the message: " N/m".
struct NumberBounds {
  double least = 0, most = 0;
  std::string unit = {};
};

using Parse = std::function<void(const std::string&)>;  // of a value's text; may throw ValidationError

// A positional argument that has to be there. `value`: its name in the help, "FILE".
template <class Target>
void required_argument(CLI::App& command, const std::string& name, const std::string& value, Target& target,
                       const std::string& help) {
  command.add_option(name, target, help)->required()->type_name(value);
}

// Declares the options of one group of a command's help. `value`: the value's name, "FILE". `shown_default`: empty where there
// is none that is worth a word.
class OptionGroup {
 public:
  OptionGroup(CLI::App& command, std::string title) : command_(command), title_(std::move(title)) {}

  CLI::Option* flag(const std::string& names, bool& target, const std::string& help) const;
  CLI::Option* text(const std::string& names, const std::string& value, std::string& target, const std::string& help,
                    const std::string& shown_default = {}) const;
  CLI::Option* parsed(const std::string& name, const std::string& value, const Parse& parse, const std::string& help,
                      const std::string& shown_default = {}) const;
  // May be given more than once; `parse` gets each value.
  CLI::Option* repeated(const std::string& name, const std::string& value, const Parse& parse, const std::string& help,
                        const std::string& shown_default = {}) const;
  CLI::Option* number(const std::string& name, const std::string& value, double& target, const NumberBounds& bounds,
                      const std::string& help, const std::string& shown_default) const;
  // --jobs N; `help`: what does not depend on it.
  void jobs(unsigned& target, const std::string& help) const;

  // A word, and what it stands for. The first is the default where `shown_default` is not given.
  template <class Value>
  using Words = std::vector<std::pair<std::string, Value>>;
  template <class Value, class Target>
  CLI::Option* choice(const std::string& name, const std::string& value, const Words<Value>& words, Target& target,
                      const std::string& help, const std::optional<std::string>& shown_default = {}) const {
    std::vector<std::string> names;
    for (const auto& [word, meaning] : words)
      names.push_back(word);
    const auto parse = [name, words, names, &target](const std::string& text) {
      require_choice(name, text, names);
      for (const auto& [word, meaning] : words)
        if (word == text) target = meaning;
    };
    return parsed(name, value, parse, one_of(help, names), shown_default.value_or(names.front()));
  }

 private:
  CLI::App& command_;
  std::string title_;
};

}  // namespace fdcg::tools
