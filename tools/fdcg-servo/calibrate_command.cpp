// SPDX-License-Identifier: Apache-2.0
// fdcg-servo calibrate: the scales and offsets of a device's axes, from poses that the user puts it into, without force.
#include <cmath>
#include <cstdio>
#include <iostream>

#include "../common/atomic_file.hpp"
#include "../common/terminal.hpp"
#include "fdcg/device_tools.hpp"
#include "servo_commands.hpp"

namespace fdcg::servo {
namespace {

using dev::AxisMeasure;

constexpr double kHeldS = 0.5;       // of a pose that is measured
constexpr double kLeastCounts = 20;  // between two poses
constexpr double kMostShake = 0.02;  // while a pose is held, of the way between the two
constexpr int kMostTries = 5;
constexpr double kQuarterTurn_rad = 0.7853981633974483;

struct CalibrateArguments {
  std::string scene, device, output;
  double from = NAN, to = NAN, workspace_s = 0;
};

// Asks for something to be done, and waits for Enter. False: the input has ended.
bool ask(const std::string& what) {
  std::printf("%s, and press Enter. ", what.c_str());
  std::fflush(stdout);
  std::string line;
  return static_cast<bool>(std::getline(std::cin, line));
}

std::string number_text(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", number);
  return text;
}

class Calibration {
 public:
  Calibration(const CalibrateArguments& arguments, dev::AxisReader& reader) : arguments_(arguments), reader_(reader) {
    const bool is_angle = std::string(reader.unit()) == "rad";
    from_ = std::isnan(arguments.from) ? (is_angle ? -kQuarterTurn_rad : -0.05) : arguments.from;
    to_ = std::isnan(arguments.to) ? -from_ : arguments.to;
  }

  // Empty, or why there is no result.
  std::string run() {
    if (from_ == to_) return "--from and --to are one place; give two";
    for (int axis = 0; axis < reader_.axis_count(); ++axis) {
      if (const std::string problem = measure_axis(axis); !problem.empty()) return problem;
    }
    return arguments_.workspace_s > 0 ? measure_workspace() : "";
  }
  std::string profile(std::string* json) const {
    return dev::calibrated_profile(reader_.profile_text(), axes_, has_workspace_ ? &workspace_ : nullptr, json);
  }

 private:
  std::string measure_axis(int axis) {
    double places[2] = {}, shake = 0;
    for (int i = 0; i < 2; ++i) {
      AxisMeasure pose;
      const std::string name = "axis " + std::to_string(axis);
      const std::string value = number_text(i == 0 ? from_ : to_) + " " + reader_.unit();
      for (int tries = 0;; ++tries) {
        if (!ask("Put " + name + " at " + value + ", hold it still")) return "ended before every axis was measured";
        if (const std::string problem = reader_.measure(kHeldS, &pose); !problem.empty()) return problem;
        places[i] = pose.mean[axis];
        shake = pose.most[axis] - pose.least[axis];
        const double way = std::fabs(places[1] - places[0]);
        const bool is_still = i == 0 || shake <= kMostShake * way,
                   is_far = i == 0 || way >= kLeastCounts || is_text(way, shake);
        if (is_still && is_far) break;
        if (tries == kMostTries) return name + (is_far ? " was never held still" : " did not move; is it another one?");
        std::printf("%s\n", is_far ? "It moved meanwhile; once more." : "It has not moved; once more.");
      }
    }
    dev::AxisScale& scale = axes_.emplace_back();
    scale.scale = (to_ - from_) / (places[1] - places[0]);
    scale.bias = from_ - scale.scale * places[0];
    reader_.set_scale(axis, scale.scale, scale.bias);
    std::printf("axis %d: %s %s a count, offset %s %s, noise %s %s\n", axis, number_text(scale.scale).c_str(), reader_.unit(),
                number_text(scale.bias).c_str(), reader_.unit(), number_text(std::fabs(scale.scale) * shake).c_str(),
                reader_.unit());
    return {};
  }

  // A line of text has no counts: there the way is judged by its noise.
  static bool is_text(double way, double shake) { return way > 0 && way < 1 && shake <= kMostShake * way; }

