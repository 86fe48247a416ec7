// SPDX-License-Identifier: Apache-2.0
// Effects of a scene: read, written and read back, refused by name; felt by a device, and replayed bit for bit.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "catch.hpp"
#include "fdcg/device_tools.hpp"
#include "host/fast_run.hpp"
#include "meshes.hpp"
#include "recording/session_replay.hpp"
#include "scene/scene_build.hpp"
#include "scene/scene_json.hpp"
#include "session_rig.hpp"

using namespace fdcg::dev;
using nlohmann::json;

namespace {

const std::string kScenes = FDCG_SOURCE_DIR "/testdata/scenes/";

// A scene whose table has one effect.
json with(const json& effect) {
  return {{"fdcg_scene", 1},
          {"objects", {{{"name", "table"}, {"surface", {{"kind", "plane"}}}, {"effects", {effect}}}}},
          {"devices", {{{"name", "hand"}, {"source", "simulated"}}}}};
}

std::string refusal(const json& scene) {
  HostConfig config;
  return parse_scene(scene.dump(), "s.json", &config);
}

std::string run_refusal(const json& scene) {
  HostConfig config;
  REQUIRE(parse_scene(scene.dump(), kScenes + "s.json", &config) == "");
  FastRun fast;
  return fast.open(std::move(config));
}

const json kTone = {{"kind", "vibration"}, {"force_n", 0.5}, {"frequency_hz", 200}};

// Of a run of a scene: wanted force by tick.
struct Felt {
  std::vector<std::array<double, 3>> force_n, hip_m;
  double calmed = 0;  // the most
  bool is_same = false;
};

Felt felt(const HostConfig& scene, double seconds, bool arms = true) {
  const Folder folder;
  HostConfig config = scene;
  config.log_file = folder.file("a.fdcglog");
  FastRun fast;
  const std::string problem = fast.open(config);
  INFO(problem);
  REQUIRE(problem.empty());
  REQUIRE(fast.run(seconds, arms) == "");
  CHECK(fast.status(0).last.phase == (arms ? Phase::kArmed : Phase::kDisarmed));
  Felt felt;
  SessionReplay replay;
  REQUIRE(replay.open(config.log_file, "") == "");
  for (ReplayedTick tick; replay.next(&tick);) {
    const double *const f = tick.output->wanted_force_n, *const h = tick.output->hip_world_m;
    felt.force_n.push_back({f[0], f[1], f[2]});
    felt.hip_m.push_back({h[0], h[1], h[2]});
    felt.calmed = std::max(felt.calmed, tick.output->calmed);
  }
  felt.is_same = replay.is_same();
  return felt;
}

HostConfig example() {
  HostConfig config;
  std::vector<std::string> warnings;
  REQUIRE(read_scene(kScenes + "effects.json", &config, &warnings) == "");
  CHECK(warnings.empty());
  return config;
}

}  // namespace

TEST_CASE("effects of a scene are read, written, and read back as the same") {
  const HostConfig config = example();
  REQUIRE(config.objects[0].effects.size() == 5);
  REQUIRE(config.effects.size() == 1);
  CHECK(config.effects[0].effect.when == FDCG_WHEN_ALWAYS);
  const fdcg_effect& tap = config.objects[0].effects[0].effect;
  CHECK(tap.kind == FDCG_EFFECT_TAP);
  CHECK(tap.decay_s == 0.015);
  CHECK(tap.force_n == 3);
  const EffectConfig& texture = config.objects[0].effects[4];
  REQUIRE(texture.texture);
  CHECK(texture.texture->speed_m_per_s == std::vector<double>{0.05, 0.15});
  CHECK(texture.texture->models[2].coefficients == std::vector<double>{-0.58, 0.88});
  CHECK(texture.effect.when == FDCG_WHEN_SLIPPING);
  const std::string written = write_scene(config);
  HostConfig back;
  REQUIRE(parse_scene(written, config.scene_file, &back, nullptr, {false}) == "");
  CHECK(write_scene(back) == written);
  CHECK(back.objects[0].effects[2].effect.region_half_m[0] == 0.02);
}

