// SPDX-License-Identifier: Apache-2.0
// fdcg grasp: do these contacts hold this object, and how well?
#include <algorithm>
#include <cmath>
#include <memory>

#include "../common/atomic_file.hpp"
#include "../common/options.hpp"
#include "../common/terminal.hpp"
#include "fdcg/grasp.hpp"
#include "fdcg_commands.hpp"
#include "grasp_contacts.hpp"
#include "grasp_object.hpp"
#include "grasp_report.hpp"
#include "mesh_options.hpp"
#include "points.hpp"

namespace fdcg::tools {
namespace {

using bake::Vec3;

struct GraspArguments {
  std::string object, contacts;
  std::string output = "-";
  std::string unit_text;
  bake::CompileOptions compile;
  std::optional<double> mu, torsion_m, pad_radius_m, cap_n, torque_scale_m, mass_kg, grip_n;
  std::optional<Vec3> centre_m, com_m, gravity_m_per_s2;
  std::optional<grasp::Wrench> load;
  grasp::Effort effort = grasp::Effort::together;
  std::uint64_t cones = 200'000;
  bool json = false;
};

// The numbers of "a,b,c"; a ValidationError where there are not as many as one of `counts`.
std::vector<double> parse_numbers(const std::string& option, const std::string& text, const std::vector<std::size_t>& counts) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<double> numbers;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t comma = std::min(text.find(',', start), text.size());
    const auto value = parse_number_between(text.substr(start, comma - start), -kInfinity, kInfinity);
    if (!value) throw CLI::ValidationError(option, "'" + text + "' is no list of numbers such as 0,0,-9.81");
    numbers.push_back(*value);
    start = comma + 1;
  }
  if (std::find(counts.begin(), counts.end(), numbers.size()) == counts.end())
    throw CLI::ValidationError(option, "'" + text + "' has " + std::to_string(numbers.size()) + " numbers, not " +
                                           std::to_string(counts.front()) + (counts.size() > 1 ? " or 6" : ""));
  return numbers;
}

// The largest moment of a contact about its normal for each newton pressed: what the file says of it, else the command line.
double torsion_of(const GraspArguments& arguments, const NamedContact& asked, double mu) {
  if (asked.torsion_m) return *asked.torsion_m;
  if (asked.pad_radius_m) return mu * *asked.pad_radius_m;
  if (arguments.pad_radius_m) return mu * *arguments.pad_radius_m;
  return arguments.torsion_m.value_or(0);
}

// A length that is far beyond the object's: of the file or of the option, whichever said it.
int check_torsion(const GraspArguments& arguments, const NamedContact& asked, double torsion_m, double torque_scale_m) {
  const double most_m = grasp::kMostTorsionScales * torque_scale_m;
  if (torsion_m <= most_m) return kClean;
  const std::string words = short_number(torsion_m) + ", allowed 0 to " + short_number(most_m) + " m, " +
                            short_number(grasp::kMostTorsionScales) + " torque scales";
  if (asked.torsion_m || asked.pad_radius_m)
    return fail(kFile, arguments.contacts + ": " + asked.name + ": torsion is " + words);
  return fail(kUsage, (arguments.pad_radius_m ? "mu times --pad-radius is " : "--torsion is ") + words);
}

// Pressing against the face's normal is what a contact does; a normal that points the other way is most often one of the
// surface, which points outward.
bool points_outward(const NamedContact& asked, const SurfacePoint& found) {
  if (!asked.inward || found.is_on_edge) return false;
  constexpr double kRounding = 1e-9;
  return dot(*asked.inward, found.outward) > kRounding;
}

