// SPDX-License-Identifier: Apache-2.0
// A config's objects as each device feels them: the graphs, opened once and only read, and a scene of each device's own. The
// host and the replay of a session both build theirs here, so that they are the same.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "host_config.hpp"

namespace fdcg::dev {

// One graph an object, in their order; a file that several objects name is opened once.
class SceneGraphs {
 public:
  SceneGraphs() = default;
  ~SceneGraphs();
  SceneGraphs(const SceneGraphs&) = delete;
  SceneGraphs& operator=(const SceneGraphs&) = delete;

  // Empty: fine. Otherwise the object, its file, and what is wrong with it. Every byte is verified.
  std::string open(const std::vector<ObjectConfig>& objects);
  const fdcg_graph& of_object(int object) const { return *by_object_[static_cast<std::size_t>(object)]; }

 private:
  struct File {
    std::string path;
    fdcg_graph graph;
  };
  std::vector<std::unique_ptr<File>> files_;
  std::vector<const fdcg_graph*> by_object_;
};

struct DeviceScene {
  DeviceSetup setup;
  std::vector<int> moving;            // the objects that are not fixed, in the order of setup.driven
  std::vector<std::uint64_t> memory;  // the scene's

  // setup is then ready for begin_device. Empty: fine. The graphs must outlive it.
  std::string build(const HostConfig& config, int device, const SceneGraphs& graphs);
};

}  // namespace fdcg::dev