TEST_CASE("an effect that is wrong is refused by its key") {
  CHECK(refusal(with(kTone)).empty());
  const auto changed = [](const char* key, const json& value) {
    json effect = kTone;
    effect[key] = value;
    return refusal(with(effect));
  };
  CHECK(changed("kind", "hum").find("objects[0].effects[0].kind is \"hum\"") != std::string::npos);
  CHECK(changed("decay_s", 1).find("decay_s") != std::string::npos);
  CHECK(changed("force_n", 0).find("force_n is 0") != std::string::npos);
  CHECK(changed("axis", {0, 0, 1}).find("along is not \"axis\"") != std::string::npos);
  CHECK(changed("material", "steel").find("material is for the materials of a mesh") != std::string::npos);
  CHECK(changed("region", {{"center_m", {0, 0, 0}}}).find("region has neither radius_m nor half_m") != std::string::npos);
  CHECK(run_refusal(with({{"kind", "vibration"}, {"force_n", 1}, {"frequency_hz", 500}}))
            .find("effects[0]: effect.frequency_hz") != std::string::npos);
  json scene = with(kTone);
  scene["objects"][0]["surface"] = {{"kind", "box"}, {"half_m", {1, 1, 1}}};
  scene["objects"][0]["effects"][0] = {{"kind", "magnet"}, {"force_n", 1}, {"distance_m", 0.01}};
  CHECK(refusal(scene).find("meshes, planes and spheres") != std::string::npos);
  scene = with(kTone);
  scene["objects"][0].erase("surface");
  scene["objects"][0]["file"] = "cube.fdcg";
  scene["objects"][0]["effects"][0]["material"] = "steel";
  CHECK(run_refusal(scene).find("the graph has no material 'steel'") != std::string::npos);
  scene["objects"][0]["motion"] = {{"kind", "soft"}};
  CHECK(refusal(scene).find("an effect of a soft object") != std::string::npos);
  scene = with(kTone);
  for (int i = 0; i < 64; ++i)
    scene["effects"].push_back(kTone);
  CHECK(refusal(scene).find("one more than the 64") != std::string::npos);
}

TEST_CASE("a texture that is wrong is refused by its key") {
  json model = {{"speed_m_per_s", 0.1}, {"force_n", 1}, {"coefficients", {-0.5}}, {"variance", 1}}, other = model;
  const auto said = [&](const json& models) {
    return refusal(with({{"kind", "texture"}, {"texture", {{"fdcg_texture", 1}, {"rate_hz", 1000}, {"models", models}}}}));
  };
  CHECK(said(json::array({model})).empty());
  CHECK(said(json::array({model, model})).find("those of another model") != std::string::npos);
  other["speed_m_per_s"] = 0.2, other["force_n"] = 2;
  CHECK(said(json::array({model, other})).find("has none at 0.1 m/s and 2 N") != std::string::npos);
  other["force_n"] = 1, other["coefficients"] = {1.5};
  CHECK(said(json::array({model, other})).find("models[1].coefficients is refused") != std::string::npos);
  other["coefficients"] = {0.5, 0.1};
  CHECK(said(json::array({model, other})).find("another length") != std::string::npos);
  CHECK(refusal(with({{"kind", "texture"}, {"texture", "nowhere.json"}})).find("nowhere.json") != std::string::npos);
}

