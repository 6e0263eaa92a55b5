#include "core/system_builder.hpp"

#include <drev/core/general_force.hpp>
#include <drev/core/law/friction.hpp>
#include <drev/core/law/varying_inertia.hpp>
#include <drev/core/load.hpp>
#include <drev/core/ritz_projection.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>

namespace drev {

namespace {

constexpr double kSpeedTolerance = 1e-9;    // relative, constant_speed against the nominal speed
constexpr double kInitialTolerance = 1e-9;  // relative, of initial conditions that say the same

bool usable_name(const std::string& name) {
  return !name.empty() && name.find_first_of(".,*\"") == std::string::npos && !has_control_characters(name);
}

}  // namespace

System SystemBuilder::build() {
  check_names();
  resolve_motions();
  describe_elements();
  find_nominal_motion();
  eliminate();
  if (findings_.empty()) order_unknowns();
  check_inertias();
  set_initial();
  throw_if_findings();
  node_by_name_ = NameIndex(0, {});
  map_terms();
  assemble_matrices();
  check_values();
  find_varying_inertias();
  finish();
  throw_if_findings();
  return wide_constraints_.empty() ? std::move(system_) : constrained();
}

void SystemBuilder::throw_if_findings() const {
  if (!findings_.empty()) throw ModelError(findings_);
}

void SystemBuilder::check_names() {
  system_.name_ = model_.name();
  system_.node_names_ = model_.node_names_;
  system_.node_kinds_ = model_.node_kinds();
  system_.element_instances_ = model_.element_instances_;
  if (has_control_characters(model_.name()))
    findings_.push_back({model_.name(), "name", model_.name(), "", "must be without control characters"});
  if (model_.node_names().empty())
    findings_.push_back({model_.name(), "nodes", "0", "", "the model is empty; add nodes"});
  const auto check = [this](const char* what, const std::string& name, bool first) {
    if (!usable_name(name))
      findings_.push_back({model_.name(), what, name, "",
                           "must be non-empty, without '.', ',', '*', quotes and control characters"});
    if (!first) findings_.push_back({model_.name(), what, name, "", "is used twice"});
  };
  const auto name_of_node = [this](int i) -> const std::string& { return node_name(i); };
  node_by_name_ = NameIndex(system_.node_count(), name_of_node,
                            [&](int i, bool first) { check("node name", node_name(i), first); });
  const std::vector<ElementInstance>& element_instances = model_.element_instances();
  const auto name_of = [&](int e) -> const std::string& { return element_instances[idx(e)].name; };
  NameIndex(static_cast<int>(element_instances.size()), name_of,
            [&](int e, bool first) { check("element name", name_of(e), first); });
}

int SystemBuilder::find(const NodeRef& ref) const {
  if (!ref.id) return node_by_name_.find(ref.name);
  const int i = index(*ref.id);
  return i >= 0 && i < system_.node_count() ? i : -1;
}

int SystemBuilder::resolve(const NodeRef& ref, const std::string& where, const std::string& parameter) {
  const int found = find(ref);
  if (found >= 0) return found;
  if (ref.id)
    findings_.push_back({where, parameter, std::to_string(index(*ref.id)), "",
                         "is no node of this model (it has " + std::to_string(system_.node_count()) + ")"});
  else
    findings_.push_back({where, parameter, ref.name, "",
                         "is no node of this model" + did_you_mean(ref.name, model_.node_names())});
  return -1;
}

void SystemBuilder::check_motion(const Motion& motion, const std::string& where,
                                 const std::string& parameter) {
  if (!motion.at) findings_.push_back({where, parameter, "", "", "has no function"});
  ParameterCheck(where, findings_).all_finite(parameter + " breakpoints", motion.breakpoints, "s");
}

void SystemBuilder::resolve_motions() {
  if (model_.references().size() > 1)
    findings_.push_back({model_.name(), "reference", std::to_string(model_.references().size()), "",
                         "at most one reference shaft can be set"});
  for (const auto& [ref, motion] : model_.references()) {
    check_motion(motion, model_.name(), "reference motion");
    reference_node_ = resolve(ref, model_.name(), "reference");
    system_.reference_ = motion;
  }
  for (const Model::Prescription& p : model_.prescriptions()) {
    int node = resolve(p.node, model_.name(), "prescribed node");
    inertia_in_doubt_ |= node < 0;
    const std::string where = node < 0 ? model_.name() : place(node_name(node));
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

void SystemBuilder::find_nominal_motion() {
  Kinematics kinematics =
      find_ratios(model_.name(), model_.node_names(), model_.element_instances(), ratio_rows_,
                  wide_ratio_rows_, resolved_prescriptions_, reference_node_, findings_);
  system_.ratio_ = std::move(kinematics.ratio);
  system_.floating_closed_ = floating_parts(kinematics.relative, Contact::closed);
  system_.floating_open_ = floating_parts(kinematics.relative, Contact::open);
  std::vector<RatioRow>().swap(ratio_rows_);
  component_ = std::move(kinematics.component);
  for (std::size_t i = 0; i < resolved_prescriptions_.size(); ++i) {
    const auto& p = model_.prescriptions()[i];
    const int node = resolved_prescriptions_[i];
    if (!p.omega || node < 0 || !findings_.empty()) continue;
    // At the start and wherever the reference's rate may change.
    std::vector<double> times{0.0};
    const std::vector<double>& breaks = system_.reference_->breakpoints;
    times.insert(times.end(), breaks.begin(), breaks.end());
    for (const double t : times) {
      const double nominal = system_.ratio(node) * system_.reference_->at(t).rate;
      if (std::abs(nominal - *p.omega) <= kSpeedTolerance * std::abs(*p.omega)) continue;
      const bool apart = component_[idx(node)] != component_[idx(reference_node_)];
      findings_.push_back({place(node_name(node)), "omega", to_text(*p.omega), "rad/s",
                           apart ? "but nothing connects this node with the reference shaft, at " +
                                       node_name(reference_node_) +
                                       ", from which its nominal speed would follow"
                                 : "but the reference shaft turns this node at " + to_text(nominal) +
                                       " rad/s at t = " + to_text(t) + " s"});
      break;
    }
  }
}

std::vector<int> SystemBuilder::floating_parts(const std::vector<double>& relative, Contact contact) const {
  const bool open = contact == Contact::open;
  const std::vector<int> component = connected_components(system_.node_count(), ratio_rows_, !open);
  std::vector<bool> counted(component.size(), false);  // components counted as tied or floating
  for (const RatioRow& row : ratio_rows_)
    if (row.second < 0 && !(open && row.only_in_contact)) counted[idx(component[idx(row.first)])] = true;
  for (const int node : resolved_prescriptions_)
    if (node >= 0) counted[idx(component[idx(node)])] = true;
  // A row over several parts takes one rigid motion.
  const ComponentSpeeds tied = solve_components(wide_ratio_rows_, component, relative, counted,
                                                std::vector<double>(component.size(), 0.0), open);
  for (const int c : tied.dependent) counted[idx(c)] = true;
  std::vector<int> floating;
  for (int i = 0; i < static_cast<int>(component.size()); ++i) {
    if (counted[idx(component[idx(i)])]) continue;
    counted[idx(component[idx(i)])] = true;
    floating.push_back(i);
  }
  return floating;
}

void SystemBuilder::check_inertias() {
  const int unknowns = static_cast<int>(system_.unknown_node_.size());
  if (unknowns == 0 && system_.node_count() > 0 && faulty_nodes_.empty())
    findings_.push_back(
        {model_.name(), "unknowns", "0", "", "every node is prescribed; nothing is left to compute"});
  if (inertia_in_doubt_) return;
  std::vector<double> inertia(idx(unknowns), 0.0);
  std::vector<bool> in_doubt(idx(unknowns), false);
  for (const int node : faulty_nodes_)
    if (const int k = system_.node_map_[idx(node)].unknown; k >= 0) in_doubt[idx(k)] = true;
  for (const NodeMatrix& mass : mass_)
    mass.for_each(1.0, [&](int i, int j, double value) {
      const NodeMap &a = system_.node_map_[idx(i)], &b = system_.node_map_[idx(j)];
      if (a.unknown >= 0 && a.unknown == b.unknown) inertia[idx(a.unknown)] += value * a.coeff * b.coeff;
    });
  for (int k = 0; k < unknowns; ++k) {
    const int node = system_.unknown_node_[idx(k)];
    if (inertia[idx(k)] > 0.0 || in_doubt[idx(k)]) continue;
    if (node_by_name_.find(node_name(node)) != node) continue;  // its name is used twice
    const bool turns = system_.node_kinds_[idx(node)] == NodeKind::rotational;
    findings_.push_back({place(node_name(node)), turns ? "inertia" : "mass", to_text(inertia[idx(k)]),
                         turns ? "kg m^2" : "kg",
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
    ParameterCheck check(place(node_name(node)), findings_);
    const bool turns = system_.node_kinds_[idx(node)] == NodeKind::rotational;
    check.finite("initial deviation", initial.deviation, turns ? "rad" : "m");
    check.finite("initial rate", initial.rate, turns ? "rad/s" : "m/s");
    const NodeMap& map = system_.node_map_[idx(node)];
    if (map.unknown < 0) {
      const std::string why = "the node is prescribed; its motion is given";
      // Where one of the two is given, the other is 0.
      if (initial.deviation != 0.0 || initial.rate == 0.0)
        check.fail("initial deviation", to_text(initial.deviation), turns ? "rad" : "m", why);
      if (initial.rate != 0.0)
        check.fail("initial rate", to_text(initial.rate), turns ? "rad/s" : "m/s", why);
      continue;
    }
    double& z = system_.initial_z_[map.unknown];
    double& v = system_.initial_v_[map.unknown];
    int& by = set_by[idx(map.unknown)];
    if (by >= 0 && differ(map.coeff * z, initial.deviation))
      check.fail("initial deviation", to_text(initial.deviation), turns ? "rad" : "m",
                 "but that of " + node_name(by) + " gives " + to_text(map.coeff * z));
    if (by >= 0 && differ(map.coeff * v, initial.rate))
      check.fail("initial rate", to_text(initial.rate), turns ? "rad/s" : "m/s",
                 "but that of " + node_name(by) + " gives " + to_text(map.coeff * v));
    z = initial.deviation / map.coeff;
    v = initial.rate / map.coeff;
    by = node;
  }
  // The two sides of a tie move as one: what is given for one holds for the other.
  bool again = true;
  while (again) {
    again = false;
    for (const FrictionTerm& term : system_.frictions_) {
      if (!term.friction->rigid() || term.nodes.size() != 2) continue;
      const NodeMap* map[2];
      for (std::size_t k = 0; k < 2; ++k) map[k] = &system_.node_map_[idx(term.nodes[k].index)];
      if (map[0]->unknown < 0 || map[1]->unknown < 0) continue;
      int by[2];
      for (std::size_t k = 0; k < 2; ++k) by[k] = set_by[idx(map[k]->unknown)];
      if (by[0] < 0 && by[1] < 0) continue;
      const std::size_t from = by[0] >= 0 ? 0 : 1, to = 1 - from;
      const double factor =
          -term.nodes[from].coeff * map[from]->coeff / (term.nodes[to].coeff * map[to]->coeff);
      const auto follow = [&](Vector& x, const char* what, const char* unit) {
        double& other = x[map[to]->unknown];
        const double value = factor * x[map[from]->unknown];
        if (by[to] >= 0 && differ(map[to]->coeff * other, map[to]->coeff * value))
          ParameterCheck(place(node_name(by[to])), findings_)
              .fail(what, to_text(map[to]->coeff * other), unit,
                    "but that of " + node_name(by[from]) + " gives " + to_text(map[to]->coeff * value));
        if (by[to] < 0) other = value;
      };
      follow(system_.initial_v_, "initial rate", "rad/s");
      if (by[to] >= 0) continue;
      follow(system_.initial_z_, "initial deviation", "rad");
      set_by[idx(map[to]->unknown)] = by[from];
      again = true;
    }
  }
  if (!model_.initials().empty() && findings_.empty()) start_internal_nodes(set_by);
}

System SystemBuilder::constrained() {
  constexpr double kNone = 1e-12;  // entry over the largest one that counts as none
  Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(system_.size(), system_.size());
  std::vector<int> dependent;
  for (const WideConstraint& constraint : wide_constraints_) {
    // The row over what the constraints before it left free: b^T B.
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(system_.size());
    double largest = 0.0;
    int pivot = -1;
    const std::string where = place(model_.element_instances()[idx(index(constraint.element))].name);
    for (const Entry& e : constraint.nodes) {
      const NodeMap& map = system_.node_map(e.index);
      largest = std::max(largest, std::abs(e.coeff));
      if (map.prescribed >= 0 && system_.prescribed()[idx(map.prescribed)].at)
        findings_.push_back({where, "node", node_name(e.index), "",
                             "has a given motion, which a constraint over three nodes does not take; put a "
                             "shaft between"});
      if (map.unknown >= 0) row += e.coeff * map.coeff * basis.row(map.unknown);
    }
    for (const Entry& e : constraint.nodes)
      if (const int k = system_.node_map(e.index).unknown; k >= 0 && std::abs(row[k]) > kNone * largest)
        pivot = k;
    for (int k = 0; pivot < 0 && k < system_.size(); ++k)
      if (std::abs(row[k]) > kNone * largest) pivot = k;
    if (pivot < 0) {
      findings_.push_back(
          {where, "nodes", "", "", "are all held or tied already: the torque in this set is undetermined"});
      continue;
    }
    const Eigen::VectorXd column = basis.col(pivot);
    basis -= column * row / row[pivot];
    basis.col(pivot).setZero();
    dependent.push_back(pivot);
  }
  throw_if_findings();
  Eigen::MatrixXd free(system_.size(), system_.size() - static_cast<Eigen::Index>(dependent.size()));
  Vector z(free.cols()), v(free.cols());
  for (int k = 0, column = 0; k < system_.size(); ++k) {
    if (std::count(dependent.begin(), dependent.end(), k) > 0) continue;
    z[column] = system_.initial_z_[k], v[column] = system_.initial_v_[k];
    free.col(column++) = basis.col(k);
  }
  const auto agree = [&](const Vector& given, const Vector& independent, const char* what) {
    const Vector full = free * independent;
    for (const int k : dependent)
      if (given[k] != 0.0 && std::abs(given[k] - full[k]) > kInitialTolerance * std::abs(full[k]))
        findings_.push_back({place(system_.unknown_name(k)), what, to_text(given[k]), "",
                             "but the nodes that it is tied to give " + to_text(full[k])});
  };
  agree(system_.initial_z_, z, "initial deviation");
  agree(system_.initial_v_, v, "initial rate");
  throw_if_findings();
  return ritz_projection(system_, free).with_initial(z, v);
}

void SystemBuilder::find_varying_inertias() {
  constexpr int kAngles = 360;  // angles of a turn at which the inertia must be positive
  for (const LoadTerm& load : system_.loads_) {
    const auto* inertia = dynamic_cast<const VaryingInertia*>(load.load);
    if (inertia == nullptr || !inertia->inertia_varies()) continue;
    const std::string where = place(model_.element_instances()[idx(index(load.element))].name);
    const auto fail = [&](std::string range) {
      findings_.push_back({where, "varying inertia", node_name(load.node), "", std::move(range)});
    };
    const NodeMap& map = system_.node_map(load.node);
    if (map.unknown < 0) {
      fail("needs a node that moves freely, but its motion is given");
      continue;
    }
    const int k = map.unknown;
    const SparseMatrix& pattern = system_.pattern();
    for (int s = pattern.outerIndexPtr()[k]; s < pattern.outerIndexPtr()[k + 1]; ++s)
      if (const int other = pattern.innerIndexPtr()[s]; other != k && system_.mass_[s] != 0.0)
        fail("needs a lumped inertia, but the inertia is coupled to that of " + system_.unknown_name(other));
    for (const GeneralTerm& general : system_.generals_)
      for (const int node : general.nodes)
        if (system_.node_map(node).unknown == k)
          fail("does not stand beside a general element on its node; put a shaft between");
    auto& rows = system_.varying_inertias_;
    auto row = std::find_if(rows.begin(), rows.end(), [k](const auto& r) { return r.unknown == k; });
    if (row == rows.end()) {
      row = rows.insert(rows.end(), {.unknown = k, .constant = system_.mass_[system_.slot(k, k)]});
      for (std::size_t j = 0; j < system_.scalars_.size(); ++j)
        for (const Entry& e : system_.scalars_[j].z)
          if (e.index == k) row->laws.push_back({static_cast<int>(j), e.coeff});
    }
    row->parts.push_back({inertia, load.node});
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kAngles; ++i) {
      double sum = row->constant;
      for (const VaryingInertiaRow::Part& part : row->parts)
        sum += std::pow(system_.node_map(part.node).coeff, 2) *
               part.inertia->inertia_beyond(kTwoPi * i / kAngles);
      least = std::min(least, sum);
    }
    if (!(least > 0.0))
      fail("needs another inertia on its node: at some angles there is " + to_text(least) + " kg m^2 in all");
  }
}

void SystemBuilder::finish() {
  system_.nominal_direction_ = Vector::Zero(system_.size());
  for (int i = 0; i < system_.node_count(); ++i)
    if (const NodeMap& map = system_.node_map(i); map.unknown >= 0)
      system_.nominal_direction_[map.unknown] = system_.ratio(i) / map.coeff;
  std::vector<double>& all = system_.breakpoints_;
  const auto append = [&all](const std::vector<double>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  for (const LoadTerm& load : system_.loads_) append(load.load->breakpoints());
  for (const FrictionTerm& term : system_.frictions_) append(term.friction->breakpoints());
  for (const Motion& motion : system_.prescribed_) append(motion.breakpoints);
  if (system_.reference_) append(system_.reference_->breakpoints);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
}

System SystemBuilder::at_speed(const System& system, double speed, const Vector& forces) {
  std::vector<Finding> findings;
  ParameterCheck check(system.name(), findings);
  check.finite("speed", speed, "rad/s");
  if (speed == 0.0) check.fail("speed", "0", "rad/s", "must not be 0");
  if (!system.reference())
    check.fail("reference shaft", "none", "", "must be there: name a shaft that turns (nominal_speed)");
  if (!findings.empty()) throw ModelError(std::move(findings));
  System other = system;
  other.reference_ = constant_speed(speed);
  // At a constant speed the drag of the nominal motion is a constant force, too.
  if (forces.size() > 0) other.nominal_drag_.head(other.size()) -= forces / speed;
  return other;
}

}  // namespace drev
