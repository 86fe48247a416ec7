// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>

#include <chrono>
#include <cstring>
#include <stdexcept>

#include "fdcg_rival.h"
#include "rival.hpp"

namespace fdcg::test {
namespace {

const fdcg_rival& opened(const std::string& path) {
  // stays open: what it links may not bear being closed
  void* library = dlopen(path.find('/') == std::string::npos ? ("./" + path).c_str() : path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw std::runtime_error(std::string("the rival cannot be opened: ") + dlerror());
  void* symbol = dlsym(library, "fdcg_rival_get");
  if (symbol == nullptr) throw std::runtime_error(path + ": has no function fdcg_rival_get; docs/rivals.md");
  const fdcg_rival* (*get)(std::uint32_t) = nullptr;
  std::memcpy(&get, &symbol, sizeof get);
  const fdcg_rival* rival = get(FDCG_RIVAL_ABI);
  if (rival == nullptr || rival->abi != FDCG_RIVAL_ABI)
    throw std::runtime_error(path + ": is not of ABI " + std::to_string(FDCG_RIVAL_ABI) +
                             "; build it with today's fdcg_rival.h");
  if (rival->load == nullptr || rival->unload == nullptr || rival->reset == nullptr || rival->step == nullptr ||
      rival->memory == nullptr || rival->name == nullptr || rival->family == nullptr || rival->precision == nullptr)
    throw std::runtime_error(path + ": only set_friction and version may be null");
  return *rival;
}

class RivalOfLibrary : public Contender {
 public:
  RivalOfLibrary(const std::string& path, const bake::PolygonSoup& soup) : rival_(opened(path)) {
    info_.name = rival_.name;
    info_.family = rival_.family;
    info_.precision = rival_.precision;
    info_.version = rival_.version == nullptr ? "" : rival_.version;
    info_.has_friction = rival_.set_friction != nullptr;
    check_rival(path, info_);
    const RivalMesh mesh(soup);
    const fdcg_rival_mesh view = {mesh.points_m.size() / 3, mesh.corners.size() / 3, mesh.points_m.data(), mesh.corners.data()};
    char error[256] = "";
    const auto begin = std::chrono::steady_clock::now();
    body_ = rival_.load(&view, kStiffness_n_per_m, error);
    info_.bake_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    error[sizeof error - 1] = 0;
    if (body_ == nullptr) throw std::runtime_error(info_.name + " does not load " + soup.name + ": " + error);
    info_.bytes = rival_.memory(body_);
  }
  ~RivalOfLibrary() override { rival_.unload(body_); }
  RivalOfLibrary(const RivalOfLibrary&) = delete;
  RivalOfLibrary& operator=(const RivalOfLibrary&) = delete;

  void reset() override { rival_.reset(body_); }
  void set_friction(double mu_static, double mu_dynamic) override {
    if (rival_.set_friction != nullptr) rival_.set_friction(body_, mu_static, mu_dynamic);
    reset();
  }
  void step(const Ground::Point& hip_m, Feel& feel) override {
    fdcg_rival_result result;
    rival_.step(body_, hip_m.data(), &result);
    feel.in_contact = result.is_in_contact != 0;
    feel.transitions = 0;
    feel.is_carried = false;
    std::memcpy(feel.god_object.data(), result.god_object_m, sizeof result.god_object_m);
    std::memcpy(feel.force.data(), result.force_n, sizeof result.force_n);
  }

 private:
  const fdcg_rival& rival_;
  void* body_ = nullptr;
};

}  // namespace

std::unique_ptr<Contender> make_rival_of_library(const std::string& path, const bake::PolygonSoup& soup) {
  return std::make_unique<RivalOfLibrary>(path, soup);
}

}  // namespace fdcg::test