TEST_CASE("a device feels a scene's effects, and the log of it replays bit for bit") {
  const HostConfig scene = example();
  const Felt with_effects = felt(scene, 5.5);
  CHECK(with_effects.is_same);
  HostConfig plain = scene;
  plain.effects.clear();
  for (ObjectConfig& object : plain.objects)
    object.effects.clear();
  const Felt without = felt(plain, 5.5);
  CHECK(without.is_same);
  REQUIRE(with_effects.force_n.size() == without.force_n.size());
  // in the field of noise the force shakes, in that of viscosity it does not
  const auto shake = [](const Felt& of, double from_m, double to_m) {
    double square = 0;
    int count = 0;
    for (std::size_t i = 1; i < of.force_n.size(); ++i) {
      if (of.hip_m[i][0] < from_m || of.hip_m[i][0] > to_m || of.hip_m[i][2] > 0) continue;
      const double change = of.force_n[i][2] - of.force_n[i - 1][2];
      square += change * change;
      ++count;
    }
    REQUIRE(count > 300);
    return std::sqrt(square / count);
  };
  CHECK(shake(with_effects, 0.005, 0.035) > 5 * shake(without, 0.005, 0.035));
  CHECK(shake(with_effects, -0.075, -0.045) < 2 * shake(without, -0.075, -0.045));
  // the ball draws the hand that stands beside it
  CHECK(with_effects.force_n.back()[0] > 0.3);
  CHECK(std::fabs(without.force_n.back()[0]) < 0.01);
}

TEST_CASE("a vibration in free air is no loop that shakes, and reaches the device whole") {
  json scene = with(kTone);
  scene["objects"][0]["effects"] = json::array();
  scene["effects"] = json::array({kTone});
  scene["effects"][0]["force_n"] = 2;
  scene["effects"][0]["along"] = "axis";
  scene["devices"][0]["simulation"] = {{"script", {{{"at_s", 0}, {"place_m", {0, 0, 0.05}}}}}};
  scene["effects"][0]["frequency_hz"] = 20;
  HostConfig config;
  REQUIRE(parse_scene(scene.dump(), kScenes + "s.json", &config) == "");
  const Felt all = felt(config, 2, true);
  CHECK(all.is_same);
  CHECK(all.calmed == 0);
  double most = 0;
  for (std::size_t i = 1500; i < 2000; ++i)
    most = std::max(most, all.force_n[i][2]);
  CHECK(most > 1);
}

TEST_CASE("a relief is read, written, refused by its key, felt, and replayed bit for bit") {
  HostConfig config;
  std::vector<std::string> warnings;
  REQUIRE(read_scene(kScenes + "relief.json", &config, &warnings) == "");
  REQUIRE(config.objects[0].relief);
  CHECK(config.objects[0].relief->wavelength_m == 0.002);
  CHECK(config.objects[1].relief->seed == 4);
  const std::string written = write_scene(config);
  HostConfig back;
  REQUIRE(parse_scene(written, config.scene_file, &back, nullptr, {false}) == "");
  CHECK(write_scene(back) == written);

  const Felt with_relief = felt(config, 4.5);
  CHECK(with_relief.is_same);
  CHECK(with_relief.calmed == 0);
  for (ObjectConfig& object : config.objects)
    object.relief.reset();
  const Felt without = felt(config, 4.5);
  // in the middle of the table's stroke: crests of the lateral force, 2 mm apart, over some 60 mm
  const auto crests = [](const Felt& of) {
    int count = 0;
    double last_m = -1, low = 1e9, high = -1e9;
    for (std::size_t i = 1; i + 1 < of.force_n.size(); ++i) {
      const double x = of.hip_m[i][0], f = of.force_n[i][0];
      if (x < -0.03 || x > 0.03 || of.hip_m[i][2] > 0) continue;
      low = std::min(low, f), high = std::max(high, f);
      const bool is_crest = f > of.force_n[i - 1][0] && f >= of.force_n[i + 1][0] && f > (low + high) / 2;
      if (is_crest && x - last_m > 0.001) {
        ++count;
        last_m = x;
      }
    }
    return std::make_pair(count, high - low);
  };
  const auto [count, swing] = crests(with_relief);
  CHECK(count >= 27);
  CHECK(count <= 32);
  CHECK(swing > 3 * crests(without).second);

  json scene = with(kTone);
  scene["objects"][0]["relief"] = {{"kind", "ridges"}, {"amplitude_m", 1e-4}};
  CHECK(refusal(scene).find("relief.wavelength_m is missing") != std::string::npos);
  scene["objects"][0]["relief"] = {{"kind", "grain"}, {"rms_m", 1e-5}, {"shortest_m", 0.002}, {"longest_m", 0.001}};
  CHECK(refusal(scene).find("relief.longest_m is below shortest_m") != std::string::npos);
  scene["objects"][0]["relief"]["direction"] = {1, 0, 0};
  CHECK(refusal(scene).find("direction") != std::string::npos);
  scene["objects"][0]["relief"] = {{"kind", "bumps"}, {"amplitude_m", 1e-4}, {"wavelength_m", 0.001}, {"material", "wood"}};
  CHECK(refusal(scene).find("relief.material is for the materials of a mesh") != std::string::npos);
}