// The report's contacts: on the surface, with what the file or the command line says of them.
int place_contacts(const GraspArguments& arguments, const GraspObject& object, GraspReport& report) {
  for (const NamedContact& asked : report.asked) {
    const SurfacePoint found = object.nearest(asked.point_m);
    const auto mu = asked.mu ? asked.mu : arguments.mu;
    if (!mu) return fail(kUsage, arguments.contacts + ": " + asked.name + " has no mu; give it there or with --mu");
    grasp::Contact contact;
    contact.point_m = found.point_m;
    contact.inward = asked.inward ? *asked.inward : Vec3{0 - found.outward.x, 0 - found.outward.y, 0 - found.outward.z};
    contact.mu = *mu;
    contact.torsion_m = torsion_of(arguments, asked, *mu);
    if (const int code = check_torsion(arguments, asked, contact.torsion_m, report.grasp.torque_scale_m); code != kClean)
      return code;
    contact.cap_n = asked.cap_n.value_or(arguments.cap_n.value_or(std::numeric_limits<double>::infinity()));
    report.grasp.contacts.push_back(contact);
    report.found.push_back(found);
    constexpr double kFar = 0.01;        // of the object's size: more likely a slip of the pen than a rounding
    constexpr double kElsewhere = 0.25;  // of it: what is reported is not the grasp that was meant
    if (found.distance_m > kFar * object.size_m()) {
      const bool is_elsewhere = found.distance_m > kElsewhere * object.size_m();
      report.has_far_contacts = report.has_far_contacts || is_elsewhere;
      report.warnings.push_back(asked.name + " was moved " + short_number(found.distance_m) + " m to the surface, " +
                                short_number(100 * found.distance_m / object.size_m()) + " % of the object's size" +
                                (is_elsewhere ? "; are both in metres, in the same frame (--units)?" : ""));
    }
    if (found.is_on_edge && !asked.inward) {
      report.warnings.push_back(asked.name + " lies on an edge; its normal is that of node " + std::to_string(found.node) +
                                ". Move it, or give its normal");
    }
    if (points_outward(asked, found))
      report.warnings.push_back(asked.name +
                                ": its normal points out of the object; a contact presses inward. Turn the normal");
  }
  return kClean;
}

int set_frame(const GraspArguments& arguments, const GraspObject& object, GraspReport& report) {
  report.com_m = arguments.com_m ? arguments.com_m : object.centroid_m();
  report.com_from = arguments.com_m ? "option" : "volume";
  if (!arguments.centre_m && !report.com_m) {
    return fail(kUsage, arguments.object + ": the surface encloses no volume, so its centre of mass is not known; " +
                            "give --com X,Y,Z (or --centre X,Y,Z where no load is asked for)");
  }
  report.grasp.centre_m = arguments.centre_m ? *arguments.centre_m : *report.com_m;
  report.centre_from = arguments.centre_m ? "option" : report.com_from;
  report.torque_scale_from = arguments.torque_scale_m ? "option" : "size";
  report.grasp.torque_scale_m = arguments.torque_scale_m.value_or(object.farthest_from(report.grasp.centre_m));
  return kClean;
}

bool has_grip(const GraspArguments& arguments, const grasp::Grasp& grasp) {
  return arguments.grip_n.has_value() || std::all_of(grasp.contacts.begin(), grasp.contacts.end(),
                                                     [](const auto& contact) { return std::isfinite(contact.cap_n); });
}

// The load acts at the centre of mass, wherever torques are reckoned about: no verdict depends on that choice.
int set_load(const GraspArguments& arguments, const GraspObject& object, GraspReport& report) {
  if (!report.com_m && has_grip(arguments, report.grasp)) {
    return fail(kUsage, arguments.object + ": the surface encloses no volume, so where its weight acts is not known; " +
                            "give its centre of mass, --com X,Y,Z");
  }
  constexpr double kStandardGravity = 9.80665;  // m/s^2
  if (arguments.load) {
    report.load = *arguments.load;
    report.load_text = "option";
  } else {
    const Vec3 g = arguments.gravity_m_per_s2.value_or(Vec3{0, 0, -kStandardGravity});
    const double mass = arguments.mass_kg.value_or(object.mass_kg().value_or(1));
    report.load.force_n = {mass * g.x, mass * g.y, mass * g.z};
    report.load_text = "the weight of " + short_number(mass) + " kg";
  }
  const Vec3 com = report.com_m.value_or(report.grasp.centre_m);
  const Vec3 arm = plus(com, -1, report.grasp.centre_m);
  report.load.torque_nm = plus(report.load.torque_nm, 1, cross(arm, report.load.force_n));
  if (const auto problem = grasp::problem_of(report.load, report.grasp.torque_scale_m))
    return fail(kUsage, *problem + " (--load, --gravity, --mass)");
  return kClean;
}

