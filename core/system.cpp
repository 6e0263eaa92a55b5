#include "core/system.hpp"

#include <algorithm>

#include "core/state.hpp"

namespace drev {

int System::node(const std::string& name) const {
  const std::vector<std::string>& names = node_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  throw ModelError({{name_, "node", name, "", "is no node of this model" + did_you_mean(name, names)}});
}

std::vector<std::string> System::floating_parts(Contact contact) const {
  const std::vector<int> component =
      connected_components(node_count(), closures_, contact == Contact::closed);
  const int count =
      component.empty() ? 0 : 1 + *std::max_element(component.begin(), component.end());
  std::vector<bool> tied(at(count), false);
  for (const Closure& row : closures_)
    if (row.second < 0 && (contact == Contact::closed || !row.only_in_contact))
      tied[at(component[at(row.first)])] = true;
  for (int i = 0; i < node_count(); ++i)
    if (node_map_[at(i)].prescribed >= 0) tied[at(component[at(i)])] = true;
  std::vector<std::string> floating;
  std::vector<bool> named(at(count), false);
  for (int i = 0; i < node_count(); ++i) {
    const int c = component[at(i)];
    if (!tied[at(c)] && !named[at(c)]) {
      named[at(c)] = true;
      floating.push_back(node_names()[at(i)]);
    }
  }
  return floating;
}

State State::initial(const System& system, double t) {
  State state;
  state.t = t;
  state.z = system.initial_deviation();
  state.v = system.initial_rate();
  state.a = Vector::Zero(system.size());
  state.history = Vector::Zero(system.history_size());
  for (const GeneralTerm& g : system.generals())
    g.force->initial_history({state.history.data() + g.history_begin,
                              static_cast<std::size_t>(g.force->history_size())});
  return state;
}

}  // namespace drev
