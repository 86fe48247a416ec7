// SPDX-License-Identifier: Apache-2.0
#include "program_options.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdint>
#include <type_traits>

namespace fdcg::test {

struct ProgramOptions::Parser {
  CLI::App app;
};

ProgramOptions::ProgramOptions(const std::string& description) : parser_(new Parser{CLI::App(description)}) {}
ProgramOptions::~ProgramOptions() = default;

void ProgramOptions::flag(const std::string& name, bool& value, const std::string& help) {
  parser_->app.add_flag(name, value, help);
}

template <class T>
void ProgramOptions::option(const std::string& name, T& value, const std::string& help, double at_least, double at_most) {
  CLI::Option* added = parser_->app.add_option(name, value, help);
  if (value != T{}) added->capture_default_str();
  if (std::isfinite(at_least) || std::isfinite(at_most)) added->check(CLI::Range(at_least, at_most));
}

template <class T>
void ProgramOptions::choice(const std::string& name, T& value, const std::string& help, const std::vector<std::string>& words) {
  CLI::Option* added = parser_->app.add_option(name, value, help)->check(CLI::IsMember(words));
  if (value != T{}) added->capture_default_str();
}

std::optional<int> ProgramOptions::parse(int argc, char** argv) {
  try {
    parser_->app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return parser_->app.exit(error) == 0 ? 0 : 2;
  }
  return std::nullopt;
}

#define FDCG_OPTION(T) template void ProgramOptions::option(const std::string&, T&, const std::string&, double, double)
FDCG_OPTION(double);
FDCG_OPTION(int);
FDCG_OPTION(unsigned);
FDCG_OPTION(std::int64_t);
FDCG_OPTION(std::uint64_t);
FDCG_OPTION(std::string);
FDCG_OPTION(std::vector<int>);
FDCG_OPTION(std::vector<std::string>);
#undef FDCG_OPTION
template void ProgramOptions::choice(const std::string&, std::string&, const std::string&, const std::vector<std::string>&);
template void ProgramOptions::choice(const std::string&, std::vector<std::string>&, const std::string&,
                                     const std::vector<std::string>&);

}  // namespace fdcg::test