int run_grasp(const GraspArguments& arguments) {
  if (arguments.object == "-" && arguments.contacts == "-")
    return fail(kUsage,
                "OBJECT and --contacts are both '-', and standard input can be only one of them; name a file for the other");
  if (arguments.output.empty()) return fail(kUsage, "-o needs the name of a file; it is empty");
  for (const std::string* input : {&arguments.object, &arguments.contacts}) {
    if (is_same_file(*input, arguments.output)) return fail(kUsage, "'" + arguments.output + "' would overwrite an input");
  }
  if (!arguments.unit_text.empty() && is_graph_file(arguments.object))
    return fail(kUsage, "--units and --scale are for meshes; '" + arguments.object + "' is an FDCG file, which is in metres");
  const auto contacts = read_contacts(arguments.contacts);
  if (!contacts) return fail(contacts.error().exit_code, contacts.error().message);
  const auto object = GraspObject::load(arguments.object, arguments.compile, !arguments.unit_text.empty());
  if (!object) {
    if (object.error().exit_code != kFindings) return fail(object.error().exit_code, object.error().message);
    std::fputs(object.error().message.c_str(), stderr);
    return kFindings;
  }
  GraspReport report;
  report.object = arguments.object;
  report.faces = object->face_count();
  report.asked = *contacts;
  if (const int code = set_frame(arguments, *object, report); code != kClean) return code;
  if (const int code = place_contacts(arguments, *object, report); code != kClean) return code;
  if (const auto problem = grasp::problem_of(report.grasp))  // what is left is a matter of the centre and the scale
    return fail(kUsage, *problem + " (--centre, --torque-scale)");
  if (const int code = set_load(arguments, *object, report); code != kClean) return code;
  report.closure = grasp::force_closure(report.grasp);
  report.effort = arguments.effort;
  ProgressBar bar(true);
  report.epsilon = grasp::ferrari_canny(report.grasp, arguments.effort, arguments.cones,
                                        [&bar](std::string_view stage, double done) { bar.update(stage, done); });
  bar.wipe();
  report.grip_n = arguments.grip_n;
  if (has_grip(arguments, report.grasp)) {
    report.margin =
        grasp::slip_margin(report.grasp, report.load, arguments.grip_n.value_or(std::numeric_limits<double>::infinity()));
  }
  AtomicFile out(arguments.output);
  out.write(arguments.json ? grasp_report_json(report) : grasp_report_text(report));
  if (const int code = commit_all({&out}); code != kClean) return code;
  for (const std::string& warning : report.warnings)
    warn(warning);
  const bool slips = report.margin && !(report.margin->load_factor >= 1);
  return report.closure.verdict == grasp::Verdict::closure && !slips && !report.has_far_contacts ? kClean : kFindings;
}

CLI::Option* add_number(const OptionGroup& group, const std::string& name, const std::string& value_name,
                        std::optional<double>& value, bool may_be_zero, const std::string& help,
                        const std::string& shown_default = {}, double most = std::numeric_limits<double>::max()) {
  const auto parse = [name, &value, may_be_zero, most](const std::string& text) {
    const auto parsed =
        parse_number_between(text, -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity());
    constexpr double kLeast = grasp::kLeastForce_n;  // smaller ones lose digits
    const bool has_most = most < std::numeric_limits<double>::max();
    if (!parsed || *parsed < 0 || (*parsed < kLeast && !may_be_zero) || *parsed > most)
      throw CLI::ValidationError(
          name, "'" + text + "' is no number " + (may_be_zero ? "from 0 " : "above 0") +
                    (has_most ? (may_be_zero ? "to " : " and up to ") + short_number(most) : (may_be_zero ? "up" : "")));
    value = parsed;
  };
  return group.parsed(name, value_name, parse, help, shown_default);
}

CLI::Option* add_vector(const OptionGroup& group, const std::string& name, std::optional<Vec3>& value, const std::string& help,
                        const std::string& shown_default) {
  const auto parse = [name, &value](const std::string& text) {
    const auto v = parse_numbers(name, text, {3});
    value = Vec3{v[0], v[1], v[2]};
  };
  return group.parsed(name, "X,Y,Z", parse, help, shown_default);
}

