#include "core/system_builder.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace drev {

namespace {

constexpr double kSpeedTolerance = 1e-9;  // relative, constant_speed against the nominal speed
constexpr double kInitialTolerance = 1e-9;  // relative, of initial conditions that say the same

bool usable_name(const std::string& name) {
  return !name.empty() && name.find_first_of(".,\n\r\"") == std::string::npos;
}

}  // namespace

System SystemBuilder::build() {
  check_names();
  resolve_motions();
  describe_elements();
  collect_closures();
  find_nominal_motion();
  eliminate();
  check_inertias();
  set_initial();
  throw_if_findings();
  map_terms();
  assemble_matrices();
  check_values();
  finish();
  throw_if_findings();
  return std::move(system_);
}

void SystemBuilder::throw_if_findings() const {
  if (!findings_.empty()) throw ModelError(findings_);
}

void SystemBuilder::check_names() {
  system_.name_ = model_.name();
  system_.node_names_ = model_.node_names();
  system_.node_kinds_ = model_.node_kinds();
  system_.placements_ = model_.placements();
  const char* rule = "must be non-empty, without '.', ',', quotes and line ends";
  if (model_.node_names().empty())
    findings_.push_back({model_.name(), "nodes", "0", "", "the model is empty; add nodes"});
  for (std::size_t i = 0; i < system_.node_names_.size(); ++i) {
    const std::string& name = system_.node_names_[i];
    if (!usable_name(name)) findings_.push_back({model_.name(), "node name", name, "", rule});
    if (!node_by_name_.emplace(name, static_cast<int>(i)).second)
      findings_.push_back({model_.name(), "node name", name, "", "is used twice"});
  }
  std::set<std::string> names;
  for (const Placement& p : model_.placements()) {
    if (!usable_name(p.name))
      findings_.push_back({model_.name(), "element name", p.name, "", rule});
    if (!names.insert(p.name).second)
      findings_.push_back({model_.name(), "element name", p.name, "", "is used twice"});
  }
}

int SystemBuilder::resolve(const NodeRef& ref, const std::string& where,
                           const std::string& parameter) {
  const int count = static_cast<int>(system_.node_names_.size());
  if (ref.id) {
    const int i = index(*ref.id);
    if (i >= 0 && i < count) return i;
    findings_.push_back({where, parameter, std::to_string(i), "",
                         "is no node of this model (it has " + std::to_string(count) + ")"});
    return -1;
  }
  const auto found = node_by_name_.find(ref.name);
  if (found != node_by_name_.end()) return found->second;
  findings_.push_back({where, parameter, ref.name, "",
                       "is no node of this model" + did_you_mean(ref.name, system_.node_names_)});
  return -1;
}

void SystemBuilder::check_motion(const Motion& motion, const std::string& where,
                                 const std::string& parameter) {
  if (!motion.at) findings_.push_back({where, parameter, "", "", "has no function"});
  ParameterCheck(where, findings_).all_finite(parameter + " breakpoints", motion.breakpoints, "s");
}

void SystemBuilder::resolve_motions() {
  if (model_.references().size() > 1)
    findings_.push_back({model_.name(), "reference", std::to_string(model_.references().size()),
                         "", "at most one reference shaft can be set"});
  for (const auto& [ref, motion] : model_.references()) {
    check_motion(motion, model_.name(), "reference motion");
    reference_node_ = resolve(ref, model_.name(), "reference");
    system_.reference_ = motion;
  }
  for (const Model::Prescription& p : model_.prescriptions()) {
    int node = resolve(p.node, model_.name(), "prescribed node");
    inertia_in_doubt_ |= node < 0;
    const std::string where = node < 0 ? model_.name() : place(system_.node_names_[at(node)]);
    if (p.omega) ParameterCheck(where, findings_).finite("omega", *p.omega, "rad/s");
    if (p.deviation) check_motion(*p.deviation, where, "given motion");
    if (node >= 0 && p.omega && reference_node_ < 0 && model_.references().empty()) {
      reference_node_ = node;
      system_.reference_ = drev::constant_speed(std::isfinite(*p.omega) ? *p.omega : 0.0);
    }
    if (node >= 0 && std::count(resolved_prescriptions_.begin(), resolved_prescriptions_.end(), node)) {
      findings_.push_back({where, "prescribed motion", "", "", "is given twice"});
      node = -1;
    }
    resolved_prescriptions_.push_back(node);
  }
}

void SystemBuilder::collect_closures() {
  for (std::size_t e = 0; e < described_.size(); ++e) {
    if (!described_[e]) continue;
    const Described& d = *described_[e];
    rayleigh_a_ += d.terms.rayleigh_a;
    rayleigh_b_ += d.terms.rayleigh_b;
    const auto add_row = [&](const LocalRow& b, bool only_in_contact) {
      Closure row;
      row.element = model_.placements()[e].name;
      row.only_in_contact = only_in_contact;
      int entries = 0;
      for (int i = 0; i < b.size(); ++i) {
        if (b[i] == 0.0) continue;
        if (entries == 0) row.first = d.nodes[at(i)], row.b_first = b[i];
        if (entries == 1) row.second = d.nodes[at(i)], row.b_second = b[i];
        ++entries;
      }
      if (entries > 0) system_.closures_.push_back(row);
    };
    for (const ClosureSpec& c : d.terms.closures) add_row(c.b, c.only_in_contact);
    for (const LocalRow& b : d.terms.constraints) add_row(b, false);
  }
}

