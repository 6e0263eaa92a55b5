#include "core/kinematics.hpp"

#include <drev/core/ids.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <queue>

namespace drev {

namespace {

constexpr double kRatioTolerance = 1e-9;  // relative; teeth give exact ratios, radii 15 digits

/// Rows between two nodes, by node.
struct Edges {
  std::vector<int> begin, row;
};

Edges edges_of(int nodes, const std::vector<RatioRow>& speed_ratio_constraints) {
  Edges e{std::vector<int>(idx(nodes + 1), 0), {}};
  for (const RatioRow& c : speed_ratio_constraints)
    if (c.second >= 0) ++e.begin[idx(c.first + 1)], ++e.begin[idx(c.second + 1)];
  std::partial_sum(e.begin.begin(), e.begin.end(), e.begin.begin());
  e.row.resize(idx(e.begin.back()));
  std::vector<int> next(e.begin.begin(), e.begin.end() - 1);
  for (std::size_t c = 0; c < speed_ratio_constraints.size(); ++c) {
    if (speed_ratio_constraints[c].second < 0) continue;
    e.row[idx(next[idx(speed_ratio_constraints[c].first)]++)] = static_cast<int>(c);
    e.row[idx(next[idx(speed_ratio_constraints[c].second)]++)] = static_cast<int>(c);
  }
  return e;
}

struct Walk {
  std::vector<double> relative;  // ratio to the root of the component
  std::vector<int> parent, parent_closure;
};

std::string loop_text(const Walk& walk, const std::vector<ElementInstance>& element_instances,
                      const std::vector<RatioRow>& speed_ratio_constraints, int a, int b, int closing) {
  // Elements on the tree paths from a and b to their common ancestor, then the closing element.
  std::vector<int> up_a, up_b;
  for (int i = a; i >= 0; i = walk.parent[idx(i)]) up_a.push_back(i);
  for (int i = b; i >= 0; i = walk.parent[idx(i)]) up_b.push_back(i);
  while (up_a.size() > 1 && up_b.size() > 1 && up_a[up_a.size() - 2] == up_b[up_b.size() - 2]) {
    up_a.pop_back();
    up_b.pop_back();
  }
  const auto name = [&](int row) {
    return element_instances[idx(speed_ratio_constraints[idx(row)].element)].name;
  };
  std::vector<std::string> names{name(closing)};
  const auto name_above = [&](int node) { return name(walk.parent_closure[idx(node)]); };
  for (std::size_t i = 0; i + 1 < up_b.size(); ++i) names.push_back(name_above(up_b[i]));
  for (std::size_t i = up_a.size() - 1; i-- > 0;) names.push_back(name_above(up_a[i]));
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " - ") + name;
  return text;
}

}  // namespace

std::vector<int> connected_components(int nodes, const std::vector<RatioRow>& speed_ratio_constraints,
                                      bool with_contacts, bool with_ratios) {
  std::vector<int> root(idx(nodes));
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int i) {
    while (root[idx(i)] != i) i = root[idx(i)] = root[idx(root[idx(i)])];
    return i;
  };
  for (const RatioRow& c : speed_ratio_constraints)
    if (c.second >= 0 && (with_contacts || !c.only_in_contact) && (with_ratios || !c.ratio_only)) {
      const int a = find(c.first), b = find(c.second);
      root[idx(std::max(a, b))] = std::min(a, b);
    }
  std::vector<int> component(idx(nodes)), number(idx(nodes), -1);
  int next = 0;
  for (int i = 0; i < nodes; ++i) {
    int& n = number[idx(find(i))];
    if (n < 0) n = next++;
    component[idx(i)] = n;
  }
  return component;
}

ComponentSpeeds solve_components(const std::vector<WideRatioRow>& wide, const std::vector<int>& component,
                                 const std::vector<double>& relative, const std::vector<bool>& known,
                                 std::vector<double> speed, bool open) {
  constexpr double kNone = 1e-10;  // relative, of what is left of a row
  struct Row {
    std::map<int, double> a;  // over components that are not known
    double right = 0.0, size = 0.0;
    int pivot = -1;
    const WideRatioRow* of = nullptr;
  };
  ComponentSpeeds result;
  std::vector<Row> rows;
  for (const WideRatioRow& stated : wide) {
    if (open && stated.only_in_contact) continue;
    Row row;
    row.of = &stated;
    for (const auto& [node, b] : stated.b) {
      const int c = component[idx(node)];
      const double term = b * relative[idx(node)];
      if (known[idx(c)])
        row.right -= term * speed[idx(c)];
      else
        row.a[c] += term;
      row.size = std::max(row.size, std::abs(term));
    }
    for (const Row& other : rows) {
      const auto at = row.a.find(other.pivot);
      if (at == row.a.end()) continue;
      const double factor = at->second;
      row.a.erase(at);
      for (const auto& [c, a] : other.a)
        if (c != other.pivot) row.a[c] -= factor * a;
      row.right -= factor * other.right;
    }
    double largest = kNone * row.size;
    for (const auto& [c, a] : row.a)
      if (std::abs(a) > largest) largest = std::abs(a), row.pivot = c;
    if (row.pivot < 0) {
      if (std::abs(row.right) > kNone * row.size) result.contradicting.push_back(&stated);
      continue;
    }
    const double scale = 1.0 / row.a[row.pivot];
    for (auto& [c, a] : row.a) a *= scale;
    row.right *= scale;
    // Out of the rows before, so that each pivot stands in its own row alone.
    for (Row& other : rows) {
      const auto at = other.a.find(row.pivot);
      if (at == other.a.end()) continue;
      const double factor = at->second;
      other.a.erase(at);
      for (const auto& [c, a] : row.a)
        if (c != row.pivot) other.a[c] -= factor * a;
      other.right -= factor * row.right;
    }
    rows.push_back(std::move(row));
  }
  for (const Row& row : rows) {
    result.dependent.push_back(row.pivot);
    speed[idx(row.pivot)] = row.right;
    for (const auto& [c, a] : row.a)
      if (c != row.pivot && std::abs(a) > kNone && std::abs(row.right) > kNone) {
        result.undetermined.push_back(row.of);
        break;
      }
  }
  result.speed = std::move(speed);
  return result;
}

