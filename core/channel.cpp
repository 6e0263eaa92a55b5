#include <drev/core/assembler.hpp>
#include <drev/core/channel.hpp>
#include <drev/core/error.hpp>
#include <drev/core/law/angle_scaled_force.hpp>
#include <drev/core/law/friction.hpp>

#include <algorithm>
#include <set>
#include <unordered_map>

#include "core/energy/element_energy.hpp"
#include "core/names/channel_pattern.hpp"

namespace drev {

static constexpr std::size_t kListed = 12;  // channels, beside a pattern that nothing fits

class ChannelFinder {
 public:
  /// Makes every channel, or those wanted alone: all those of a large model take several times its memory.
  explicit ChannelFinder(const System& system, const std::set<std::string>* wanted = nullptr)
      : system_(system), wanted_(wanted) {
    for (int i = 0; i < system.node_count(); ++i) add_node(i);
    for (const OutputTerm& o : system.outputs()) {
      const auto& row = o.stiffness.empty() ? o.damping : o.stiffness;
      const bool turns = !o.along_line_of_action && rotational(row);
      const std::string name = element(o.element) + (o.suffix.empty() ? "" : "_" + o.suffix);
      add(name + (o.deflection ? deflection_name(turns) : force_name(turns)),
          o.deflection ? deflection_unit(turns) : force_unit(turns), Channel::Kind::output, 0,
          o.along_line_of_action && !o.deflection, &o);
    }
    for (std::size_t j = 0; j < system.scalars().size(); ++j) {
      const ScalarTerm& s = system.scalars()[j];
      const ElementInstance& p = system.element_instances()[idx(index(s.element))];
      const bool turns = !s.along_line_of_action && rotational(s.nodes);
      add(p.name + force_name(turns), force_unit(turns), Channel::Kind::force, static_cast<int>(j),
          s.along_line_of_action);
      add(p.name + deflection_name(turns), deflection_unit(turns), Channel::Kind::deflection,
          static_cast<int>(j));
    }
    for (std::size_t l = 0; l < system.loads().size(); ++l) {
      const bool turns = rotational(system.loads()[l].node);
      const LoadTerm& load = system.loads()[l];
      add(element(load.element) + (load.suffix.empty() ? "" : "_" + load.suffix) + force_name(turns),
          force_unit(turns), Channel::Kind::load, static_cast<int>(l));
    }
    for (std::size_t j = 0; j < system.frictions().size(); ++j) add_friction(static_cast<int>(j));
    for (std::size_t r = 0; r < system.ideal_ratios().size(); ++r) {
      const bool turns = rotational(system.ideal_ratios()[r].second);
      add(element(system.ideal_ratios()[r].element) + force_name(turns), force_unit(turns),
          Channel::Kind::ideal_ratio, static_cast<int>(r));
    }
  }

  std::vector<Channel> channels;

  /// NODE_A-NODE_B.twist_rad; node names may hold '-' themselves. Returns in how many ways the name can
  /// be read; the channel is the first.
  int find_difference(const std::string& name, Channel& channel) const {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos) return 0;
    const std::string kind = name.substr(dot + 1), pair = name.substr(0, dot);
    if (kind != "twist_rad" && kind != "distance_m") return 0;
    int readings = 0;
    for (std::size_t cut = pair.find('-'); cut != std::string::npos; cut = pair.find('-', cut + 1)) {
      const int a = node(pair.substr(0, cut)), b = node(pair.substr(cut + 1));
      if (a < 0 || b < 0) continue;
      const bool turns = rotational(a);
      if (turns != rotational(b) || turns != (kind == "twist_rad")) continue;
      if (++readings > 1) continue;
      channel = named(name, turns ? "rad" : "m");
      channel.kind_ = Channel::Kind::difference;
      channel.index_ = a;
      channel.second_ = b;
      make_direct(channel);
    }
    return readings;
  }