  std::string measure_workspace() {
    if (!ask("Move the tip to every end of its workspace for " + number_text(arguments_.workspace_s) + " s from now on"))
      return "ended before the workspace was measured";
    if (const std::string problem = reader_.measure(arguments_.workspace_s, &workspace_); !problem.empty()) return problem;
    for (int i = 0; i < 3; ++i) {
      if (i < reader_.axis_count() && !(workspace_.tip_least_m[i] < workspace_.tip_most_m[i])) return "the tip was not moved";
    }
    has_workspace_ = true;
    std::printf("workspace: x %s to %s, y %s to %s, z %s to %s m\n", number_text(workspace_.tip_least_m[0]).c_str(),
                number_text(workspace_.tip_most_m[0]).c_str(), number_text(workspace_.tip_least_m[1]).c_str(),
                number_text(workspace_.tip_most_m[1]).c_str(), number_text(workspace_.tip_least_m[2]).c_str(),
                number_text(workspace_.tip_most_m[2]).c_str());
    return {};
  }

  const CalibrateArguments& arguments_;
  dev::AxisReader& reader_;
  double from_ = 0, to_ = 0;
  std::vector<dev::AxisScale> axes_;
  AxisMeasure workspace_;
  bool has_workspace_ = false;
};

int calibrate(const CalibrateArguments& arguments) {
  if (tools::is_same_file(arguments.scene, arguments.output))
    return fail(kUsage, "'" + arguments.output + "' would overwrite the scene");
  if (tools::is_stream(arguments.output)) return fail(kUsage, "-o: name a file; standard output is for what to do");
  dev::AxisReader reader;
  if (const std::string problem = reader.open(arguments.scene, arguments.device); !problem.empty()) return fail(kFile, problem);
  tools::AtomicFile output(arguments.output);
  if (!output.ok()) return fail(kFile, output.error());
  Calibration calibration(arguments, reader);
  if (const std::string problem = calibration.run(); !problem.empty()) return fail(kFindings, problem);
  std::string profile;
  if (const std::string problem = calibration.profile(&profile); !problem.empty()) return fail(kFindings, problem);
  output.write(profile);
  if (!output.commit()) return fail(kFile, output.error());
  std::printf("%s is the profile with these numbers: name it in the scene.\n", arguments.output.c_str());
  return kClean;
}

}  // namespace

Command add_calibrate(CLI::App& app) {
  CLI::App* const command =
      app.add_subcommand("calibrate", "Measure a device's scales and offsets, and write its profile. No force.");
  command->footer(R"(Examples:
  fdcg-servo calibrate scene.json -o my-device.json
  fdcg-servo calibrate scene.json --device left --from 0 --to 0.1 -o left.json
  fdcg-servo calibrate scene.json --workspace 20 -o my-device.json

Each axis is put into two known places. Where an axis then counts the other way than the profile said, its effort changes its
sign too: motor and encoder belong together. Limits other than the workspace stay as they are.

)" + tools::exit_codes("the profile is written", "the device was not held still, or was gone; nothing is written"));
  const auto arguments = std::make_shared<CalibrateArguments>();
  tools::required_argument(*command, "scene", "SCENE", arguments->scene,
                           "Scene file that names the device and how it is reached.");
  const tools::OptionGroup device(*command, "Device"), output(*command, "Output");
  device.text("--device", "NAME", arguments->device, "Which device of the scene.", "the only one");
  device.number("--from", "VALUE", arguments->from, {-10, 10, ""}, "First place of every axis, in m or rad.",
                "-0.05 m, or an eighth of a turn back");
  device.number("--to", "VALUE", arguments->to, {-10, 10, ""}, "Second place of every axis.", "as far on the other side");
  device.number("--workspace", "SECONDS", arguments->workspace_s, {1, 600, " seconds"},
                "Measure the workspace too, while the tip is moved to all its ends.", "not measured");
  output.text("-o,--output", "FILE.json", arguments->output, "Write the profile to FILE.")->required();
  return {command, [arguments] { return calibrate(*arguments); }};
}

}  // namespace fdcg::servo