// Ridges by an image and by the same wave: 1 mm apart, on a block that the scene shows twice as large as its file.
TEST_CASE("a relief of the file's image is felt as the wave that it shows, and replayed bit for bit") {
  const Folder folder;
  fdcg::bake::PolygonSoup soup = fdcg::test::scaled(fdcg::test::cube(), 0.05);
  fdcg::bake::HeightImage image;
  image.name = "ridges";
  image.width = 32, image.height = 1, image.range = 4e-6;
  for (int i = 0; i < 32; ++i)
    image.values.push_back(static_cast<float>(0.5 + 0.5 * std::sin(2 * M_PI * (i + 0.5) / 32)));
  soup.appearance.images = {image};
  soup.appearance.all_heights = 0;
  for (const std::uint32_t corner : soup.corners)
    soup.appearance.uv.push_back(
        {static_cast<float>(2000 * soup.points[corner].x), static_cast<float>(20 * soup.points[corner].y)});
  fdcg::bake::CompileOptions options;
  options.heights = true;
  const auto compiled = fdcg::bake::compile(soup, options);
  REQUIRE(compiled.has_value());
  std::ofstream(folder.file("block.fdcg"), std::ios::binary)
      .write(reinterpret_cast<const char*>(compiled->bytes.data()), static_cast<std::streamsize>(compiled->bytes.size()));
  json scene = with(kTone);
  json& block = scene["objects"][0];
  block = {{"name", "block"}, {"file", "block.fdcg"}, {"stiffness_n_per_m", 800},
           {"mu_static", 0},  {"mu_dynamic", 0},      {"pose", {{"scale", 2}}}};
  scene["devices"][0]["simulation"] = {{"hand_stiffness_n_per_m", 400},
                                       {"hand_damping_n_s_per_m", 5},
                                       {"script",
                                        {{{"at_s", 0}, {"place_m", {-0.03, 0, 0.06}}},
                                         {{"at_s", 0.5}, {"place_m", {-0.03, 0, 0.047}}},
                                         {{"at_s", 1.5}, {"place_m", {0.03, 0, 0.047}}}}}};
  const auto run = [&](const json& relief) {
    block["relief"] = relief;
    HostConfig config, back;
    REQUIRE(parse_scene(scene.dump(), folder.file("s.json"), &config) == "");
    const std::string written = write_scene(config);
    REQUIRE(parse_scene(written, config.scene_file, &back, nullptr, {false}) == "");
    CHECK(write_scene(back) == written);
    return felt(config, 1.5);
  };
  const Felt by_image = run({{"kind", "image"}});
  const Felt by_wave = run({{"kind", "ridges"}, {"amplitude_m", 2e-6}, {"wavelength_m", 0.001}});
  const Felt flat = run({{"kind", "image"}, {"off", true}});
  CHECK(by_image.is_same);
  double apart = 0, felt_n = 0;
  for (std::size_t i = 600; i < by_image.force_n.size(); ++i) {
    apart = std::max(apart, std::fabs(by_image.force_n[i][0] - by_wave.force_n[i][0]));
    felt_n = std::max(felt_n, std::fabs(by_image.force_n[i][0] - flat.force_n[i][0]));
  }
  CHECK(felt_n > 0.01);
  CHECK(apart < 0.02 * felt_n);

  // a check of the scene says how stiff it is: 4 pi^2 2e-6 m / (0.5 mm)^2 of the file, over the square of the scale
  block["relief"] = {{"kind", "image"}};
  json checked = scene;
  checked["devices"][0] = {{"name", "hand"}, {"profile", FDCG_SOURCE_DIR "/testdata/profiles/full.json"}};
  const auto warnings_at = [&](double scale) {
    checked["objects"][0]["pose"]["scale"] = scale;
    std::ofstream(folder.file("checked.json")) << checked.dump();
    const FileCheck check = check_file(folder.file("checked.json"));
    INFO(check.problem);
    REQUIRE(check.problem.empty());
    std::string all;
    for (const std::string& warning : check.warnings)
      all += warning + "\n";
    return all;
  };
  CHECK(warnings_at(2).find("the relief of object 'block'") == std::string::npos);
  CHECK(warnings_at(0.1).find("the relief of object 'block' is felt along the surface as 9") != std::string::npos);

  block["relief"] = {{"kind", "image"}, {"amplitude_m", 1e-4}};
  CHECK(refusal(scene).find("amplitude_m") != std::string::npos);
  scene = with(kTone);
  scene["objects"][0]["relief"] = {{"kind", "image"}};
  CHECK(refusal(scene).find("relief.kind is of a mesh's file, and this object has none") != std::string::npos);
}