  /// ELEMENT.power_W and the like.
  bool find_energy(const std::string& name, Channel& channel) {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos) return false;
    const auto& elements = system_.element_instances();
    for (std::size_t e = 0; e < elements.size(); ++e) {
      if (elements[e].name.size() != dot || name.compare(0, dot, elements[e].name) != 0) continue;
      for (Channel& c : energies_of(static_cast<int>(e)))
        if (c.name_ == name) return channel = std::move(c), true;
    }
    return false;
  }
  std::vector<Channel> energies_of(int element) {
    if (energies_.empty())
      for (ElementEnergy& e : ElementEnergy::of_all(system_))
        energies_.push_back(std::make_shared<const ElementEnergy>(std::move(e)));
    const auto& energy = energies_[idx(element)];
    std::vector<Channel> found;
    const auto add_one = [&](bool there, const char* what, const char* unit, Channel::Kind kind,
                             double (ElementEnergy::*of)(const Assembler&, const State&) const) {
      if (!there) return;
      Channel c = named(system_.element_instances()[idx(element)].name + what, unit);
      c.kind_ = kind;
      c.energy_ = energy;
      c.of_energy_ = of;
      c.driven_ = of == &ElementEnergy::power && energy->has_loads();
      c.inertial_ = c.driven_ && !system_.varying_inertias().empty();
      if (energy->has_friction() && kind == Channel::Kind::integral)
        c.kind_ = Channel::Kind::friction, c.index_ = energy->friction_heat();
      found.push_back(std::move(c));
    };
    using Kind = Channel::Kind;
    const ElementEnergy& own = *energy;
    add_one(own.exchanges(), ".power_W", "W", Kind::energy, &ElementEnergy::power);
    add_one(own.dissipates(), ".dissipation_W", "W", Kind::energy, &ElementEnergy::dissipation);
    add_one(own.stores(), ".stored_J", "J", Kind::energy, &ElementEnergy::stored);
    add_one(own.moves(), ".kinetic_J", "J", Kind::energy, &ElementEnergy::kinetic);
    add_one(own.exchanges() && !own.has_friction(), ".work_J", "J", Kind::integral, &ElementEnergy::power);
    add_one(own.dissipates(), ".dissipated_J", "J", Kind::integral, &ElementEnergy::dissipation);
    return found;
  }

 private:
  Channel named(std::string name, std::string unit) const {
    Channel c;
    c.name_ = std::move(name);
    c.unit_ = std::move(unit);
    c.layout_ = system_.layout();
    return c;
  }
  void add(std::string name, std::string unit, Channel::Kind kind, int index,
           bool along_line_of_action = false, const OutputTerm* output = nullptr) {
    if (wanted_ && !wanted_->contains(name)) return;
    Channel c = named(std::move(name), std::move(unit));
    c.kind_ = kind;
    c.index_ = index;
    c.along_line_of_action_ = along_line_of_action;
    const ScalarTerm* law = kind == Channel::Kind::force ? &system_.scalars()[idx(index)] : nullptr;
    c.damped_ = law != nullptr && law->phase_node < 0 && !is_undamped(linear_pieces(*law));
    c.moved_ =
        law != nullptr && law->phase_node >= 0 &&
        (dynamic_cast<const AngleScaledForce*>(law->force) == nullptr || !is_undamped(law->force->pieces()));
    c.inertial_ = kind == Channel::Kind::load && !system_.varying_inertias().empty();
    make_direct(c, output);
    channels.push_back(std::move(c));
  }
  void make_direct(Channel& c, const OutputTerm* output = nullptr) const {
    using Kind = Channel::Kind;
    c.direct_ = true;
    const auto add_node = [&](std::vector<Entry>& row, int node, double coeff) {
      for (const Entry& e : system_.row_of(node)) row.push_back({e.index, coeff * e.coeff});
      const int known = system_.node_map(node).prescribed;
      if (known >= 0 && system_.prescribed()[idx(known)].at) c.direct_ = false;  // it moves by itself
    };
    const auto add_row = [&](const std::vector<Entry>& nodes, std::vector<Entry>& row,
                             std::vector<Entry>& known) {
      for (const Entry& e : nodes) {
        add_node(row, e.index, e.coeff);
        const NodeMap& map = system_.node_map(e.index);
        if (map.prescribed >= 0) known.push_back({map.prescribed, e.coeff * map.coeff});
      }
    };
    if (c.kind_ == Kind::value) {
      add_node(c.z_, c.index_, 1.0);
    } else if (c.kind_ == Kind::rate) {
      add_node(c.v_, c.index_, 1.0);
    } else if (c.kind_ == Kind::difference) {
      add_node(c.z_, c.index_, 1.0);
      add_node(c.z_, c.second_, -1.0);
    } else if (output) {
      add_row(output->stiffness, c.z_, c.u_);
      add_row(output->damping, c.v_, c.u_rate_);
    } else {
      c.direct_ = false;
    }
  }
  void add_node(int i) {
    using Kind = Channel::Kind;
    const std::string& name = system_.node_names()[idx(i)];
    const bool turns = rotational(i);
    add(name + (turns ? ".angle_rad" : ".position_m"), turns ? "rad" : "m", Kind::value, i);
    add(name + (turns ? ".speed_rad_per_s" : ".velocity_m_per_s"), turns ? "rad/s" : "m/s", Kind::rate, i);
    add(name + (turns ? ".acceleration_rad_per_s2" : ".acceleration_m_per_s2"), turns ? "rad/s^2" : "m/s^2",
        Kind::acceleration, i);
    const NodeMap& map = system_.node_map(i);
    if (map.prescribed >= 0 && system_.prescribed_node(map.prescribed) == i)
      add(name + (turns ? ".reaction_Nm" : ".reaction_N"), force_unit(turns), Kind::reaction, map.prescribed);
  }
  void add_friction(int number) {
    using History = FrictionHistory;
    const FrictionTerm& term = system_.frictions()[idx(number)];
    if (term.friction->rigid()) return;
    const bool turns = rotational(term.nodes);
    const std::string name = element(term.element);
    const auto of_history = [&](const std::string& what, const std::string& unit, int which) {
      add(name + what, unit, Channel::Kind::friction, term.history_begin + which);
    };
    of_history(".state", "-", History::kState);
    of_history(".heat_J", "J", History::kHeat);
    if (const int tie = tie_of(system_, number); tie >= 0) {
      of_history(".torque_in_Nm", "N m", History::kTorqueIn);
      of_history(".torque_out_Nm", "N m", History::kTorqueOut);
      of_history(".loss_torque_Nm", "N m", History::kTorque);
      of_history(".loss_power_W", "W", History::kPower);
      add(name + ".driving_shaft", "-", Channel::Kind::friction,
          system_.frictions()[idx(tie)].history_begin + History::kState);
      return;
    }
    of_history(force_name(turns), force_unit(turns), History::kTorque);
    add(name + (turns ? ".slip_speed_rad_per_s" : ".slip_speed_m_per_s"), turns ? "rad/s" : "m/s",
        Channel::Kind::slip, number);
  }
  static std::string force_name(bool turns) { return turns ? ".torque_Nm" : ".force_N"; }
  static std::string force_unit(bool turns) { return turns ? "N m" : "N"; }
  static std::string deflection_name(bool turns) { return turns ? ".deflection_rad" : ".deflection_m"; }
  static std::string deflection_unit(bool turns) { return turns ? "rad" : "m"; }
  bool rotational(int node) const { return system_.node_kind(node) == NodeKind::rotational; }
  /// Whether b^T q is an angle. Over nodes of both kinds it is a length: the rotational ones have a radius.
  bool rotational(const std::vector<Entry>& row) const {
    return std::all_of(row.begin(), row.end(), [this](const Entry& e) { return rotational(e.index); });
  }
  std::string element(ElementId id) const { return system_.element_instances()[idx(index(id))].name; }
  int node(const std::string& name) const {
    const auto& names = system_.node_names();
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? -1 : static_cast<int>(found - names.begin());
  }

  const System& system_;
  const std::set<std::string>* wanted_;
  std::vector<std::shared_ptr<const ElementEnergy>> energies_;  // of all elements, once any is asked for
};