void add_load_options(CLI::App& command, GraspArguments& arguments) {
  const OptionGroup group(command, "Load");
  add_number(group, "--grip", "N", arguments.grip_n, false,
             "The largest sum of the normal forces of all contacts, in newtons. Asks for the margin.", "", grasp::kMostForce_n);
  add_number(group, "--cap", "N", arguments.cap_n, false,
             "The largest normal force of each contact, in newtons. Asks for the margin.", "", grasp::kMostForce_n);
  const auto parse_load = [&arguments](const std::string& text) {
    const auto v = parse_numbers("--load", text, {3, 6});
    grasp::Wrench load;
    load.force_n = {v[0], v[1], v[2]};
    if (v.size() == 6) load.torque_nm = {v[3], v[4], v[5]};
    arguments.load = load;
  };
  CLI::Option* const load = group.parsed(
      "--load", "FX,FY,FZ,TX,TY,TZ", parse_load,
      "Force (N) at the centre of mass, and torque about it (N m). The torque may be left out.", "the object's weight");
  load->excludes(add_number(group, "--mass", "KG", arguments.mass_kg, false, "Mass of the object in kg.",
                            "the FDCG file's, else 1, so that the load factor is in kg"));
  load->excludes(add_vector(group, "--gravity", arguments.gravity_m_per_s2, "Acceleration of gravity, m/s^2.", "0,0,-9.80665"));
  add_vector(group, "--com", arguments.com_m, "Centre of mass, in metres: where the load acts.", "the centroid of the volume");
}

}  // namespace

Command add_grasp(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("grasp", "Test whether contacts hold an object, and how well.");
  command->footer(R"(Examples:
  fdcg grasp cube.fdcg --contacts fingers.csv --mu 0.5
  fdcg grasp part.stl --units mm --contacts fingers.json --mu 0.4 --torsion 0.003 --grip 20 --mass 0.3
  fdcg grasp cube.fdcg --contacts fingers.csv --mu 0.5 --cap 10 --load 0,0,-5,0.1,0,0 --json

Contacts are a CSV file with a header that names x, y and z, and any of mu, torsion, pad_radius, cap, nx, ny, nz and name; or a JSON array
of objects with "point": [x, y, z] and any of "mu", "torsion", "pad_radius", "cap", "normal" and "name". They are in metres in the object's
frame, and are moved to the nearest point of the surface.

)" + exit_codes("force closure, and the load holds if a grip is given",
                "no closure, the load slips, a contact is far from the surface, or the mesh has errors"));
  const auto arguments = std::make_shared<GraspArguments>();
  required_argument(*command, "object", "OBJECT", arguments->object, "FDCG file, or a mesh without errors.");
  const OptionGroup contacts(*command, "Contacts");
  contacts.text("--contacts", "FILE", arguments->contacts, "Where the object is touched: JSON or CSV. - is standard input.")
      ->required();
  add_number(contacts, "--mu", "MU", arguments->mu, true, "Friction coefficient of contacts that state none.", "",
             grasp::kMostMu);
  CLI::Option* const torsion = add_number(
      contacts, "--torsion", "METRES", arguments->torsion_m, true,
      "Soft fingers: the largest moment about the normal, in N m for each newton of normal force.", "0, hard fingers");
  add_number(contacts, "--pad-radius", "METRES", arguments->pad_radius_m, true,
             "Soft fingers by the radius of their pads, as in scenes: the torsion is mu times it.")
      ->excludes(torsion);
  add_load_options(*command, *arguments);
  const OptionGroup quality(*command, "Quality"), output(*command, "Output");
  add_vector(quality, "--centre", arguments->centre_m, "Point that torques are reckoned about, in metres; for epsilon alone.",
             "the centre of mass");
  add_number(quality, "--torque-scale", "METRES", arguments->torque_scale_m, false,
             "Length by which torques are divided, in metres.", "the largest distance of a corner from the centre");
  quality.choice<grasp::Effort>("--epsilon", "EFFORT", {{"together", grasp::Effort::together}, {"each", grasp::Effort::each}},
                                arguments->effort, "Epsilon is for 1 N of normal force of all contacts together, or of each.");
  command->add_option("--cones", arguments->cones, "The largest number of directions searched for epsilon.")
      ->type_name("N")
      ->default_str("200000")
      ->check(whole_number(1, 100'000'000))
      ->group("Quality");
  add_unit_options(*command, arguments->compile.metres_per_unit, arguments->unit_text);
  output.flag("--json", arguments->json, "Print JSON (schemas/grasp-report.schema.json).");
  output.text("-o,--output", "FILE", arguments->output, "Write the report to FILE.", "standard output");
  return {command, [arguments] { return run_grasp(*arguments); }};
}

}  // namespace fdcg::tools