void SystemBuilder::find_nominal_motion() {
  system_.kinematics_ = find_ratios(model_.name(), system_.node_names_, system_.closures_,
                                    reference_node_, findings_);
  for (std::size_t i = 0; i < resolved_prescriptions_.size(); ++i) {
    const auto& p = model_.prescriptions()[i];
    const int node = resolved_prescriptions_[i];
    if (!p.omega || node < 0 || !findings_.empty()) continue;
    // At the start and wherever the reference's rate may change.
    std::vector<double> times{0.0};
    const std::vector<double>& breaks = system_.reference_->breakpoints;
    times.insert(times.end(), breaks.begin(), breaks.end());
    for (const double t : times) {
      const double nominal = system_.kinematics_.ratio[at(node)] * system_.reference_->at(t).rate;
      if (std::abs(nominal - *p.omega) <= kSpeedTolerance * std::abs(*p.omega)) continue;
      findings_.push_back({place(system_.node_names_[at(node)]), "omega", to_text(*p.omega),
                           "rad/s",
                           "but the reference shaft turns this node at " + to_text(nominal) +
                               " rad/s at t = " + to_text(t) + " s"});
      break;
    }
  }
}

void SystemBuilder::check_inertias() {
  const int unknowns = static_cast<int>(system_.unknown_node_.size());
  if (unknowns == 0 && !system_.node_names_.empty())
    findings_.push_back({model_.name(), "unknowns", "0", "",
                         "every node is prescribed; nothing is left to compute"});
  if (inertia_in_doubt_) return;
  std::vector<double> inertia(at(unknowns), 0.0);
  std::vector<bool> in_doubt(at(unknowns), false);
  const auto unknown = [this](int node) { return system_.node_map_[at(node)].unknown; };
  for (std::size_t e = 0; e < described_.size(); ++e) {
    const std::vector<int>& nodes = element_nodes_[e];
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i] < 0 || unknown(nodes[i]) < 0) continue;
      const int k = unknown(nodes[i]);
      if (!described_[e]) in_doubt[at(k)] = true;
      if (!described_[e]) continue;
      for (std::size_t j = 0; j < nodes.size(); ++j)
        if (unknown(nodes[j]) == k)
          inertia[at(k)] += described_[e]->terms.mass(static_cast<Eigen::Index>(i),
                                                      static_cast<Eigen::Index>(j)) *
                            system_.node_map_[at(nodes[i])].coeff *
                            system_.node_map_[at(nodes[j])].coeff;
    }
  }
  for (int k = 0; k < unknowns; ++k) {
    const int node = system_.unknown_node_[at(k)];
    const auto same_name = node_by_name_.find(system_.node_names_[at(node)]);
    if (inertia[at(k)] > 0.0 || in_doubt[at(k)] || same_name->second != node) continue;
    const bool turns = system_.node_kinds_[at(node)] == NodeKind::rotational;
    findings_.push_back(
        {place(system_.node_names_[at(node)]), turns ? "inertia" : "mass",
         to_text(inertia[at(k)]), turns ? "kg m^2" : "kg",
         "every node that is not prescribed needs an inertia > 0: add one, or replace the "
         "springs on both sides by one"});
  }
}

void SystemBuilder::set_initial() {
  const auto unknowns = static_cast<Eigen::Index>(system_.unknown_node_.size());
  system_.initial_z_ = Vector::Zero(unknowns);
  system_.initial_v_ = Vector::Zero(unknowns);
  std::vector<int> set_by(system_.unknown_node_.size(), -1);
  const auto differ = [](double a, double b) {
    return std::abs(a - b) > kInitialTolerance * std::max(std::abs(a), std::abs(b));
  };
  for (const Model::Initial& initial : model_.initials()) {
    const int node = resolve(initial.node, model_.name(), "initial condition");
    if (node < 0) continue;
    ParameterCheck check(place(system_.node_names_[at(node)]), findings_);
    const bool turns = system_.node_kinds_[at(node)] == NodeKind::rotational;
    check.finite("initial deviation", initial.deviation, turns ? "rad" : "m");
    check.finite("initial rate", initial.rate, turns ? "rad/s" : "m/s");
    const NodeMap& map = system_.node_map_[at(node)];
    if (map.unknown < 0) {
      check.fail("initial deviation", to_text(initial.deviation), turns ? "rad" : "m",
                 "the node is prescribed; its motion is given");
      continue;
    }
    double& z = system_.initial_z_[map.unknown];
    double& v = system_.initial_v_[map.unknown];
    int& by = set_by[at(map.unknown)];
    if (by >= 0 && differ(map.coeff * z, initial.deviation))
      check.fail("initial deviation", to_text(initial.deviation), turns ? "rad" : "m",
                 "but that of " + system_.node_names_[at(by)] + " gives " + to_text(map.coeff * z));
    if (by >= 0 && differ(map.coeff * v, initial.rate))
      check.fail("initial rate", to_text(initial.rate), turns ? "rad/s" : "m/s",
                 "but that of " + system_.node_names_[at(by)] + " gives " + to_text(map.coeff * v));
    z = initial.deviation / map.coeff;
    v = initial.rate / map.coeff;
    by = node;
  }
}

void SystemBuilder::finish() {
  std::vector<double>& all = system_.breakpoints_;
  const auto append = [&all](const std::vector<double>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  for (const LoadTerm& load : system_.loads_) append(load.load->breakpoints());
  for (const Motion& motion : system_.prescribed_) append(motion.breakpoints);
  if (system_.reference_) append(system_.reference_->breakpoints);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
}

}  // namespace drev