TEST_CASE("effects of a graph's contact are those of a scene's object, bit for bit") {
  const Folder folder;
  const auto compiled = fdcg::bake::compile(fdcg::test::scaled(fdcg::test::cube(), 0.05), fdcg::bake::CompileOptions{});
  REQUIRE(compiled.has_value());
  std::ofstream(folder.file("block.fdcg"), std::ios::binary)
      .write(reinterpret_cast<const char*>(compiled->bytes.data()), static_cast<std::streamsize>(compiled->bytes.size()));
  const std::string ribs = kScenes + "ribs.json";
  const std::pair<std::string, json> effects[] = {
      {"magnet,force_n=0.5,distance_m=0.004", {{"kind", "magnet"}, {"force_n", 0.5}, {"distance_m", 0.004}}},
      {"viscosity,viscosity_n_s_per_m=2,when=slipping",
       {{"kind", "viscosity"}, {"viscosity_n_s_per_m", 2}, {"when", "slipping"}}},
      {"stick-slip,stiffness_n_per_m=300,force_n=0.2", {{"kind", "stick-slip"}, {"stiffness_n_per_m", 300}, {"force_n", 0.2}}},
      {R"({"kind": "vibration", "force_n": 0.5, "frequency_hz": 200, "along": "axis", "axis": [0, 1, 0]})",
       {{"kind", "vibration"}, {"force_n", 0.5}, {"frequency_hz", 200}, {"along", "axis"}, {"axis", {0, 1, 0}}}},
      {"noise,force_n=0.3,high_hz=300,seed=5", {{"kind", "noise"}, {"force_n", 0.3}, {"high_hz", 300}, {"seed", 5}}},
      {"tap,impact_n_s_per_m=2,frequency_hz=150,decay_s=0.01",
       {{"kind", "tap"}, {"impact_n_s_per_m", 2}, {"frequency_hz", 150}, {"decay_s", 0.01}}},
      {"pulse,force_n=0.4,duration_s=0.02,period_s=0.1,along=motion",
       {{"kind", "pulse"}, {"force_n", 0.4}, {"duration_s", 0.02}, {"period_s", 0.1}, {"along", "motion"}}},
      {"texture,texture=" + ribs, {{"kind", "texture"}, {"texture", ribs}}}};
  json scene = with(kTone), all = json::array();
  GraphEffects alone;
  for (const auto& [words, effect] : effects) {
    all.push_back(effect);
    CHECK(alone.add(words) == "");
  }
  scene["objects"][0] = {{"name", "block"}, {"file", "block.fdcg"}, {"stiffness_n_per_m", 800}, {"effects", all}};
  scene["devices"][0]["simulation"] = {{"hand_stiffness_n_per_m", 400},
                                       {"hand_damping_n_s_per_m", 5},
                                       {"script",
                                        {{{"at_s", 0}, {"place_m", {-0.015, 0, 0.03}}},
                                         {{"at_s", 0.5}, {"place_m", {-0.015, 0, 0.022}}},
                                         {{"at_s", 1.5}, {"place_m", {0.015, 0, 0.022}}}}}};
  HostConfig config;
  REQUIRE(parse_scene(scene.dump(), folder.file("s.json"), &config) == "");
  const Felt in_scene = felt(config, 1.5);
  fdcg_graph graph{};
  fdcg_error error{};
  REQUIRE(fdcg_open_file(folder.file("block.fdcg").c_str(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_OK);
  fdcg_params params = config.objects[0].params;
  params.tick_s = 1 / config.devices[0].profile.rate_hz;
  REQUIRE(alone.open(graph, params.tick_s) == "");
  fdcg_contact contact{};
  std::size_t apart = 0, felt_alone = 0;
  for (std::size_t i = 0; i < in_scene.hip_m.size(); ++i) {
    fdcg_result result{};
    fdcg_step(&graph, &params, &contact, in_scene.hip_m[i].data(), &result);
    const fdcg_result flat = result;
    alone.feel(graph, flat, in_scene.hip_m[i].data(), result.force_n);
    for (std::size_t k = 0; k < 3; ++k) {
      apart += result.force_n[k] != in_scene.force_n[i][k];
      felt_alone += result.force_n[k] != flat.force_n[k];
    }
  }
  CHECK(apart == 0);
  CHECK(felt_alone > 1000);
  fdcg_close(&graph);

  GraphEffects wrong;
  CHECK(wrong.add("magnet,force_n=0,distance_m=0.004").find("force_n is 0") == 0);
  CHECK(wrong.add("magnet,force_n=1").find("distance_m is missing") == 0);
  CHECK(wrong.add("viscosity,viscosity_n_s_per_m").find("is not KIND,KEY=VALUE") == 0);
  CHECK(wrong.add("{\"kind\": ").find("is not JSON") == 0);
  CHECK(wrong.is_empty());
}

TEST_CASE("effects are felt on an object that turns and is scaled as on one that rests") {
  json scene = with({{"kind", "viscosity"}, {"viscosity_n_s_per_m", 2}, {"when", "always"}, {"reserve_j", 1000}});
  scene["objects"][0]["surface"] = {{"kind", "sphere"}, {"radius_m", 0.001}};
  scene["objects"][0]["pose"] = {{"scale", 2}, {"translation_m", {0, 0, 1}}};
  scene["devices"][0]["simulation"] = {
      {"hand_stiffness_n_per_m", 5000}, {"hand_damping_n_s_per_m", 60}, {"script", {{{"at_s", 0}, {"place_m", {0.05, 0, 0}}}}}};
  HostConfig config;
  const auto last_force = [&] {
    REQUIRE(parse_scene(scene.dump(), kScenes + "s.json", &config) == "");
    const Felt all = felt(config, 1, false);  // it gives force at once: not to be armed
    CHECK(all.is_same);
    const auto& f = all.force_n.back();
    return std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
  };
  CHECK(last_force() < 1e-3);
  // turning about z at 2 Hz, the frame passes the hand at 2 pi 2 0.05 m/s
  scene["objects"][0]["motion"] = {{"kind", "spin"}, {"axis", {0, 0, 1}}, {"rate_hz", 2}};
  CHECK(last_force() == Approx(2 * 2 * M_PI * 2 * 0.05).epsilon(0.03));
}
