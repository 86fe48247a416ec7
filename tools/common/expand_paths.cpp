// SPDX-License-Identifier: Apache-2.0
#include "expand_paths.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>

#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

namespace fs = std::filesystem;

// One item of a pattern at its start: how long it is, and whether it matches `c`.
struct Item {
  std::size_t length = 1;
  bool is_match = false;
};

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}
char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

Item bracket_item(std::string_view pattern, char c) {
  std::size_t at = 1;
  const bool is_negated = at < pattern.size() && (pattern[at] == '!' || pattern[at] == '^');
  if (is_negated) ++at;
  bool is_found = false;
  for (const std::size_t first = at; at < pattern.size() && (pattern[at] != ']' || at == first); ++at) {
    const bool is_range = at + 2 < pattern.size() && pattern[at + 1] == '-' && pattern[at + 2] != ']';
    const char last = is_range ? pattern[at + 2] : pattern[at];
    for (const char letter : {lower(c), upper(c)})
      is_found = is_found || (pattern[at] <= letter && letter <= last);
    if (is_range) at += 2;
  }
  if (at >= pattern.size()) return {1, c == '['};  // never closed: a plain bracket
  return {at + 1, is_found != is_negated};
}

Item item_at(std::string_view pattern, char c) {
  if (pattern[0] == '[') return bracket_item(pattern, c);
  return {1, pattern[0] == '?' || lower(pattern[0]) == lower(c)};
}

bool is_pattern(std::string_view text) {
  return text.find_first_of("*?[{") != std::string_view::npos;
}

// "a{b,c{d,e}}" -> "ab", "acd", "ace". A brace that is never closed, or has no comma, stands for itself.
void expand_braces(const std::string& text, std::size_t from, std::vector<std::string>& out) {
  for (std::size_t open = text.find('{', from); open != std::string::npos; open = text.find('{', open + 1)) {
    std::vector<std::size_t> cuts{open};
    std::size_t close = open;
    for (int depth = 0; close < text.size(); ++close) {
      if (text[close] == '{') ++depth;
      if (text[close] == ',' && depth == 1) cuts.push_back(close);
      if (text[close] == '}' && --depth == 0) break;
    }
    if (close == text.size() || cuts.size() == 1) continue;
    cuts.push_back(close);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      expand_braces(text.substr(0, open) + text.substr(cuts[i] + 1, cuts[i + 1] - cuts[i] - 1) + text.substr(close + 1), open,
                    out);
    }
    return;
  }
  out.push_back(text);
}

std::vector<std::string> components_of(std::string_view path) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at < path.size();) {
    const std::size_t end = std::min(path.find('/', at), path.size());
    if (end > at) out.emplace_back(path.substr(at, end - at));
    at = end + 1;
  }
  return out;
}

bool is_hidden(const std::string& name) {
  return name.starts_with('.');
}

// Names in a folder; nothing where it cannot be read.
std::vector<fs::directory_entry> entries_of(const std::string& folder) {
  std::error_code ignored;
  std::vector<fs::directory_entry> entries;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, ignored), end; !ignored && entry != end;
       entry.increment(ignored))
    entries.push_back(*entry);
  return entries;
}

bool is_file(const fs::directory_entry& entry) {
  std::error_code ignored;
  return entry.exists(ignored) && !entry.is_directory(ignored);
}
bool is_real_folder(const fs::directory_entry& entry) {
  std::error_code ignored;
  return entry.is_directory(ignored) && !entry.is_symlink(ignored);
}

// Adds the files below `prefix` ("", "/" or "folder/") that match the components from `at` on.
void match(const std::string& prefix, const std::vector<std::string>& components, std::size_t at,
           std::set<std::string>& found) {
  if (at == components.size()) return;
  const std::string& pattern = components[at];
  const bool is_last = at + 1 == components.size();
  if (pattern == "**" && !is_last) match(prefix, components, at + 1, found);  // no folder at all
  if (!is_pattern(pattern)) {
    std::error_code ignored;
    const fs::directory_entry entry(prefix + pattern, ignored);
    if (is_last && is_file(entry)) found.insert(prefix + pattern);
    if (!is_last && entry.is_directory(ignored)) return match(prefix + pattern + "/", components, at + 1, found);
    // the same name in other cases is found below
  }
  for (const fs::directory_entry& entry : entries_of(prefix)) {
    const std::string name = entry.path().filename().string();
    if (is_hidden(name) && !is_hidden(pattern)) continue;
    if (pattern == "**") {
      if (is_real_folder(entry)) match(prefix + name + "/", components, at, found);
      if (is_last && is_file(entry)) found.insert(prefix + name);
    } else if (matches_pattern(name, pattern)) {
      std::error_code ignored;
      if (is_last && is_file(entry)) found.insert(prefix + name);
      if (!is_last && entry.is_directory(ignored)) match(prefix + name + "/", components, at + 1, found);
    }
  }
}

