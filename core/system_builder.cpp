#include "core/system_builder.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace drev {

namespace {

constexpr double kSpeedTolerance = 1e-9;  // relative, constant_speed against the nominal speed

bool usable_name(const std::string& name) {
  return !name.empty() && name.find_first_of(".,\n\r\"") == std::string::npos;
}

}  // namespace

System SystemBuilder::build() {
  check_names();
  describe_elements();
  throw_if_findings();
  find_reference();
  eliminate();
  throw_if_findings();
  map_terms();
  assemble_matrices();
  check_inertias();
  set_initial();
  throw_if_findings();
  finish();
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

void SystemBuilder::describe_elements() {
  for (const Placement& p : model_.placements()) {
    const std::string where = place(p.name);
    std::vector<int> nodes;
    bool usable = true;
    for (std::size_t i = 0; i < p.nodes.size(); ++i) {
      nodes.push_back(resolve(p.nodes[i], where, "node " + std::to_string(i + 1)));
      usable = usable && nodes.back() >= 0;
      if (usable && std::count(nodes.begin(), nodes.end(), nodes.back()) > 1) {
        findings_.push_back({where, "node " + std::to_string(i + 1),
                             system_.node_names_[at(nodes.back())], "",
                             "is given twice; the ends must differ"});
        usable = false;
      }
    }
    const int given = static_cast<int>(p.nodes.size());
    const int low = p.element->min_nodes(), high = p.element->max_nodes();
    if (given < low || given > high) {
      findings_.push_back({where, "nodes", std::to_string(given), "",
                           "a " + std::string(p.element->type()) + " takes " +
                               std::to_string(low) +
                               (high > low ? " or " + std::to_string(high) : std::string())});
      usable = false;
    }
    const std::size_t before = findings_.size();
    ParameterCheck check(where, findings_);
    p.element->check(check);
    if (findings_.size() > before) usable = false;
    for (const NodeId id : p.internal) nodes.push_back(index(id));
    described_.emplace_back();
    if (usable) {
      Terms terms(static_cast<int>(nodes.size()));
      p.element->describe(static_cast<int>(nodes.size()), terms);
      described_.back() = Described{nodes, std::move(terms)};
    }
    element_nodes_.push_back(std::move(nodes));
  }
}

void SystemBuilder::find_reference() {
  for (std::size_t e = 0; e < described_.size(); ++e) {
    const Described& d = *described_[e];
    const std::string& name = model_.placements()[e].name;
    rayleigh_a_ += d.terms.rayleigh_a;
    rayleigh_b_ += d.terms.rayleigh_b;
    const auto add_row = [&](const LocalRow& b, bool only_in_contact) {
      Closure row;
      row.element = name;
      row.only_in_contact = only_in_contact;
      int entries = 0;
      for (int i = 0; i < b.size(); ++i) {
        if (b[i] == 0.0) continue;
        if (entries == 0) row.first = d.nodes[at(i)], row.b_first = b[i];
        if (entries == 1) row.second = d.nodes[at(i)], row.b_second = b[i];
        ++entries;
      }
      if (entries == 1 || entries == 2) system_.closures_.push_back(row);
      if (entries > 2)
        findings_.push_back({place(name), "closure", std::to_string(entries), "nodes",
                             "an element may tie at most two nodes to each other"});
    };
    for (const ClosureSpec& c : d.terms.closures) add_row(c.b, c.only_in_contact);
    for (const LocalRow& b : d.terms.constraints) add_row(b, false);
  }

  // The reference: set explicitly, or the first node of constant speed.
  if (model_.references().size() > 1)
    findings_.push_back({model_.name(), "reference", std::to_string(model_.references().size()),
                         "", "at most one reference shaft can be set"});
  for (const auto& [ref, motion] : model_.references()) {
    if (!motion.at)
      findings_.push_back({model_.name(), "reference motion", "", "", "has no function"});
    reference_node_ = resolve(ref, model_.name(), "reference");
    system_.reference_ = motion;
  }
  for (const Model::Prescription& p : model_.prescriptions()) {
    const int node = resolve(p.node, model_.name(), "prescribed node");
    resolved_prescriptions_.push_back(node);
    if (p.omega && !std::isfinite(*p.omega))
      findings_.push_back({place(p.node.id ? "node" : p.node.name), "omega", to_text(*p.omega),
                           "rad/s", "must be finite"});
    if (p.deviation && !p.deviation->at)
      findings_.push_back({model_.name(), "given motion", "", "", "has no function"});
    if (node >= 0 && p.omega && reference_node_ < 0 && model_.references().empty()) {
      reference_node_ = node;
      system_.reference_ = drev::constant_speed(std::isfinite(*p.omega) ? *p.omega : 0.0);
    }
  }
  throw_if_findings();
  system_.kinematics_ = find_ratios(model_.name(), system_.node_names_, system_.closures_,
                                    reference_node_, findings_);
  for (std::size_t i = 0; i < resolved_prescriptions_.size(); ++i) {
    const auto& p = model_.prescriptions()[i];
    if (!p.omega || !findings_.empty()) continue;
    const int node = resolved_prescriptions_[i];
    const double nominal = system_.kinematics_.ratio[at(node)] * system_.reference_->at(0.0).rate;
    if (std::abs(nominal - *p.omega) > kSpeedTolerance * std::abs(*p.omega))
      findings_.push_back({place(system_.node_names_[at(node)]), "omega", to_text(*p.omega),
                           "rad/s",
                           "but the reference shaft turns this node at " + to_text(nominal) +
                               " rad/s"});
  }
}

void SystemBuilder::check_inertias() {
  if (system_.size() == 0)
    findings_.push_back({model_.name(), "unknowns", "0", "",
                         "every node is prescribed; nothing is left to compute"});
  for (int k = 0; k < system_.size(); ++k) {
    double inertia = 0.0;
    for (SparseMatrix::InnerIterator it(system_.pattern_, k); it; ++it)
      if (it.row() == k)
        inertia = system_.mass_[static_cast<Eigen::Index>(&it.value() -
                                                          system_.pattern_.valuePtr())];
    if (!(inertia > 0.0)) {
      const int node = system_.unknown_node_[at(k)];
      const bool turns = system_.node_kinds_[at(node)] == NodeKind::rotational;
      findings_.push_back(
          {place(system_.node_names_[at(node)]), turns ? "inertia" : "mass", to_text(inertia),
           turns ? "kg m^2" : "kg",
           "every node that is not prescribed needs an inertia > 0: add one, or replace the "
           "springs on both sides by one"});
    }
  }
}

void SystemBuilder::set_initial() {
  system_.initial_z_ = Vector::Zero(system_.size());
  system_.initial_v_ = Vector::Zero(system_.size());
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
    system_.initial_z_[map.unknown] = initial.deviation / map.coeff;
    system_.initial_v_[map.unknown] = initial.rate / map.coeff;
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
  std::erase_if(all, [](double t) { return !std::isfinite(t); });
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
}

}  // namespace drev