Kinematics find_ratios(const std::string& model, const std::vector<std::string>& node_names,
                       const std::vector<ElementInstance>& element_instances,
                       const std::vector<RatioRow>& speed_ratio_constraints,
                       const std::vector<WideRatioRow>& wide, const std::vector<int>& prescribed,
                       int reference, std::vector<Finding>& findings) {
  const bool sound = findings.empty();
  const int nodes = static_cast<int>(node_names.size());
  Kinematics k;
  k.component = connected_components(nodes, speed_ratio_constraints, true, true);
  k.ratio.assign(idx(nodes), 0.0);
  const Edges edges = edges_of(nodes, speed_ratio_constraints);

  Walk walk{std::vector<double>(idx(nodes), 0.0), std::vector<int>(idx(nodes), -1),
            std::vector<int>(idx(nodes), -1)};
  std::vector<bool> seen(idx(nodes), false), reported(speed_ratio_constraints.size(), false);
  const auto walk_from = [&](int start, double ratio) {
    std::queue<int> queue;
    queue.push(start);
    seen[idx(start)] = true;
    walk.relative[idx(start)] = ratio;
    while (!queue.empty()) {
      const int i = queue.front();
      queue.pop();
      for (int e = edges.begin[idx(i)]; e < edges.begin[idx(i + 1)]; ++e) {
        const int c = edges.row[idx(e)];
        const RatioRow& row = speed_ratio_constraints[idx(c)];
        const bool forward = row.first == i;
        const int to = forward ? row.second : row.first;
        const double factor = -row.b_first / row.b_second;
        const double n = (forward ? factor : 1.0 / factor) * walk.relative[idx(i)];
        const double known = walk.relative[idx(to)];
        if (!seen[idx(to)]) {
          seen[idx(to)] = true;
          walk.relative[idx(to)] = n;
          walk.parent[idx(to)] = i;
          walk.parent_closure[idx(to)] = c;
          queue.push(to);
        } else if (std::abs(n - known) > kRatioTolerance * std::max(std::abs(n), std::abs(known)) &&
                   !reported[idx(c)]) {
          reported[idx(c)] = true;
          findings.push_back({model + "/" + element_instances[idx(row.element)].name,
                              "nominal ratio of " + node_names[idx(to)], to_text(n), "",
                              "but the rest of the loop gives " + to_text(known) +
                                  "; this loop cannot turn: " +
                                  loop_text(walk, element_instances, speed_ratio_constraints, i, to, c)});
        }
      }
    }
  };
  if (reference >= 0) walk_from(reference, 1.0);
  for (int i = 0; i < nodes; ++i)
    if (!seen[idx(i)]) walk_from(i, 1.0);

  k.relative = walk.relative;
  if (reference < 0) return k;
  const int moving = k.component[idx(reference)];
  const auto components = idx(*std::max_element(k.component.begin(), k.component.end()) + 1);
  std::vector<double> speed(components, 0.0);
  std::vector<bool> known(components, false);
  for (const RatioRow& row : speed_ratio_constraints)
    if (row.second < 0 && !row.holds_deviation) known[idx(k.component[idx(row.first)])] = true;
  for (const int node : prescribed)
    if (node >= 0) known[idx(k.component[idx(node)])] = true;
  known[idx(moving)] = true;
  speed[idx(moving)] = 1.0;
  const ComponentSpeeds solved = solve_components(wide, k.component, k.relative, known, speed, false);
  const auto say = [&](const WideRatioRow& row, const std::string& why) {
    std::string nodes;
    for (const auto& [node, b] : row.b) nodes += (nodes.empty() ? "" : ", ") + node_names[idx(node)];
    findings.push_back(
        {model + "/" + element_instances[idx(row.element)].name, "nominal speeds", nodes, "", why});
  };
  for (const WideRatioRow* row : solved.contradicting)
    say(*row, "contradict each other: what else ties these nodes does not let the set turn");
  // What another finding keeps out of the model may be what would tie them.
  for (const WideRatioRow* row : solved.undetermined)
    if (sound)
      say(*row,
          "do not follow from the reference shaft: hold or ground one of them, tie two (a planetary set free "
          "on "
          "all sides has two motions), or say that all three turn alike (together)");
  for (int i = 0; i < nodes; ++i)
    k.ratio[idx(i)] = solved.speed[idx(k.component[idx(i)])] * walk.relative[idx(i)];
  for (const RatioRow& row : speed_ratio_constraints)
    if (row.second < 0 && !row.holds_deviation && k.component[idx(row.first)] == moving)
      findings.push_back({model + "/" + element_instances[idx(row.element)].name, "node",
                          node_names[idx(row.first)], "",
                          "turns with the reference shaft and cannot be tied to ground by a spring"});
  return k;
}

}  // namespace drev