// What is looked for in folders, and what is beside it.
struct Wanted {
  const std::vector<std::string>& endings;
  const std::vector<std::string>& other_endings;
};

void walk(const std::string& prefix, const Wanted& wanted, std::set<std::string>& found, std::set<std::string>& others) {
  for (const fs::directory_entry& entry : entries_of(prefix)) {
    const std::string name = entry.path().filename().string();
    if (is_hidden(name)) continue;
    if (is_real_folder(entry)) {
      walk(prefix + name + "/", wanted, found, others);
    } else if (is_file(entry) && has_ending(name, wanted.endings)) {
      found.insert(prefix + name);
    } else if (is_file(entry) && has_ending(name, wanted.other_endings)) {
      others.insert(prefix + name);
    }
  }
}

// The files of one argument, sorted; or its problem.
std::vector<NamedFile> expand(const std::string& argument, const Wanted& wanted, std::set<std::string>& others) {
  std::error_code ignored;
  std::set<std::string> found;
  const bool is_there = fs::exists(argument, ignored);
  if (argument != "-" && fs::is_directory(argument, ignored)) {
    walk(argument.ends_with('/') ? argument : argument + "/", wanted, found, others);
    if (found.empty())
      return {{argument, "is a directory without a mesh file (" + listed(wanted.endings) + "); name a mesh file"}};
  } else if (argument == "-" || is_there || !is_pattern(argument)) {
    return {{argument, ""}};
  } else {
    std::vector<std::string> patterns;
    expand_braces(argument, 0, patterns);
    for (const std::string& pattern : patterns)
      match(pattern.starts_with('/') ? "/" : "", components_of(pattern), 0, found);
    if (found.empty()) return {{argument, "matches no file; check the pattern and the folder it starts in"}};
  }
  std::vector<NamedFile> files;
  for (const std::string& path : found)
    files.push_back({path, ""});
  return files;
}

// ** stands for any number of names. Takes time by the product of the lengths for each ** but the last.
bool matches_components(const std::vector<std::string>& names, std::size_t n, const std::vector<std::string>& patterns,
                        std::size_t p) {
  for (; p < patterns.size() && patterns[p] != "**"; ++n, ++p)
    if (n == names.size() || !matches_pattern(names[n], patterns[p])) return false;
  if (p == patterns.size()) return n == names.size();
  for (; n <= names.size(); ++n)
    if (matches_components(names, n, patterns, p + 1)) return true;
  return false;
}

}  // namespace

const std::vector<std::string>& mesh_endings() {
  static const std::vector<std::string> kEndings{".off", ".obj", ".ply", ".stl", ".gltf", ".glb", ".drc",
                                                 ".dae", ".zae", ".3mf", ".vtk", ".vtp",  ".x3d"};
  return kEndings;
}

bool has_ending(const std::string& name, const std::vector<std::string>& endings) {
  std::string ending = fs::path(name).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), lower);
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

bool matches_pattern(std::string_view name, std::string_view pattern) {
  std::size_t n = 0, p = 0;
  std::size_t star = std::string_view::npos, star_name = 0;  // where the last * is, and what it has swallowed up to
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      star_name = n;
      continue;
    }
    const Item item = p < pattern.size() ? item_at(pattern.substr(p), name[n]) : Item{};
    if (p < pattern.size() && item.is_match) {
      p += item.length;
      ++n;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      n = ++star_name;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

bool matches_path(const std::string& path, const std::string& pattern) {
  std::vector<std::string> alternatives;
  expand_braces(pattern, 0, alternatives);
  const std::vector<std::string> names = components_of(path);
  return std::any_of(alternatives.begin(), alternatives.end(), [&](const std::string& one) {
    if (one.find('/') == std::string::npos && one != "**") return !names.empty() && matches_pattern(names.back(), one);
    return path.starts_with('/') == one.starts_with('/') && matches_components(names, 0, components_of(one), 0);
  });
}

std::vector<NamedFile> expand_paths(const std::vector<std::string>& arguments, const std::vector<std::string>& endings) {
  return expand_paths(arguments, endings, {}, nullptr);
}

std::vector<NamedFile> expand_paths(const std::vector<std::string>& arguments, const std::vector<std::string>& endings,
                                    const std::vector<std::string>& other_endings, std::vector<std::string>* others) {
  const Wanted wanted{endings, other_endings};
  std::set<std::string> beside;
  std::vector<NamedFile> files;
  std::set<std::string> seen;
  for (const std::string& argument : arguments) {
    for (NamedFile& file : expand(argument, wanted, beside)) {
      if (seen.insert(file.path).second) files.push_back(std::move(file));
    }
  }
  if (others != nullptr) others->assign(beside.begin(), beside.end());
  return files;
}

}  // namespace fdcg::tools
