// SPDX-License-Identifier: Apache-2.0
// fdcg-servo run: the devices of a scene, until a signal, the command quit, or the time is over.
#include <cmath>
#include <cstdio>
#include <optional>

#include "../common/options.hpp"
#include "../common/terminal.hpp"
#include "fdcg/device_tools.hpp"
#include "run_fast.hpp"
#include "run_session.hpp"
#include "servo_commands.hpp"
#include "signals.hpp"

namespace fdcg::servo {
namespace {

int run_scene(const RunArguments& arguments) {
  dev::Scene scene;
  std::vector<std::string> warnings;
  if (const std::string problem = scene.read(arguments.scene, &warnings); !problem.empty()) return fail(kFile, problem);
  if (!arguments.log.empty() || arguments.no_log) scene.set_log_file(arguments.no_log ? "" : arguments.log);
  if (!arguments.hid.empty()) scene.set_backend(arguments.hid);
  if (const std::string& log = scene.log_file(); !log.empty() && dev::is_session_log(log))
    tools::warn("'" + log + "' is a session's log, and is overwritten");
  const StatusKind says = arguments.quiet ? StatusKind::kNone : arguments.status;
  if (std::floor(arguments.tap.listen) != arguments.tap.listen) return fail(kUsage, "--listen: a port is a whole number");
  if (arguments.fast) {
    if (arguments.tap.is_wanted()) return fail(kUsage, "--listen and --record are of real time; leave them or --fast out");
    if (!(arguments.for_s > 0) && scene.has_simulated_device())
      return fail(kUsage, "a simulated device never ends; say for how long it runs (--for)");
    return run_fast(std::move(scene), warnings,
                    {arguments.for_s, arguments.arm, says == StatusKind::kText, says == StatusKind::kJson});
  }
  const std::string log_file = scene.log_file();
  dev::SceneRun host;
  if (const std::string problem = host.open(std::move(scene)); !problem.empty()) return fail(kFile, problem);
  if (arguments.plugins) host.allow_plugins();
  std::optional<RunTap> tap;
  if (arguments.tap.is_wanted()) tap.emplace(arguments.tap, host);
  if (const std::string problem = tap ? tap->open() : ""; !problem.empty()) return fail(kFile, problem);
  Signals signals(&host);
  if (const std::string problem = host.start(); !problem.empty()) return fail(kFile, problem);
  for (const std::vector<std::string>& list : {warnings, host.warnings()})
    for (const std::string& warning : list)
      tools::warn(warning);
  if (!arguments.arm && !arguments.quiet && arguments.status == StatusKind::kText) {
    std::puts("Not armed: there is no force until you type arm and Enter (disarm, quit), or start with --arm.");
  }
  if (tap && tap->port() >= 0 && says != StatusKind::kNone)
    std::fprintf(stderr, "fdcg-servo: dashboard at http://127.0.0.1:%d/\n", tap->port());
  RunSession session(arguments, host, signals, log_file, tap ? &*tap : nullptr);
  session.run();
  const std::string problem = host.stop();
  const int code = session.end(problem);
  const std::string of_tap = tap ? tap->close() : "";
  return of_tap.empty() ? code : fail(kFile, of_tap);
}

}  // namespace

Command add_run(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("run", "Run a scene: read its devices, step, send forces, log.");
  command->footer(R"(Examples:
  fdcg-servo run scene.json
  fdcg-servo run scene.json --arm --for 60 --log session.fdcglog
  fdcg-servo run scene.json --arm --for 60 --fast --log session.fdcglog
  fdcg-servo run scene.json --listen 8090
  fdcg-servo run scene.json --status json --status-every 0.1 | jq .devices[0].rate_hz

Commands on standard input, one on each line: arm, disarm, quit; with --listen or --record also record and pause. On a terminal
the space bar disarms at once. The end of standard input does not end the run; Ctrl-C does,
with zero force. Any other signal that ends the program leaves zero force too (not kill -9); Ctrl-Z disarms before it stops. No
force is sent before a device is armed, nor after a fault until it is armed again. A session's log that is there is
overwritten, and that is said; no other file is.

)" + tools::exit_codes("success (a recording that has ended is no fault)",
                       "a device ended disarmed by a fault, or was never there"));
  const auto arguments = std::make_shared<RunArguments>();
  tools::required_argument(*command, "scene", "SCENE", arguments->scene, "Scene file (schemas/servo-scene.schema.json).");
  const tools::OptionGroup devices(*command, "Devices"), output(*command, "Output");
  devices.flag("--arm", arguments->arm, "Arm each device that is there at the start, once, as soon as it is free of force.");
  devices.flag(
      "--fast", arguments->fast,
      "Run simulated and recorded devices without waiting, each on a clock of its own. The log is the same every time.");
  devices.flag("--plugins", arguments->plugins,
               "Load the plugins that the scene names. They are code, and run as this program.");
  devices.number("--for", "SECONDS", arguments->for_s, {0.001, 1e9, " seconds"}, "Stop after this time, in seconds.", "no end");
  add_hid_option(devices, arguments->hid, "the scene's");
  CLI::Option* const log = output.text("--log", "FILE", arguments->log, "Write the session's log to FILE.", "the scene's");
  output.flag("--no-log", arguments->no_log, "Write no log, whatever the scene says.")->excludes(log);
  output.choice<StatusKind>("--status", "STATUS",
                            {{"text", StatusKind::kText}, {"json", StatusKind::kJson}, {"none", StatusKind::kNone}},
                            arguments->status, "What is printed during the run.");
  output.number("--status-every", "SECONDS", arguments->status_every_s, {0.01, 1e9, " seconds"},
                "Time between two status lines, in seconds.", "0.2 on a terminal, 1 elsewhere");
  output.text("--record", "FILE.jsonl", arguments->tap.record,
              "Write every tick into FILE, a line each (schemas/servo-snapshot.schema.json). FILE must not be there.");
  output.number(
      "--listen", "PORT", arguments->tap.listen, {0, 65535, ""},
      "Show the run at http://127.0.0.1:PORT/, and send snapshots and take commands by WebSocket there; 0: any free port.",
      "off");
  output.flag("-q,--quiet", arguments->quiet, "Print errors and warnings only.");
  return {command, [arguments] { return run_scene(*arguments); }};
}

}  // namespace fdcg::servo