namespace {

/// Sum of all forces on the left side less the loads, at one node, before elimination.
Vector node_residual(const Assembler& assembler, const State& s) {
  const System& system = assembler.system();
  const int nodes = system.node_count();
  Vector q(nodes), v(nodes), a(nodes);
  for (int i = 0; i < nodes; ++i) {
    const MotionPoint m = assembler.node_motion(i, s);
    q[i] = m.value, v[i] = m.rate;
    a[i] = m.acceleration + system.ratio(i) * assembler.nominal().acceleration;
  }
  const MatrixSet& k = *system.node_matrices();
  Vector r = k.mass * a + k.damping * v + k.stiffness * q;
  r += assembler.nominal().rate * system.node_drag();
  for (const ScalarTerm& term : system.scalars()) {
    const double y = assembler.respond(term, s.z, s.v).y;
    for (const Entry& e : term.nodes) r[e.index] += e.coeff * y;
  }
  for (const LoadTerm& term : system.loads()) r[term.node] -= assembler.load_torque(term, s);
  for (const FrictionTerm& term : system.frictions())
    for (const Entry& e : term.nodes)
      r[e.index] += e.coeff * s.history[term.history_begin + FrictionHistory::kTorque];
  assembler.add_general_node_forces(s, r);
  return r;
}

double ideal_ratio_torque(const Assembler& assembler, const State& s, int which) {
  // Constraint torques by peeling leaves off the tree of ideal ratios: the last constraint at a node
  // carries whatever that node is out of balance by.
  const System& system = assembler.system();
  Vector r = node_residual(assembler, s);
  std::vector<bool> done(system.ideal_ratios().size(), false);
  std::vector<int> degree(idx(system.node_count()), 0);
  for (const IdealRatio& c : system.ideal_ratios()) ++degree[idx(c.first)], ++degree[idx(c.second)];
  for (std::size_t round = 0; round < done.size(); ++round)
    for (std::size_t i = 0; i < done.size(); ++i) {
      if (done[i]) continue;
      const IdealRatio& c = system.ideal_ratios()[i];
      const auto is_prescribed = [&](int node) {
        const NodeMap& m = system.node_map(node);
        return m.prescribed >= 0 && system.prescribed_node(m.prescribed) == node;
      };
      const bool leaf_second = degree[idx(c.second)] == 1 && !is_prescribed(c.second);
      const bool leaf_first = degree[idx(c.first)] == 1 && !is_prescribed(c.first);
      if (!leaf_second && !leaf_first) continue;
      // b lambda + r = 0 at the leaf.
      const double lambda = leaf_second ? -r[c.second] / c.b_second : -r[c.first] / c.b_first;
      if (static_cast<int>(i) == which) return -lambda * c.b_second;
      r[c.first] += c.b_first * lambda;
      r[c.second] += c.b_second * lambda;
      --degree[idx(c.first)], --degree[idx(c.second)];
      done[i] = true;
    }
  return 0.0;
}

}  // namespace

