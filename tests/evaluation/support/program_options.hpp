// SPDX-License-Identifier: Apache-2.0
// The options of an evaluation program, read by CLI11, which program_options.cpp alone includes.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fdcg::test {

class ProgramOptions {
 public:
  explicit ProgramOptions(const std::string& description);
  ~ProgramOptions();

  // Sets `value` where NAME is given, clears it where !NAME is.
  void flag(const std::string& name, bool& value, const std::string& help);

  // NAME and its value or, for vectors, values; the help shows what `value` holds now, unless that is empty or zero. `at_least`
  // and `at_most` bound numbers. For bool there is flag; T may be double, int, unsigned, std::int64_t, std::uint64_t,
  // std::string, or a vector of int or std::string.
  template <class T>
  void option(const std::string& name, T& value, const std::string& help, double at_least = -kInfinity,
              double at_most = kInfinity);
  // One of a few words, or several.
  template <class T>
  void choice(const std::string& name, T& value, const std::string& help, const std::vector<std::string>& words);

  // Nothing, or the exit code of a program that ends here: 0 after --help, 2 on wrong usage, which has been told.
  std::optional<int> parse(int argc, char** argv);

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace fdcg::test
