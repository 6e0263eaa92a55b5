#include <drev/core/units.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>

#include <algorithm>
#include <cmath>

#include "app/base/csv_cell.hpp"
#include "app/base/json_values.hpp"
#include "app/base/output_file.hpp"
#include "app/base/parameter_text.hpp"
#include "app/base/text_layout.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/model_option.hpp"
#include "app/cli/option_values.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/modes_request.hpp"
#include "app/results/modes_notes.hpp"
#include "app/results/run_json.hpp"

namespace drev::app {

namespace {

constexpr Range kSpeed{1e-6, 1e7};  // rpm
constexpr int kCount = 10;          // damped modes shown unless told otherwise

}  // namespace

ModesRequest request_modes(const CommandLine& line) {
  std::vector<Finding> findings = line.findings;
  std::optional<ModelRequest> model = build_model(line, findings);
  ModesOptions options;
  if (line.option("--contact") == "open") options.contact = Contact::open;
  std::optional<int> elastic;
  if (model) elastic = elastic_mode_count(model->system, options.contact);
  if (const auto count = line.option("--count"); count && elastic == 0)
    findings.push_back({kCommandLine, "--count", *count, "",
                        "must be left out: the model has no elastic modes" +
                            std::string(options.contact == Contact::open ? " with open contacts" : "")});
  else if (count)
    options.count = read_count("--count", *count, elastic, ", the model's elastic modes", findings);
  const bool damped = line.options.contains("--damped");
  double speed = 0.0;
  if (const auto text = line.option("--speed")) {
    speed = rpm(read_plain("--speed", *text, kSpeed, findings));
    if (!damped)
      findings.push_back(
          {kCommandLine, "--speed", *text, "rpm", "is for --damped: loads that follow the speed damp"});
  }
  const auto out = line.option("--out");
  if (out && !damped)
    findings.push_back({kCommandLine, "--out", *out, "", "is for --damped"});
  else if (out && model)
    for (const char* name : {"/modes.csv", "/shapes.csv", "/energy.csv", "/summary.json"})
      check_output("--out", *out + name, model->model_case.files, findings);
  if (!findings.empty()) throw ModelError(std::move(findings));
  return {std::move(*model), options, damped, speed, options.count, out};
}

DampedModes find_damped_modes(const ModesRequest& request) {
  DampedModesOptions options{.contact = request.options.contact};
  if (request.speed > 0.0) options.damping = load_damping(request.model.system, request.speed);
  DampedModes found{solve_damped_modes(request.model.system, options)};
  found.energy = mode_energy(request.model.system, found.set);
  found.count = std::min<std::size_t>(idx(request.count.value_or(kCount)), found.set.modes.size());
  return found;
}

namespace {

/// Seven digits, or those that rounding leaves and its error.
std::string frequency_text(double frequency, double error) {
  constexpr int kDigits = 7;
  const double known = error > 0.0 ? std::floor(std::log10(frequency / error)) : kDigits;
  if (known >= kDigits) return pad_left(digits(frequency, kDigits), 17);
  return pad_left(digits(frequency, std::max(1, static_cast<int>(known))), 17) + " +- " + digits(error, 1);
}

std::string notes_text(const ModelRequest& model) {
  std::string text;
  for (const std::string& note : modes_notes(model)) text += "\n" + wrap(note, 0);
  if (!model.model_case.note.empty()) text += "\n" + wrap(model.model_case.note, 0);
  return text;
}

std::string as_text(const ModelRequest& model, const ModeSet& modes, const std::string& contact) {
  const std::string& name = model.entry->name;
  std::string text = name + ": " + wrap(parameters_text(model.parameters), name.size() + 2);
  text += "contacts " + contact + ", " + std::to_string(modes.rigid_modes) +
          (modes.rigid_modes == 1 ? " rigid mode (0 Hz)\n\n" : " rigid modes (0 Hz)\n\n");
  if (modes.frequency_Hz.empty()) return text + "no elastic mode\n";
  text += "mode   frequency [Hz]\n";
  for (std::size_t i = 0; i < modes.frequency_Hz.size(); ++i)
    text +=
        pad_left(std::to_string(i + 1), 4) + frequency_text(modes.frequency_Hz[i], modes.error_Hz[i]) + "\n";
  return text + notes_text(model);
}

/// Time constant of a real lambda; of none that rounding leaves of zero.
std::string decay_text(double lambda, double rounding) {
  if (std::abs(lambda) <= rounding) return "0 1/s: turns freely, without drag";
  return digits(lambda, 7) + " 1/s: " + (lambda < 0.0 ? "decays" : "grows") + " with the time constant " +
         digits(1.0 / std::abs(lambda), 5) + " s";
}

/// What rounding leaves of lambda = 0 (damped_modes.hpp).
double rounding_of(const DampedModeSet& set) {
  double largest = 0.0;
  for (const DampedMode& mode : set.modes) largest = std::max(largest, std::abs(mode.lambda));
  for (const double lambda : set.real_lambda) largest = std::max(largest, std::abs(lambda));
  return 1e-13 * largest;
}

/// The element with the largest share, and the share.
std::string chief(const ModeEnergy& energy, const Eigen::MatrixXd& shares, Eigen::Index mode) {
  if (shares.rows() == 0) return "";
  Eigen::Index at = 0;
  const double share = shares.col(mode).maxCoeff(&at);
  return share > 0.0 ? energy.elements[static_cast<std::size_t>(at)] + " " + digits(100.0 * share, 3) + " %"
                     : "none";
}

std::string damped_as_text(const ModesRequest& request, const DampedModeSet& set, const ModeEnergy& energy,
                           std::size_t count) {
  const std::string& name = request.model.entry->name;
  std::string text = name + ": " + wrap(parameters_text(request.model.parameters), name.size() + 2);
  text += std::string("contacts ") + (set.contact == Contact::closed ? "closed" : "open") + ", " +
          std::to_string(set.rigid_modes) + (set.rigid_modes == 1 ? " rigid mode" : " rigid modes") +
          (request.speed > 0.0 ? ", loads at " + digits(to_rpm(request.speed), 6) + " rpm" : std::string()) +
          "\n\n";
  if (count == 0) text += "no mode that swings\n";
  if (count > 0)
    text +=
        "mode   frequency [Hz]    |lambda| [Hz]    damping ratio   Re lambda [1/s]   most elastic energy, "
        "most heat\n";
  for (std::size_t i = 0; i < count; ++i) {
    const DampedMode& mode = set.modes[i];
    const auto column = static_cast<Eigen::Index>(i);
    text += pad_left(std::to_string(i + 1), 4) + pad_left(digits(mode.frequency_Hz, 7), 17) +
            pad_left(digits(mode.natural_frequency_Hz, 7), 17) + pad_left(digits(mode.damping_ratio, 5), 17) +
            pad_left(digits(mode.lambda.real(), 6), 18) + "   " + chief(energy, energy.elastic, column) +
            ", " + chief(energy, energy.dissipated, column) + "\n";
  }
  if (!set.real_lambda.empty()) text += "\nreal eigenvalues (rigid motions' speeds and overdamped modes):\n";
  for (const double lambda : set.real_lambda) text += "  " + decay_text(lambda, rounding_of(set)) + "\n";
  return text + notes_text(request.model);
}

Json shares_object(const ModeEnergy& energy, Eigen::Index mode) {
  Json list = Json::array();
  for (std::size_t e = 0; e < energy.elements.size(); ++e) {
    const auto row = static_cast<Eigen::Index>(e);
    list.push_back({{"element", energy.elements[e]},
                    {"kinetic", number(energy.kinetic(row, mode))},
                    {"elastic", number(energy.elastic(row, mode))},
                    {"dissipated", number(energy.dissipated(row, mode))}});
  }
  return list;
}

Json damped_object(const ModesRequest& request, const DampedModeSet& set, const ModeEnergy& energy,
                   std::size_t count) {
  const System& system = request.model.system;
  Json object = result_object("damped_modes"), modes = Json::array(), real = Json::array();
  object["model"] = request.model.entry->name;
  object["parameters"] = parameters_object(request.model.parameters);
  object["contact"] = set.contact == Contact::closed ? "closed" : "open";
  object["speed_rpm"] = request.speed > 0.0 ? number(to_rpm(request.speed)) : Json();
  object["rigid_modes"] = set.rigid_modes;
  for (std::size_t i = 0; i < count; ++i) {
    const DampedMode& mode = set.modes[i];
    const auto column = static_cast<Eigen::Index>(i);
    Json shape = Json::array();
    for (int node = 0; node < system.node_count(); ++node) {
      const std::complex<double> x = set.shapes(node, column);
      shape.push_back({{"node", system.node_names()[idx(node)]},
                       {"amplitude", number(std::abs(x))},
                       {"phase_deg", number(to_deg(std::arg(x)))}});
    }
    modes.push_back({{"real_per_s", number(mode.lambda.real())},
                     {"imaginary_per_s", number(mode.lambda.imag())},
                     {"frequency_Hz", number(mode.frequency_Hz)},
                     {"modulus_Hz", number(mode.natural_frequency_Hz)},
                     {"damping_ratio", number(mode.damping_ratio)},
                     {"shape", shape},
                     {"energy", shares_object(energy, column)}});
  }
  for (const double lambda : set.real_lambda) {
    const bool still = std::abs(lambda) <= rounding_of(set);
    real.push_back({{"real_per_s", number(still ? 0.0 : lambda)}, {"turns_freely", still}});
  }
  object["modes"] = std::move(modes);
  object["real_eigenvalues"] = std::move(real);
  object["notes"] = modes_notes(request.model);
  object["note"] = text_or_null(request.model.model_case.note);
  return object;
}

/// A row a mode.
std::string damped_modes_as_csv(const DampedModeSet& set, std::size_t count) {
  std::string text = "mode,real_per_s,imaginary_per_s,frequency_Hz,modulus_Hz,damping_ratio\n";
  for (std::size_t i = 0; i < count; ++i) {
    const DampedMode& mode = set.modes[i];
    text += std::to_string(i + 1);
    for (const double value : {mode.lambda.real(), mode.lambda.imag(), mode.frequency_Hz,
                               mode.natural_frequency_Hz, mode.damping_ratio})
      text += "," + to_text(value);
    text += "\n";
  }
  return text;
}

/// A row a mode and node.
std::string shapes_as_csv(const System& system, const DampedModeSet& set, std::size_t count) {
  std::string text = "mode,node,amplitude,phase_deg\n";
  for (std::size_t i = 0; i < count; ++i)
    for (int node = 0; node < system.node_count(); ++node) {
      const std::complex<double> x = set.shapes(node, static_cast<Eigen::Index>(i));
      text += std::to_string(i + 1) + "," + csv_cell(system.node_names()[idx(node)]) + "," +
              to_text(std::abs(x)) + "," + to_text(to_deg(std::arg(x))) + "\n";
    }
  return text;
}

/// A row a mode and element.
std::string energy_as_csv(const ModeEnergy& energy, std::size_t count) {
  std::string text = "mode,element,kinetic,elastic,dissipated\n";
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t e = 0; e < energy.elements.size(); ++e) {
      const auto row = static_cast<Eigen::Index>(e), mode = static_cast<Eigen::Index>(i);
      text += std::to_string(i + 1) + "," + csv_cell(energy.elements[e]) + "," +
              to_text(energy.kinetic(row, mode)) + "," + to_text(energy.elastic(row, mode)) + "," +
              to_text(energy.dissipated(row, mode)) + "\n";
    }
  return text;
}

int damped_command(const ModesRequest& request, bool json) {
  const auto& [set, energy, count] = find_damped_modes(request);
  if (request.out) {
    create_directory(*request.out);
    write_file(*request.out, "modes", "csv", damped_modes_as_csv(set, count));
    write_file(*request.out, "shapes", "csv", shapes_as_csv(request.model.system, set, count));
    write_file(*request.out, "energy", "csv", energy_as_csv(energy, count));
    write_file(*request.out, "summary", "json", json_text(damped_object(request, set, energy, count)));
  }
  print(json ? json_text(damped_object(request, set, energy, count))
             : damped_as_text(request, set, energy, count));
  return kSuccess;
}

}  // namespace

int modes_command(const CommandLine& line) {
  const ModesRequest request = request_modes(line);
  if (request.damped) return damped_command(request, line.json);
  const ModeSet modes = solve_modes(request.model.system, request.options);
  const std::string contact = request.options.contact == Contact::closed ? "closed" : "open";
  if (line.json) {
    Json object = result_object("modes");
    object["model"] = request.model.entry->name;
    object["parameters"] = parameters_object(request.model.parameters);
    object["frequencies_Hz"] = modes.frequency_Hz;
    object["errors_Hz"] = modes.error_Hz;
    object["rigid_modes"] = modes.rigid_modes;
    object["contact"] = contact;
    object["notes"] = modes_notes(request.model);
    object["note"] = text_or_null(request.model.model_case.note);
    print(json_text(object));
  } else {
    print(as_text(request.model, modes, contact));
  }
  return kSuccess;
}

}  // namespace drev::app