double reaction(const Assembler& assembler, const State& s, int k) {
  const System& system = assembler.system();
  const MatrixSet &zu = system.coupling_zu(), &uu = system.coupling_uu();
  const int row = system.size() + k;
  double r = system.nominal_inertia()[row] * assembler.nominal().acceleration +
             system.nominal_drag()[row] * assembler.nominal().rate;
  for (SparseMatrix::InnerIterator it(zu.mass, k); it; ++it) r += it.value() * s.a[it.row()];
  for (SparseMatrix::InnerIterator it(zu.damping, k); it; ++it) r += it.value() * s.v[it.row()];
  for (SparseMatrix::InnerIterator it(zu.stiffness, k); it; ++it) r += it.value() * s.z[it.row()];
  for (SparseMatrix::InnerIterator it(uu.mass, k); it; ++it)
    r += it.value() * assembler.prescribed(static_cast<int>(it.row())).acceleration;
  for (SparseMatrix::InnerIterator it(uu.damping, k); it; ++it)
    r += it.value() * assembler.prescribed(static_cast<int>(it.row())).rate;
  for (SparseMatrix::InnerIterator it(uu.stiffness, k); it; ++it)
    r += it.value() * assembler.prescribed(static_cast<int>(it.row())).value;
  for (const ScalarTerm& term : system.scalars())
    for (const Entry& e : term.u)
      if (e.index == k) r += e.coeff * assembler.respond(term, s.z, s.v).y;
  for (const FrictionTerm& term : system.frictions())
    for (const Entry& e : term.nodes)
      if (const NodeMap& map = system.node_map(e.index); map.prescribed == k)
        r += map.coeff * e.coeff * s.history[term.history_begin + FrictionHistory::kTorque];
  for (const LoadTerm& term : system.loads()) {
    const NodeMap& map = system.node_map(term.node);
    if (map.prescribed == k) r -= map.coeff * assembler.load(term, s.z, s.v).torque;
  }
  if (!system.generals().empty()) {
    Vector general = Vector::Zero(system.node_count());
    assembler.add_general_node_forces(s, general);
    for (int i = 0; i < system.node_count(); ++i)
      if (system.node_map(i).prescribed == k) r += system.node_map(i).coeff * general[i];
  }
  return r;
}

