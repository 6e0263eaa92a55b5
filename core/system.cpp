#include <drev/core/error.hpp>
#include <drev/core/general_force.hpp>
#include <drev/core/law/varying_inertia.hpp>
#include <drev/core/load.hpp>
#include <drev/core/scalar_force.hpp>
#include <drev/core/state.hpp>
#include <drev/core/system.hpp>

#include <algorithm>
#include <cmath>

namespace drev {

System::System(const System& other) = default;
System::System(System&& other) noexcept = default;
System& System::operator=(const System& other) = default;
System& System::operator=(System&& other) noexcept = default;
System::~System() = default;

int System::node(const std::string& name) const {
  const std::vector<std::string>& names = node_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  throw ModelError({{name_, "node", name, "", "is no node of this model" + did_you_mean(name, names)}});
}

double System::reference_speed() const { return reference_ ? std::abs(reference_->at(0.0).rate) : 0.0; }

System System::with_initial(Vector deviation, Vector rate) const {
  for (const Vector* x : {&deviation, &rate})
    if (x->size() != size() || !x->allFinite())
      throw ModelError(
          {{name_, x == &rate ? "initial rate" : "initial deviation", std::to_string(x->size()) + " values",
            "", "must be " + std::to_string(size()) + " finite values, one an unknown"}});
  System other = *this;
  other.initial_z_ = std::move(deviation);
  other.initial_v_ = std::move(rate);
  return other;
}

std::vector<Entry> System::row_of(int node) const {
  const NodeMap& map = node_map(node);
  std::vector<Entry> row;
  if (map.unknown >= 0) row.push_back({map.unknown, map.coeff});
  if (map.row >= 0)
    for (int k = 0; k < size(); ++k)
      if (rows_(map.row, k) != 0.0) row.push_back({k, map.coeff * rows_(map.row, k)});
  return row;
}

void System::map_load(int number) {
  const LoadTerm& term = loads_[idx(number)];
  const NodeMap& map = node_map(term.node);
  const bool follows = term.load->depends_on_motion();
  loads_depend_on_motion_ |= follows;
  if (map.prescribed >= 0) return;
  if (const auto table = term.load->table(); table && table->evenly_spaced)
    table_loads_.add(*table, place(map), map.coeff, ratio(term.node), follows ? map.coeff : 0.0);
  else if (!knotted_loads_.add(*term.load, place(map), map.coeff, ratio(term.node)))
    (follows ? moving_loads_ : known_loads_).push_back(number);
}

int System::slot(int row, int col) const {
  const int *outer = pattern_->outerIndexPtr(), *inner = pattern_->innerIndexPtr();
  return static_cast<int>(std::lower_bound(inner + outer[col], inner + outer[col + 1], row) - inner);
}

void System::find_slots() {
  diagonal_slots_.resize(idx(size()));
  for (int k = 0; k < size(); ++k) diagonal_slots_[idx(k)] = slot(k, k);
  const auto only_diagonal = [this](const Vector& matrix) {
    const auto on_diagonal = std::count_if(diagonal_slots_.begin(), diagonal_slots_.end(),
                                           [&](int s) { return matrix[s] != 0.0; });
    return (matrix.array() != 0.0).count() == on_diagonal;
  };
  mass_is_diagonal_ = only_diagonal(mass_);
  damping_is_diagonal_ = only_diagonal(damping_);
  for (ScalarTerm& s : scalars_) {
    s.slots.clear();
    for (const Entry& r : s.z)
      for (const Entry& c : s.z) s.slots.push_back(slot(r.index, c.index));
  }
  for (LoadTerm& l : loads_) {
    const int k = node_map(l.node).unknown;
    l.slot = k >= 0 ? diagonal_slots_[idx(k)] : -1;
  }
  for (GeneralTerm& g : generals_) {
    g.slots.clear();
    for (const int i : g.nodes)
      for (const int j : g.nodes) {
        const int r = node_map(i).unknown, c = node_map(j).unknown;
        g.slots.push_back(r >= 0 && c >= 0 ? slot(r, c) : -1);
      }
  }
}

std::vector<std::string> System::floating_parts(Contact contact) const {
  std::vector<std::string> names;
  for (const int node : floating(contact)) names.push_back(node_names()[idx(node)]);
  return names;
}

std::optional<std::string> System::why_not_varying_inertia(const std::string& method, bool steps) const {
  for (const LoadTerm& term : loads_) {
    const auto* inertia = dynamic_cast<const VaryingInertia*>(term.load);
    if (inertia != nullptr && inertia->inertia_varies())
      return element_instances()[idx(index(term.element))].name +
             " has an inertia that follows the angle (varying_inertia), which " + method +
             " does not take; " +
             (steps ? "run it in steps, not reduced and with planets on elastic meshes (gear_mesh) where it "
                      "has "
                      "any, or with "
                    : "take ") +
             "its mean inertia (varying_inertia = false)";
  }
  return std::nullopt;
}

State State::initial(const System& system, double t) {
  State state;
  state.t = t;
  state.z = system.initial_deviation();
  state.v = system.initial_rate();
  state.a = Vector::Zero(system.size());
  state.history = Vector::Zero(system.history_size());
  for (const GeneralTerm& g : system.generals())
    g.force->initial_history(
        {state.history.data() + g.history_begin, static_cast<std::size_t>(g.force->history_size())});
  return state;
}

}  // namespace drev
