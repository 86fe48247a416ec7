// SPDX-License-Identifier: Apache-2.0
// Arguments that name many files: patterns and folders.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fdcg::tools {

// A file to be read, or why an argument names none.
struct NamedFile {
  std::string path;     // as given, or as the pattern found it: relative where the argument is
  std::string problem;  // one line; empty: none
};

// Of the files that are meshes by their names, in lower case: ".off" and so on.
const std::vector<std::string>& mesh_endings();
// Whatever the case of the name's letters.
bool has_ending(const std::string& name, const std::vector<std::string>& endings);

// Each argument in its turn: "-" and the name of a file stand for themselves, whether it exists or not. A pattern gives the
// files that match, a folder those below it with one of `endings` (in lower case, ".stl"); both match letters in any case, and
// give files sorted by their bytes. A pattern knows *, ?, [abc], [!a-c], {a,b} and, as a whole component, ** for any number of
// folders; hidden names (a leading dot) match only where the pattern has the dot, and links to folders are not followed. Every
// path comes once. An argument that names an existing file is no pattern.
std::vector<NamedFile> expand_paths(const std::vector<std::string>& arguments, const std::vector<std::string>& endings);
// The same, and adds those files of the folders to `others` that have one of `other_endings`.
std::vector<NamedFile> expand_paths(const std::vector<std::string>& arguments, const std::vector<std::string>& endings,
                                    const std::vector<std::string>& other_endings, std::vector<std::string>* others);

// Whether the whole of `name`, one component of a path, matches a pattern without {} and **, whatever the case of its letters.
bool matches_pattern(std::string_view name, std::string_view pattern);
// Whether a path, as it stands, matches a whole pattern; one without / matches the last component.
bool matches_path(const std::string& path, const std::string& pattern);

}  // namespace fdcg::tools