std::optional<double> Channel::rate(const Assembler& assembler, const State& state) const {
  const System& system = assembler.system();
  if (direct_) {
    double y = 0.0;
    for (const Entry& e : z_) y += e.coeff * state.v[e.index];
    for (const Entry& e : v_) y += e.coeff * state.a[e.index];
    return y;
  }
  switch (kind_) {
    case Kind::value:
      return assembler.node_motion(index_, state).rate;
    case Kind::rate:
      return assembler.node_motion(index_, state).acceleration;
    case Kind::difference:
      return assembler.node_motion(index_, state).rate - assembler.node_motion(second_, state).rate;
    case Kind::deflection:
      return assembler.input(system.scalars()[idx(index_)], state.z, state.v).x_dot;
    case Kind::force: {
      const ScalarTerm& term = system.scalars()[idx(index_)];
      const ScalarInput in = assembler.input(term, state.z, state.v);
      return force_rate(assembler, state, in, term.force->evaluate(in));
    }
    case Kind::energy:
      return of_energy_ == &ElementEnergy::stored ? energy_->stored_rate(assembler, state) : std::nullopt;
    default:
      return std::nullopt;
  }
}

std::optional<double> Channel::force_rate(const Assembler& assembler, const State& state,
                                          const ScalarInput& in, const ScalarResponse& r) const {
  const System& system = assembler.system();
  const ScalarTerm& term = system.scalars()[idx(index_)];
  if (moved_) return std::nullopt;
  double y = r.dy_dx * in.x_dot;
  if (r.dy_dangle != 0.0)
    y += r.dy_dangle * (system.ratio(term.phase_node) * assembler.nominal().rate +
                        assembler.node_motion(term.phase_node, state).rate);
  if (!damped_) return y;
  for (const Entry& e : term.z) y += r.dy_dx_dot * e.coeff * state.a[e.index];
  for (const Entry& e : term.u) y += r.dy_dx_dot * e.coeff * assembler.prescribed(e.index).acceleration;
  return y;
}

double Channel::evaluate(const Assembler& assembler, const State& state) const {
  if (direct_) return over_unknowns(state);
  const System& system = assembler.system();
  switch (kind_) {
    case Kind::value:
      return assembler.node_motion(index_, state).value;
    case Kind::rate:
      return assembler.node_motion(index_, state).rate;
    case Kind::acceleration:
      return assembler.node_motion(index_, state).acceleration;
    case Kind::difference:
      return assembler.node_motion(index_, state).value - assembler.node_motion(second_, state).value;
    case Kind::reaction:
      return reaction(assembler, state, index_);
    case Kind::output: {
      double y = over_unknowns(state);
      for (const Entry& e : u_) y += e.coeff * assembler.prescribed(e.index).value;
      for (const Entry& e : u_rate_) y += e.coeff * assembler.prescribed(e.index).rate;
      return y;
    }
    case Kind::force:
      return assembler.respond(system.scalars()[idx(index_)], state.z, state.v).y;
    case Kind::deflection:
      return assembler.input(system.scalars()[idx(index_)], state.z, state.v).x;
    case Kind::load:
      return assembler.load_torque(system.loads()[idx(index_)], state);
    case Kind::friction:
      return state.history[index_];
    case Kind::slip: {
      double w = 0.0;
      for (const Entry& e : system.frictions()[idx(index_)].nodes)
        w += e.coeff *
             (assembler.node_motion(e.index, state).rate + system.ratio(e.index) * assembler.nominal().rate);
      return w;
    }
    case Kind::ideal_ratio:
      return ideal_ratio_torque(assembler, state, index_);
    case Kind::energy:
      return integrand(assembler, state);
    case Kind::integral:
      throw SolverError(system.name() + ": " + name_ +
                        " is summed up over a run; no single state holds its value (Recorder does)");
  }
  return 0.0;
}

double Channel::integrand(const Assembler& assembler, const State& state) const {
  return ((*energy_).*of_energy_)(assembler, state);
}

bool Channel::is_of(const System& system) const { return layout_ == system.layout(); }

bool are_of(const System& system, const std::vector<Channel>& channels) {
  return std::all_of(channels.begin(), channels.end(), [&](const Channel& c) { return c.is_of(system); });
}

std::vector<Channel> all_channels(const System& system) { return ChannelFinder(system).channels; }

std::vector<Channel> energy_channels(const System& system) {
  const std::set<std::string> none;
  ChannelFinder finder(system, &none);
  std::vector<Channel> all;
  for (int e = 0; e < static_cast<int>(system.element_instances().size()); ++e)
    for (Channel& c : finder.energies_of(e)) all.push_back(std::move(c));
  return all;
}

std::vector<Channel> find_channels(const System& system, const std::vector<std::string>& names,
                                   OverRun integrals) {
  const std::vector<AskedChannel> asked = asked_channels(system, names);
  std::set<std::string> wanted;
  for (const AskedChannel& one : asked) wanted.insert(one.name);
  ChannelFinder finder(system, &wanted);
  std::unordered_map<std::string, std::vector<std::size_t>> by_name;
  for (std::size_t i = 0; i < finder.channels.size(); ++i) by_name[finder.channels[i].name()].push_back(i);
  std::vector<std::string> known;  // for the error alone
  const auto hint = [&](const std::string& name) {
    if (known.empty())
      for (const auto& list : {all_channels(system), energy_channels(system)})
        for (const Channel& c : list) known.push_back(c.name());
    std::string text = did_you_mean(name, known);
    if (!is_pattern(name)) return text;
    for (std::size_t i = 0; i < std::min(kListed, known.size()); ++i)
      text += (i == 0 ? "; there are " : ", ") + known[i];
    return known.size() > kListed ? text + " and " + std::to_string(known.size() - kListed) + " more" : text;
  };
  std::vector<Channel> found;
  std::vector<Finding> findings;
  const auto refuse = [&](const AskedChannel& one, const std::string& why) {
    if (findings.empty() || findings.back().value != one.asked || one.asked == one.name)
      findings.push_back({system.name(), "channel", one.asked, "", why});
  };
  for (const AskedChannel& one : asked) {
    const std::string& name = one.name;
    const auto it = by_name.find(name);
    Channel difference, energy;
    if (it != by_name.end()) {
      found.push_back(finder.channels[it->second.front()]);
      if (it->second.size() > 1)
        refuse(one, "is the name of " + std::to_string(it->second.size()) +
                        " channels of this model; rename an element");
    } else if (const int readings = finder.find_difference(name, difference); readings == 1)
      found.push_back(difference);
    else if (readings > 1)
      refuse(one, "can be read as " + std::to_string(readings) + " pairs of nodes; rename one of them");
    else if (finder.find_energy(name, energy)) {
      if (energy.over_run() && integrals == OverRun::refused)
        refuse(one, "is summed up over a run: it can be recorded, but not be taken here");
      found.push_back(std::move(energy));
    } else
      refuse(one, (is_pattern(name) ? "fits no channel of this model" : "is no channel of this model") +
                      hint(name));
  }
  if (!findings.empty()) throw ModelError(findings);
  return found;
}

Channel find_channel(const System& system, const std::string& name) {
  const std::vector<Channel> found = find_channels(system, {name});
  if (found.size() == 1) return found.front();
  throw ModelError({{system.name(), "channel", name, "",
                     "fits " + std::to_string(found.size()) + " channels; one is meant here"}});
}

}  // namespace drev
